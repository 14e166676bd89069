#include "devices/emulated_rig/rig_video.h"

#include <chrono>
#include <cmath>

namespace ilf::devices {
namespace {

// Before a sync its picture is taken; a millisecond or two would do on a quiet machine.
constexpr std::int64_t kTakenBefore_ns = 5'000'000;
// A process that was stopped for longer does not make up for the syncs it has missed.
constexpr std::int64_t kMissed_ns = 500'000'000;

void sleepUntil(std::int64_t time_ns) {
    // CLOCK_MONOTONIC, as all times of the rig.
    std::this_thread::sleep_until(std::chrono::steady_clock::time_point(std::chrono::nanoseconds(time_ns)));
}

}  // namespace

RigVideo::RigVideo(RigCables& cables, std::unique_ptr<RigDisplay> display)
    : cables_(cables), name_(display->name()), number_(display->number()), display_(std::move(display)) {}

Result<std::unique_ptr<RigVideo>> RigVideo::started(RigCables& cables) {
    auto display = RigDisplay::started({emulators::kMirrorColumns, emulators::kMirrorRows});
    if (!display) return tl::unexpected(display.error());
    std::unique_ptr<RigVideo> video(new RigVideo(cables, *std::move(display)));
    cables.plugVideo(kRefresh_Hz);
    RigVideo& runs = *video;
    video->syncs_ = std::jthread([&runs](const std::stop_token& stop) { runs.run(stop); });
    return video;
}

RigVideo::~RigVideo() {
    syncs_ = {};  // asked to stop, and waited for
    if (plugged_) cables_.unplugVideo();
}

void RigVideo::run(const std::stop_token& stop) {
    const std::int64_t began_ns = cables_.now_ns();
    for (std::int64_t count = 1; !stop.stop_requested(); ++count) {
        const auto due = [&] { return began_ns + std::llround(1e9 * static_cast<double>(count) / kRefresh_Hz); };
        if (const auto late_ns = cables_.now_ns() - due(); late_ns > kMissed_ns)
            count += static_cast<std::int64_t>(static_cast<double>(late_ns) * 1e-9 * kRefresh_Hz);
        sleepUntil(due() - kTakenBefore_ns);
        const auto frame = picture();
        sleepUntil(due());
        if (frame)
            cables_.sync(frame, due());
        else
            cables_.withoutVideo();
    }
}

emulators::FramePtr RigVideo::picture() {
    const std::scoped_lock lock(mutex_);
    if (!display_) return nullptr;
    auto taken = display_->picture();
    if (taken) return *taken;
    trouble_ = taken.error().what;
    pull();
    return nullptr;
}

void RigVideo::pull() {
    display_.reset();
    if (std::exchange(plugged_, false)) cables_.unplugVideo();
}

Result<void> RigVideo::befall(const RigMishap& mishap) {
    if (mishap.kind != "unplug" && mishap.kind != "plug" && mishap.kind != "none")
        return fail(Fault::outOfRange, "The emulated display can be plugged and unplugged; \"" + mishap.kind +
                                           "\" is nothing that befalls it.");
    const std::scoped_lock lock(mutex_);
    if (mishap.kind == "unplug") {
        pull();
        return {};
    }
    if (display_) return {};
    auto display = RigDisplay::started({emulators::kMirrorColumns, emulators::kMirrorRows}, number_);
    if (!display) return tl::unexpected(display.error());
    display_ = *std::move(display);
    cables_.plugVideo(kRefresh_Hz);
    plugged_ = true;
    return {};
}

std::optional<std::string> RigVideo::trouble() {
    const std::scoped_lock lock(mutex_);
    return std::exchange(trouble_, std::nullopt);
}

}  // namespace ilf::devices
