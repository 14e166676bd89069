#include "app/studio/worker.h"

#include <algorithm>
#include <exception>

#include "core/base/srgb.h"

namespace ilf::app {
namespace {

double millisecondsSince(Clock::time_point start) {
    return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

double viewScale(const Document& document, bool dragging) {
    const int limit = dragging ? kDraggingWidth : kRestWidth;
    return std::min(1.0, static_cast<double>(limit) / std::max(1, document.scene.size().width));
}

/// The seam is looked for this far from the cursor, as a share of the picture's width.
constexpr double kSeamReach = 0.05;

}  // namespace

Worker::Worker(devices::SimulatedLens lens, std::function<void()> onDone)
    : onDone_(std::move(onDone)), planner_(lens), thread_([this](std::stop_token s) { run(s); }) {}

void Worker::run(std::stop_token stop) {
    while (auto job = jobs_.take(stop)) {
        const std::uint64_t serial = job->serial;
        try {
            work(*std::move(job));
        } catch (const std::exception& e) {  // a library threw where nobody expected it: say so, keep working
            Done failed;
            failed.serial = serial;
            failed.refusal = Error{Fault::unsupported, std::string("The computation stopped: ") + e.what() +
                                                           ". What plays goes on; undo the last edit."};
            done_.put(std::move(failed));
            if (onDone_) onDone_();
        }
    }
}

void Worker::work(Job job) {
    const auto publish = [&](const Done& done) {
        done_.put(done);
        if (onDone_) onDone_();
    };
    Done done;
    done.serial = job.serial;
    done.strokeAt = job.strokeAt;

    // Plan: not worked out again when nothing it depends on changed.
    auto start = Clock::now();
    // Learning a wave on the lens takes longer than a frame: it waits until the hand is still.
    const auto input = planner_.input(job.document);
    Result<Plan> planned = tl::unexpected(input ? Error{} : input.error());
    if (input) {
        const bool same = last_ && last_->plan.input == *input && (job.dragging || last_->plan.unlearnt.empty());
        planned =
            same ? Result<Plan>(last_->plan) : planner_.plan(*input, last_ ? &last_->plan : nullptr, !job.dragging);
    }
    done.plan_ms = millisecondsSince(start);

    // Compile, sharing whatever the edit cannot reach.
    start = Clock::now();
    if (planned && last_ && last_->plan == *planned && last_->document == job.document) {
        done.compiled = last_;  // only the cursor moved, or a gesture ended: the same program, not an equal one
    } else if (planned) {
        auto compiled = compile(job.document, *planned, last_.get());
        if (compiled) {
            last_ = std::make_shared<const Compiled>(*std::move(compiled));
            done.compiled = last_;
        } else {
            done.refusal = compiled.error();
        }
    } else {
        done.refusal = planned.error();
    }
    done.compile_ms = millisecondsSince(start);
    done.report = report_;
    publish(done);
    if (!done.compiled) {
        lastViewed_.reset();
        lastDone_ = done;
        return;
    }

    if (!reported_ || *reported_ != done.compiled->plan) {
        report_ = std::make_shared<const PlanReport>(planReport(done.compiled->plan));
        reported_ = done.compiled->plan;
    }
    done.report = report_;

    // Views, unless newer work already waits.
    start = Clock::now();
    const Compiled& compiled = *done.compiled;
    const double scale = viewScale(job.document, job.dragging);
    done.rung = job.dragging ? "dragging" : "at rest";
    const bool sameScene = lastViewed_ && lastDone_.compiled && lastViewed_->dragging == job.dragging &&
                           (lastDone_.compiled == done.compiled || (lastDone_.compiled->program == compiled.program &&
                                                                    lastDone_.compiled->document == compiled.document));
    for (const Eye eye : {Eye::left, Eye::right}) {
        const auto index = static_cast<std::size_t>(eye == Eye::left ? 0 : 1);
        if (!job.eyes[index]) continue;
        if (sameScene && lastViewed_->eyes[index]) {
            done.perceived[index] = lastDone_.perceived[index];
            continue;
        }
        if (jobs_.waiting()) return;
        ViewRequest request;
        request.eye = eye;
        request.scale = scale;
        if (const auto view = perceived(compiled.document, compiled.plan, compiled.program, request)) {
            done.perceived[index] = toSrgb8(*view);
        } else {
            done.refusal = view.error();
        }
    }
    if (job.plain) {
        const bool kept = lastViewed_ && lastViewed_->plain && lastViewed_->dragging == job.dragging &&
                          lastDone_.compiled && lastDone_.compiled->document.scene == compiled.document.scene;
        done.plain = kept ? lastDone_.plain : toSrgb8(plainView(compiled.document, scale));
    }
    if (job.cursor && compiled.plan.sweeps()) {
        done.seam = seamProfile(compiled, *job.cursor, kSeamReach * compiled.document.scene.size().width);
    }
    done.view_ms = millisecondsSince(start);
    done.viewsDone = true;
    lastDone_ = done;
    lastViewed_ = std::move(job);
    publish(done);
}

}  // namespace ilf::app
