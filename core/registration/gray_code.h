// Gray-code patterns for the projector, and what a camera's pictures of them decode to.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/image.h"
#include "core/base/result.h"
#include "core/registration/pixel_map.h"

namespace ilf {

/// One picture of a scan. Bits count from the most significant one, 0.
struct Pattern {
    enum class Kind { white, black, column, row, marker };
    Kind kind = Kind::white;
    int bit = 0;
    bool inverse = false;
    bool operator==(const Pattern&) const = default;
};

/// White and black, then columns, then rows, every bit beside its inverse.
std::vector<Pattern> grayCodePatterns(Size projector);
/// What the projector shows for it: 0 or 255.
Image<std::uint8_t> patternPicture(const Pattern& pattern, Size projector);

/// Pictures of one scan, grey, all of one size; pictures[i] shows patterns[i].
struct Scan {
    Size projector;
    std::vector<Pattern> patterns;
    std::vector<Image<std::uint8_t>> pictures;
};

/// Why a camera pixel has no place on the raster, or that it has one.
enum class PixelState : std::uint8_t {
    decoded,
    dark,          ///< hardly lit: shadow (that other surfaces may light a little), dark surface, or outside the light
    saturated,     ///< white or black is at the end of the sensor's range
    ambiguous,     ///< a bit and its inverse differ too little: an edge, inter-reflection, noise
    inconsistent,  ///< its code lies outside the raster, or away from all neighbours'
};

struct DecodeOptions {
    double leastContrast = 5.0;  ///< white above black, 0..255
    double leastMargin = 0.1;    ///< of a bit against its inverse, as a share of white above black
    bool operator==(const DecodeOptions&) const = default;
};

struct DecodedScan {
    Size projector;
    Image<float> projectorOfCamera;  ///< camera's size, x and y on the raster, sub-pixel; NaN where not decoded
    Image<std::uint8_t> confidence;  ///< camera's size; 0: not decoded
    Image<std::uint8_t> state;       ///< camera's size; PixelState
    std::array<int, 5> count{};      ///< pixels of each state
};

/// Refused in words: sizes that differ, a bit or its inverse that is missing, neither white nor black.
Result<DecodedScan> decodedScan(const Scan& scan, const DecodeOptions& options = {});

/// The two-way map of a decoded scan, holes continued from around them; refused when fewer than a thousand pixels were
/// decoded.
Result<DenseMap> denseMap(const DecodedScan& decoded);

}  // namespace ilf
