// Whether the devices do what they were told, and what is done when they do not.
#include <exception>

#include "devices/rig/lightcrafter_stage.h"
#include "devices/video/found_display.h"

namespace ilf::devices {
namespace {

using namespace std::chrono_literals;

constexpr std::chrono::nanoseconds kTryEvery = 1s;
constexpr const char* kNoVideo =
    "The projector gets no video although its display is there; check the video cable at the projector's end, then "
    "TAKE.";

/// Emulated displays, and some adapters, say nothing of themselves.
std::string called(const DisplayIdentity& display) {
    return display.maker.empty() && display.model.empty() ? display.connector + " (unnamed)" : displayName(display);
}

}  // namespace

Result<void> LightCrafterStage::videoWell() {
    const auto mode = rig_.video->mode();
    if (!mode) return displayKnown_.missing(mode.error());
    if (!white_.empty() && mode->size != white_.size())
        return displayKnown_.wrong(
            {Fault::device, "The projector's display was switched to another mode; set 912x1140, then TAKE."});
    mode_ = *mode;
    return {};
}

Result<void> LightCrafterStage::projectorWell() {
    const auto seen = projector_->watch();
    if (!seen) return projectorKnown_.lost(seen.error());
    const auto wrong = [&](const std::string& what) { return projectorKnown_.wrong({Fault::device, what}); };
    if (!seen->troubles.empty()) return wrong(seen->troubles.front());
    if (running_ && !seen->playing)
        return wrong("The projector stopped showing patterns by itself; check its video, then TAKE.");
    if (!running_ && (seen->display != dlpc350::Display::video || seen->run == dlpc350::PatternRun::running))
        return wrong("The projector shows patterns although it was told plain video; close other programs that use "
                     "it.");
    if (running_) return {};
    const bool own = seen->source == dlpc350::Source::testPattern;
    if (ownWhite_ && !own)
        return wrong("The projector left its own white by itself, as it may when its video comes back; press TAKE to "
                     "start the slots again.");
    if (!ownWhite_ && (own || seen->source == dlpc350::Source::flash))
        return wrong("The projector shows a picture of its own although it was told plain video; close other programs "
                     "that use it.");
    if (!seen->seesVideo) return wrong(kNoVideo);
    return {};
}

Result<void> LightCrafterStage::confirmed() {
    return videoWell().and_then([&] { return projectorWell(); }).and_then([&] {
        return lens_.well(running_.has_value());
    });
}

/// Opens what is not open and makes it safe, so that all of it is known.
Result<void> LightCrafterStage::reached(Dioptre rest) {
    if (auto rested = lens_.restsAt(rest); !rested) return rested;
    if (projector_ && lens_.there() && light_ != Light::unknown) return {};
    return reachedAgain();
}

Result<void> LightCrafterStage::reachedAgain() {
    triedAt_ = rig_.clock.now();
    std::optional<Error> first;
    const auto note = [&](const Error& error) {
        if (!first) first = error;
    };
    if (!projector_) {
        auto opened = rig_.openProjector();
        if (opened)
            projector_ = *std::move(opened);
        else
            note(projectorKnown_.lost(opened.error()).value());
    }
    if (auto opened = lens_.opened(); !opened) note(opened.error());
    videoThere_ = true;  // to be tried, whatever it was
    makeSafe(Waiting::patient);
    if (!first) first = safeTrouble_;
    if (first) return tl::unexpected(*first);
    return {};
}

Result<void> LightCrafterStage::heartbeat() {
    const bool all = projector_ && lens_.there() && videoThere_;
    if (all && light_ != Light::unknown) {
        if (const auto well = confirmed(); !well) return faulted(well.error());
        return {};
    }
    if (all || !triedAt_ || rig_.clock.now() - *triedAt_ >= kTryEvery) return reachedAgain();
    return fail(Fault::device, "Projector, display or lenses are not there; connect them, then TAKE.");
}

void LightCrafterStage::safeLight() noexcept {
    try {
        const bool all = projector_ && lens_.there() && videoThere_;
        const bool maySearch = !triedAt_ || rig_.clock.now() - *triedAt_ >= kTryEvery;
        if (!all && maySearch)
            (void)reachedAgain();
        else if (all || !safeTold_)
            makeSafe(Waiting::brief);
    } catch (const std::exception&) {
        // Out of memory: what the devices do by themselves is left.
        light_ = Light::unknown;
    }
}

/// White in the mode the display has now.
Result<void> LightCrafterStage::madeWhite() {
    // What does not tell its mode may still show what it showed before.
    const auto mode = rig_.video->mode();
    if (!mode && white_.empty()) return displayKnown_.missing(mode.error());
    if (mode) mode_ = *mode;
    if (mode && white_.size() != mode->size) white_ = uniformFrame(mode->size, 255);
    if (const auto white = lit(white_); !white) return tl::unexpected(white.error());
    displayKnown_.answered(called(rig_.video->display()));
    return {};
}

/// No patterns, but white: its video where that is white and comes in, else its own.
Result<void> LightCrafterStage::boardIsPlain(bool videoIsWhite, Waiting waiting) {
    if (!projector_) return {};
    if (videoIsWhite && !ownWhite_) {
        if (const auto told = projector_->showVideo(waiting); !told) return projectorKnown_.lost(told.error());
        const auto sees = projector_->seesVideo();
        if (!sees) return projectorKnown_.lost(sees.error());
        projectorKnown_.answered(projector_->name());
        if (*sees) return {};
        (void)projectorKnown_.wrong({Fault::device, kNoVideo});
    }
    ownWhite_ = true;
    if (const auto told = projector_->showOwnWhite(waiting); !told) return projectorKnown_.lost(told.error());
    projectorKnown_.answered(projector_->name());
    return {};
}

/// From the board's own white to white video; the board is dark until it has locked on it. After an error its own white
/// is told again.
Result<void> LightCrafterStage::backToVideo() {
    if (!ownWhite_) return {};
    if (auto white = madeWhite(); !white) return white;
    videoThere_ = true;
    light_ = Light::unknown;
    if (const auto told = projector_->showVideo(Waiting::patient); !told) return projectorKnown_.lost(told.error());
    const auto sees = projector_->seesVideo();
    if (!sees) return projectorKnown_.lost(sees.error());
    if (!*sees) return projectorKnown_.wrong({Fault::device, kNoVideo});
    ownWhite_ = false;
    light_ = Light::white;
    return {};
}

/// Light comes before the lens, since slots seen through a lens at rest are not what anybody planned: white video is
/// uniform light in patterns too, even if the board does not listen. Only where that cannot be shown is the board told
/// first, briefly, to make white itself. Each is told even if the one before could not be; what does not listen is let
/// go.
void LightCrafterStage::makeSafe(Waiting waiting) {
    safeTrouble_.reset();
    const auto listened = [&](const auto& told) {
        if (!told && !safeTrouble_) safeTrouble_ = told.error();
        return told.has_value();
    };
    const bool white = videoThere_ && listened(madeWhite());
    videoThere_ = white;
    bool plain = !white && boardIsPlain(false, Waiting::brief).has_value();

    (void)listened(lens_.rest());
    if (!plain && (white || waiting == Waiting::patient)) plain = listened(boardIsPlain(white, waiting));
    if (!plain) projector_.reset();
    const bool slotsMayBeOn = light_ == Light::slotted && !white && !projector_;
    light_ = projector_ ? Light::white : slotsMayBeOn ? Light::slotted : Light::unknown;
    running_.reset();
    safeTold_ = true;
}

tl::unexpected<Error> LightCrafterStage::faulted(Error error) {
    loaded_.reset();  // a bare swap must not light again what has just failed
    safeLight();
    if (light_ != Light::white)
        error.what += " The projector's light is not known.";
    else if (ownWhite_)
        error.what += " The projector shows its own white.";
    if (!lens_.resting()) error.what += " Where the lens is, is not known.";
    return tl::unexpected<Error>(std::move(error));
}

}  // namespace ilf::devices
