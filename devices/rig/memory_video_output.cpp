#include "devices/rig/memory_video_output.h"

#include <cmath>

namespace ilf::devices {

VideoFrame uniformFrame(Size size, std::uint8_t value) {
    const auto bytes = static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height) * 3;
    return {size, 3, std::vector<std::uint8_t>(bytes, value)};
}

MemoryVideoOutput::MemoryVideoOutput(VideoMode mode, Clock clock, DisplayIdentity display)
    : mode_(mode), clock_(std::move(clock)), display_(std::move(display)) {}

tl::unexpected<Error> MemoryVideoOutput::gone() const {
    return fail(Fault::device,
                "The projector's display (" + display_.connector + ") is gone. Check its cable and its power.");
}

Result<ScannedOut> MemoryVideoOutput::show(const VideoFrame& frame) {
    if (lost_) return gone();
    if (frame.size() != mode_.size || frame.channels() != 3)
        return fail(Fault::outOfRange, "A picture of " + std::to_string(frame.width()) + "x" +
                                           std::to_string(frame.height()) + " does not fit the projector's display, " +
                                           std::to_string(mode_.size.width) + "x" + std::to_string(mode_.size.height) +
                                           ".");
    const std::int64_t period = std::llround(1e9 / mode_.refresh.si());
    const std::int64_t now = clock_.now().count();
    const std::int64_t next = (now / period + 1) * period;
    clock_.wait(std::chrono::nanoseconds(next - now));
    shown_ = frame;
    return ScannedOut{std::chrono::nanoseconds(next), frames_++};
}

Result<VideoMode> MemoryVideoOutput::mode() {
    if (lost_) return gone();
    return mode_;
}

void MemoryVideoOutput::lose() {
    lost_ = true;
    shown_ = {};
}

}  // namespace ilf::devices
