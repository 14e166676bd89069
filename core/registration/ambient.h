// Whether a scan can work in this room's light: asked with one white and one black picture before it starts.
#pragma once

#include <cstdint>
#include <string>

#include "core/base/image.h"
#include "core/base/result.h"

namespace ilf {

/// Shares are the projector's part of the light at a pixel: (white - black) / white. Medians over the lit pixels, those
/// where white is at least 5 of 255 above black.
struct AmbientCheck {
    double lit = 0.0;             ///< pixels the projector lights, of all
    double projectorShare = 0.0;  ///< 1: no other light
    double contrast = 0.0;        ///< white above black, 0..255
    double saturated = 0.0;       ///< pixels at the sensor's end in white, of all
    bool go = false;
    std::string what;  ///< one sentence: go, or why not and what would help
};

/// Refused where the two pictures are not of one size, or not grey.
Result<AmbientCheck> ambientCheck(const Image<std::uint8_t>& white, const Image<std::uint8_t>& black);

}  // namespace ilf
