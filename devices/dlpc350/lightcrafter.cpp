#include "devices/dlpc350/lightcrafter.h"

#include "core/plan/words.h"
#include "devices/dlpc350/lightcrafter_set.h"

namespace ilf::devices::dlpc350 {
namespace {

constexpr Second kPollPause = 100.0_ms;  ///< TI's own program
constexpr int kMostPolls = 20;
/// While slots run: half a second of not knowing is more than enough.
constexpr Patience kWatching{Milliseconds(500), 0};
constexpr std::chrono::nanoseconds kAskEvery = std::chrono::seconds(1);
/// Of video nobody measured: the slowest there is.
constexpr Second kLongestFrame = 40.0_ms;

/// The board is waited for so long, until the end of this.
class Patiently {
public:
    Patiently(Conversation& board, const Patience& patience) : board_(board) { board_.setLimit(patience.answer); }
    ~Patiently() { board_.setLimit(Patience{}.answer); }
    Patiently(const Patiently&) = delete;
    Patiently& operator=(const Patiently&) = delete;

private:
    Conversation& board_;
};

bool comesIn(Source source) { return source == Source::parallel || source == Source::fpdLink; }

void append(std::vector<std::string>& to, std::vector<std::string> more) {
    to.insert(to.end(), std::make_move_iterator(more.begin()), std::make_move_iterator(more.end()));
}

}  // namespace

Result<std::unique_ptr<LightCrafter>> LightCrafter::open(std::unique_ptr<UsbLink> link, Clock clock,
                                                         const BringUp& bringUp) {
    auto board = Conversation::over(std::move(link));
    if (!board) return tl::unexpected(board.error());
    return std::unique_ptr<LightCrafter>(new LightCrafter(*std::move(board), std::move(clock), bringUp));
}

Result<Findings> LightCrafter::findings() {
    Findings found;
    const auto version = board_.ask<Version>();
    if (!version) return tl::unexpected(version.error());
    found.version = *version;
    found.remarks = remarks(*version);
    // Older firmware has no tag.
    if (const auto tag = board_.ask<FirmwareTag>()) found.firmwareTag = tag->text;

    const auto hardware = board_.ask<HardwareStatus>();
    if (!hardware) return tl::unexpected(hardware.error());
    append(found.troubles, troubles(*hardware));
    const auto system = board_.ask<SystemStatus>();
    if (!system) return tl::unexpected(system.error());
    append(found.troubles, troubles(*system));
    const auto status = board_.ask<MainStatus>();
    if (!status) return tl::unexpected(status.error());
    append(found.troubles, troubles(*status));

    const auto display = board_.ask<Display>();
    if (!display) return tl::unexpected(display.error());
    found.display = *display;
    const auto run = board_.ask<PatternRun>();
    if (!run) return tl::unexpected(run.error());
    found.run = *run;
    if (found.display == Display::pattern) return found;

    const auto input = board_.ask<InputSource>();
    if (!input) return tl::unexpected(input.error());
    found.source = input->source;
    if (!comesIn(found.source)) {
        found.remarks.push_back("It shows " + inWords(*input) +
                                " instead of video, as it does where its display was "
                                "lost; the next TAKE goes back to video.");
        return found;
    }
    const auto video = board_.ask<VideoSignal>();
    if (!video) return tl::unexpected(video.error());
    found.video = *video;
    if (const auto usable = usableVideo(*video); !usable) found.troubles.push_back(usable.error().what);
    return found;
}

Result<VideoSignal> LightCrafter::usableVideo(const VideoSignal& video) const {
    const std::string wanted = std::to_string(bringUp_.raster.width) + "x" + std::to_string(bringUp_.raster.height);
    if (!video.locked)
        return tl::unexpected(about("has locked on no picture at its HDMI input. Check the cable, and that its display "
                                    "is switched on with exactly " +
                                    wanted + "."));
    if (video.width != bringUp_.raster.width || video.height != bringUp_.raster.height)
        return tl::unexpected(about("gets " + inWords(video) + "; slots are shown right only at exactly " + wanted +
                                    ". Set that mode for its display."));
    if (video.refresh <= 0.0_Hz)
        return tl::unexpected(about("does not say how fast its video comes. Unplug the video and plug it in again."));
    return video;
}

Result<VideoSignal> LightCrafter::measuredVideo() {
    const auto display = board_.ask<Display>();
    if (!display) return tl::unexpected(display.error());
    if (*display == Display::pattern) return video_ ? Result<VideoSignal>(*video_) : videoAfterSwitching();
    if (const auto ok = chooseVideo(); !ok) return tl::unexpected(ok.error());
    return lockedVideo();
}

Result<VideoSignal> LightCrafter::videoAfterSwitching() {
    if (const auto ok = showVideo(); !ok) return tl::unexpected(ok.error());
    return lockedVideo();
}

/// Locking takes a while after video or its choice changed.
Result<VideoSignal> LightCrafter::lockedVideo() {
    for (int polls = 0;; ++polls) {
        const auto video = board_.ask<VideoSignal>();
        if (!video) return video;
        auto usable = usableVideo(*video);
        if (usable) video_ = *usable;
        if (usable || polls == kMostPolls) return usable;
        wait(kPollPause);
    }
}

Result<void> LightCrafter::stop(const Patience& patience) {
    const Patiently waits(board_, patience);
    toldToRun_ = false;
    askedAt_.reset();
    const auto order = payloadOf(PatternRun::stopped);
    if (const auto ok = board_.tell(kCommandOf<PatternRun>, order); !ok) return ok;
    for (int polls = 0; polls < patience.polls; ++polls) {
        const auto run = board_.ask<PatternRun>();
        if (!run) return tl::unexpected(run.error());
        if (*run == PatternRun::stopped) return {};
        wait(kPollPause);
    }
    return tl::unexpected(about("was told to stop its patterns but says they still run. Switch its power off and on."));
}

Result<void> LightCrafter::setDisplay(Display display, const Patience& patience) {
    const Patiently waits(board_, patience);
    const auto before = board_.ask<Display>();
    if (!before) return tl::unexpected(before.error());
    if (*before == display) return {};
    if (const auto ok = board_.tell(kCommandOf<Display>, payloadOf(display)); !ok) return ok;
    for (int polls = 0; polls < patience.polls; ++polls) {
        const auto found = board_.ask<Display>();
        if (!found) return tl::unexpected(found.error());
        if (*found == display) return {};
        wait(kPollPause);
    }
    return tl::unexpected(mismatch<Display>(name(), display, *before));
}

/// Back from a picture of the board's own. Which port video comes in at is its wiring, and left.
Result<void> LightCrafter::chooseVideo() {
    const auto found = board_.ask<InputSource>();
    if (!found) return tl::unexpected(found.error());
    if (comesIn(found->source)) return {};
    forgetVideo();
    return set(InputSource{Source::parallel, found->width});
}

Result<void> LightCrafter::showVideo(const Patience& patience) {
    if (const auto ok = stop(patience); !ok) return ok;
    wait(twoFrames());  // it says "stopped" before its last frame ends, and takes no change until then
    if (const auto ok = setDisplay(Display::video, patience); !ok) return ok;
    const Patiently waits(board_, patience);
    return chooseVideo();
}

Result<void> LightCrafter::showOwnWhite(const Patience& patience) {
    if (const auto ok = stop(patience); !ok) return ok;
    wait(twoFrames());
    if (const auto ok = setDisplay(Display::video, patience); !ok) return ok;
    const Patiently waits(board_, patience);
    // Before it is chosen, so that its first light is white.
    if (const auto ok = madeSure(kTestWhite); !ok) return ok;
    if (const auto ok = madeSure(TestPattern::solid); !ok) return ok;
    const auto before = board_.ask<InputSource>();
    if (!before) return tl::unexpected(before.error());
    if (before->source == Source::testPattern) return {};
    forgetVideo();
    return set(InputSource{Source::testPattern, before->width});
}

Result<bool> LightCrafter::seesVideo(const Patience& patience) {
    const Patiently waits(board_, patience);
    for (int polls = 0;; ++polls) {
        const auto video = board_.ask<VideoSignal>();
        if (!video) return tl::unexpected(video.error());
        if (video->locked || polls >= patience.polls) return video->locked;
        wait(kPollPause);
    }
}

Result<Watched> LightCrafter::watch() {
    const auto now = clock_.now();
    if (askedAt_ && now - *askedAt_ < kAskEvery) return watched_;
    const Patiently waits(board_, kWatching);
    const auto display = board_.ask<Display>();
    if (!display) return tl::unexpected(display.error());
    const auto run = board_.ask<PatternRun>();
    if (!run) return tl::unexpected(run.error());
    const auto status = board_.ask<MainStatus>();
    if (!status) return tl::unexpected(status.error());
    const auto hardware = board_.ask<HardwareStatus>();
    if (!hardware) return tl::unexpected(hardware.error());
    Watched seen;
    seen.display = *display;
    seen.run = *run;
    seen.flips = watched_.flips;
    seen.troubles = troubles(*hardware);
    if (*display == Display::video)
        if (const auto ok = watchInput(seen); !ok) return tl::unexpected(ok.error());
    askedAt_ = now;
    append(seen.troubles, troubles(*status));
    if (toldToRun_ && *display == Display::video) {
        // The board's own controller does this whenever an HDMI source appears (operators R12).
        ++seen.flips;
        toldToRun_ = false;
        forgetVideo();
        seen.troubles.push_back(name() + " left pattern mode by itself, as it does when an HDMI source appears: it now "
                                         "shows plain video. Press TAKE to start the slots again.");
    } else if (toldToRun_ && (*run != PatternRun::running || !status->sequencerRunning)) {
        seen.troubles.push_back(name() +
                                " stopped showing patterns by itself. Check its video, then press TAKE to start "
                                "the slots again.");
    }
    seen.playing = toldToRun_ && seen.troubles.empty();
    watched_ = seen;
    return seen;
}

Result<void> LightCrafter::watchInput(Watched& seen) {
    const auto input = board_.ask<InputSource>();
    if (!input) return tl::unexpected(input.error());
    seen.source = input->source;
    if (!comesIn(seen.source)) return {};
    const auto video = board_.ask<VideoSignal>();
    if (!video) return tl::unexpected(video.error());
    seen.seesVideo = video->locked;
    return {};
}

Error LightCrafter::stoppedAfter(const Error& error) {
    constexpr int kTries = 3;  // the first may only drain what the failed message left behind
    for (int tries = 0; tries < kTries; ++tries)
        if (stop(kBrief)) return error;
    return {error.fault, error.what + " It could not be stopped either: its light is not known."};
}

Second LightCrafter::twoFrames() const { return video_ ? 2.0 / video_->refresh : 2.0 * kLongestFrame; }

}  // namespace ilf::devices::dlpc350
