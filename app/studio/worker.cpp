#include "app/studio/worker.h"

#include <exception>
#include <string>

#include "core/base/elapsed.h"
#include "core/track/predict.h"

namespace ilf::app {
Worker::Worker(devices::SimulatedLens lens, std::function<void()> onNews)
    : onNews_(std::move(onNews)), planner_(lens), viewer_(onNews_), thread_([this](std::stop_token s) { run(s); }) {}

void Worker::run(std::stop_token stop) {
    while (auto job = jobs_.take(stop)) {
        Done done;
        try {
            done = program(*job);
            follow(*job, done);
        } catch (const std::exception& e) {  // a library threw where nobody expected it: say so, keep working
            done.refusal = Error{Fault::unsupported, std::string("The computation stopped: ") + e.what() +
                                                         ". What plays goes on; undo the last edit."};
        }
        done.serial = job->serial;
        done.strokeAt = job->strokeAt;
        done.seen_ns = job->seen_ns;
        done.painted = job->document;
        const auto compiled = done.compiled;
        done_.put(std::move(done));
        if (onNews_) onNews_();
        if (!compiled) continue;
        viewer_.post({job->serial, compiled, job->dragging, job->eyes, job->plain, job->seeing, job->cursor});
    }
}

void Worker::follow(const Job& job, Done& done) {
    if (!job.onShow) return;
    const Second light = lastShow_ ? meanLight(lastShow_->plan) : 0.0_s;
    const Document document = showCompiler_.placed(*job.onShow, job.moves, light);
    const auto input = planner_.input(document);
    if (!input) return;
    const Plan* before = lastShow_ ? &lastShow_->plan : nullptr;
    const bool same = before != nullptr && before->input == *input;
    const auto planned = same ? Result<Plan>(*before) : planner_.plan(*input, before, false);
    if (!planned) return;  // what plays goes on
    auto compiled = showCompiler_.compiled(*job.onShow, document, *planned, job.moves);
    if (!compiled) return;
    done.onShow = lastShow_ = *std::move(compiled);
    done.onShowHash = contentHash(done.onShow->program);
}

Done Worker::program(const Job& job) {
    Done done;
    // Plan: not worked out again when nothing it depends on changed.
    auto start = Clock::now();
    const Second light = last_ ? meanLight(last_->plan) : 0.0_s;
    const Document document = compiler_.placed(job.document, job.moves, light);
    // Learning a wave on the lens takes longer than a frame: it waits until the hand is still.
    const auto input = planner_.input(document);
    Result<Plan> planned = tl::unexpected(input ? Error{} : input.error());
    if (input) {
        const bool same = last_ && last_->plan.input == *input && (job.dragging || last_->plan.unlearnt.empty());
        planned =
            same ? Result<Plan>(last_->plan) : planner_.plan(*input, last_ ? &last_->plan : nullptr, !job.dragging);
    }
    done.plan_ms = millisecondsSince(start);

    // Compile, sharing whatever the edit cannot reach: the same program, not an equal one, where only the cursor moved
    // or a gesture ended.
    start = Clock::now();
    if (planned) {
        auto compiled = compiler_.compiled(job.document, document, *planned, job.moves);
        if (compiled) {
            done.compiled = last_ = *std::move(compiled);
        } else {
            done.refusal = compiled.error();
        }
    } else {
        done.refusal = planned.error();
    }
    done.compile_ms = millisecondsSince(start);
    if (done.compiled && done.compiled != hashed_) {
        hashed_ = done.compiled;
        hash_ = contentHash(hashed_->program);
    }
    done.hash = done.compiled ? hash_ : 0;
    return done;
}

}  // namespace ilf::app
