#include "app/studio/viewer.h"

#include <algorithm>
#include <exception>
#include <string>

#include "core/base/srgb.h"
#include "core/perceived/seam_errors.h"

namespace ilf::app {
namespace {

constexpr std::array<Eye, 2> kEyes{Eye::left, Eye::right};
/// The seam is looked for this far from the cursor, as a share of the picture's width.
constexpr double kSeamReach = 0.05;

double viewScale(const Document& document) {
    return std::min(1.0, static_cast<double>(kViewWidth) / std::max(1, document.scene.size().width));
}

ViewRequest requestOf(const ViewJob& job, std::size_t eye, Rung rung) {
    ViewRequest request = askedOf(*job.compiled, job.seeing, kEyes[eye]);
    request.scale = viewScale(job.compiled->document);
    request.rung = rung;
    return request;
}

bool showTheSame(const ViewJob& a, const ViewJob& b) { return a.compiled == b.compiled && a.seeing == b.seeing; }

}  // namespace

Viewer::Viewer(std::function<void()> onNews)
    : onNews_(std::move(onNews)), thread_([this](std::stop_token s) { run(s); }) {}

void Viewer::post(ViewJob job) {
    if (!showTheSame(job, lastPosted_)) ++newestScene_;
    lastPosted_ = job;
    jobs_.put({std::move(job), newestScene_});
}

void Viewer::run(std::stop_token stop) {
    while (auto posted = jobs_.take(stop)) {
        try {
            work(*posted, stop);
        } catch (const std::exception& e) {  // memory ran out, or a library threw where nobody expected it
            seen_.refusal = Error{Fault::unsupported, std::string("The view could not be worked out: ") + e.what() +
                                                          ". Undo the last edit."};
            seen_.serial = posted->job.serial;
            seen_.settled = true;  // nothing finer follows
            publish();
        }
    }
}

void Viewer::publish() {
    news_.put(seen_);
    if (onNews_) onNews_();
}

bool Viewer::look(std::size_t eye, const ViewJob& job, Rung rung, const std::function<bool()>& cancelled) {
    const auto done = eyes_[eye].look(*job.compiled, requestOf(job, eye, rung), cancelled);
    if (!done) seen_.refusal = done.error();
    return done.value_or(false);
}

void Viewer::work(const Posted& posted, const std::stop_token& stop) {
    const ViewJob& job = posted.job;
    const Compiled& compiled = *job.compiled;
    if (posted.scene != scene_) {
        for (EyeView& eye : eyes_)
            eye.sceneChanged();
        seen_.refusal.reset();
        scene_ = posted.scene;
    }
    const bool sameProgram = compiled_ == job.compiled;
    compiled_ = job.compiled;
    if (!sameProgram) {  // whatever ends this job early: nothing of another program stays
        seen_.seams.reset();
        seen_.seam.reset();
        cursor_.reset();
    }
    seen_.serial = job.serial;
    seen_.scale = viewScale(compiled.document);
    seen_.settled = false;
    if (!sameProgram && (!reported_ || *reported_ != compiled.plan)) {
        seen_.report = std::make_shared<const PlanReport>(planReport(compiled.plan));
        reported_ = compiled.plan;
    }

    const auto fillIn = [&] {
        seen_.view_ms = 0.0;
        seen_.rung = Rung::idle;
        for (std::size_t i = 0; i < kEyes.size(); ++i) {
            seen_.perceived[i] = job.eyes[i] ? eyes_[i].shown() : nullptr;
            if (!job.eyes[i] || !eyes_[i].reached()) continue;
            seen_.counters[i] = eyes_[i].counters();
            seen_.rung = std::min(seen_.rung, *eyes_[i].reached());
            seen_.view_ms += eyes_[i].took_ms();
        }
    };
    // A gesture's frames are seen through, or a fast hand would never see one; nothing else outlives its use.
    const auto outdated = [&] { return stop.stop_requested() || (!job.dragging && newestScene_ != posted.scene); };
    const auto disturbed = [&] { return stop.stop_requested() || jobs_.waiting(); };
    for (std::size_t i = 0; i < kEyes.size(); ++i) {
        const auto reached = eyes_[i].reached();
        if (!job.eyes[i] || (reached && (job.dragging || *reached >= Rung::rest))) continue;
        const bool done = look(i, job, job.dragging ? Rung::dragging : Rung::rest, outdated);
        if (!done && !seen_.refusal) return;
        if (!done) break;
    }
    if (!job.plain) {
        seen_.plain = {};
    } else if (seen_.plain.empty() || !(plainOf_ == compiled.document.scene)) {
        seen_.plain = toSrgb8(plainView(compiled.document, seen_.scale));
        plainOf_ = compiled.document.scene;
    }
    if (!job.cursor || !compiled.plan.sweeps()) {
        seen_.seam.reset();
    } else if (cursor_ != job.cursor) {
        seen_.seam = seamProfile(compiled, *job.cursor, kSeamReach * compiled.document.scene.size().width);
    }
    cursor_ = job.cursor;
    fillIn();
    seen_.settled = seen_.refusal.has_value();
    publish();
    if (job.dragging || seen_.refusal) return;

    if (!seen_.seams) {
        SeamQuestion question;
        question.errors = knownErrors(compiled.document, compiled.plan);
        auto seams = borderSeams(compiled, question, disturbed);
        if (disturbed()) return;  // what there is of them may be a part
        seen_.seams = std::make_shared<const std::vector<BorderSeam>>(std::move(seams));
        publish();
    }
    for (std::size_t i = 0; i < kEyes.size(); ++i) {
        if (!job.eyes[i] || eyes_[i].reached() == Rung::idle) continue;
        if (!look(i, job, Rung::idle, disturbed) && !seen_.refusal) return;
    }
    fillIn();
    seen_.settled = true;
    publish();
    for (std::size_t eye = 0; eye < kEyes.size() && !seen_.refusal; ++eye) {
        if (job.eyes[eye]) eyes_[eye].prepareGesture(compiled, requestOf(job, eye, Rung::dragging), disturbed);
    }
}

}  // namespace ilf::app
