// What a projector is sent as video: whole pictures on one particular display, told when they are on their way.
#pragma once

#include <chrono>
#include <cstdint>

#include "core/base/image.h"
#include "core/base/quantity.h"
#include "core/base/result.h"
#include "core/document/rig_devices.h"

namespace ilf::devices {

using ilf::DisplayIdentity;

/// Red, green, blue, 8 bits each, sent as they are: no gamma, no scaling, no dither.
using VideoFrame = Image<std::uint8_t>;

VideoFrame uniformFrame(Size size, std::uint8_t value);

struct VideoMode {
    Size size;
    Hertz refresh;  ///< measured from the frames that went out; 0: not measured yet
    bool operator==(const VideoMode&) const = default;
};

struct ScannedOut {
    /// When the frame's first line left, in the output's clock.
    std::chrono::nanoseconds at{0};
    std::int64_t frame = 0;
};

/// Calls come from one thread. A display that is unplugged is lost: every call is an error until the same display (by
/// its identity, on whatever connector) is back; what it then shows is not known until the next `show`.
class VideoOutput {
public:
    virtual ~VideoOutput() = default;

    /// Returns once `frame` is being scanned out; it is then repeated until the next one. Frames are published whole:
    /// no scan-out ever has lines of two. Refuses frames of another size than the mode's. Blocks a frame or two at
    /// most.
    virtual Result<ScannedOut> show(const VideoFrame& frame) = 0;
    /// The mode the display has now; an error (`device`) while it is lost.
    virtual Result<VideoMode> mode() = 0;
    virtual const DisplayIdentity& display() const = 0;
};

}  // namespace ilf::devices
