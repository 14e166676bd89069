// One picture of a camera or video, with the time it was taken.
#pragma once

#include <cstdint>

#include "core/base/image.h"
#include "core/base/quantity.h"

namespace ilf::devices {

struct Frame {
    Image<std::uint8_t> rgb;   ///< 3 channels, sRGB-encoded, the camera's frame
    Second time;               ///< when it arrived: a steady clock, of no meaning between processes
    std::uint64_t number = 0;  ///< counts frames since the source was opened, from 1
    double position = 0.0;     ///< of a video file: 0 at its first frame, 1 at its last
    bool operator==(const Frame&) const = default;
};

/// Seconds of a steady clock.
Second steadyNow();

}  // namespace ilf::devices
