// What a region follows as it moves: a marker, a flat target, or poses that are sent; and what it does when that is
// lost.
#pragma once

#include <string>
#include <variant>

#include "core/base/geometry.h"
#include "core/base/quantity.h"

namespace ilf {

/// A printed marker. `dictionary` by OpenCV's name, e.g. "APRILTAG_36h11" or "6X6_250".
struct MarkerTarget {
    std::string dictionary = "APRILTAG_36h11";
    int id = 0;
    bool operator==(const MarkerTarget&) const = default;
};

/// A flat thing with a texture of its own, as it looked in the scene's picture.
struct PlanarTarget {
    PixelRect<CameraFrame> patch;
    bool operator==(const PlanarTarget&) const = default;
};

/// Poses that come by OSC under this address.
struct StreamTarget {
    std::string address = "/pose/1";
    bool operator==(const StreamTarget&) const = default;
};

struct Follow {
    enum class WhenLost { blur, neutral, focus };
    std::variant<MarkerTarget, PlanarTarget, StreamTarget> target;
    WhenLost whenLost = WhenLost::neutral;  ///< private things stay blurred, guidance goes neutral
    Second hold = 500.0_ms;                 ///< stays where it was last seen for so long
    Second fade = 500.0_ms;                 ///< then changes to whenLost within this time
    bool operator==(const Follow&) const = default;
};

}  // namespace ilf
