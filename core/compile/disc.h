// The eye's blur disc as a filter over 8-bit light.
#pragma once

#include <vector>

#include "core/compile/patch.h"

namespace ilf {

/// A disc of real radius, anti-aliased: a pixel weighs its area inside the disc; weights sum to 1.
class Disc {
public:
    explicit Disc(double radius);

    /// Pixels it reaches from its centre.
    int reach() const { return static_cast<int>(rows_.size()) - 1; }
    /// Weight of the pixel (dx, dy) from the centre: what tests compare with.
    double weight(int dx, int dy) const;
    /// `light` averaged over the disc around each pixel of `at`; `light` must cover `at` grown by reach().
    Patch<float> averaged(const Patch<std::uint8_t>& light, PixelRect<ProjectorFrame> at) const;

    bool operator==(const Disc&) const = default;

private:
    /// The pixels at one height above or below the centre: a run of whole ones, then those the rim cuts.
    struct Row {
        int whole = -1;          ///< pixels -whole .. whole are inside; -1: none
        std::vector<float> rim;  ///< weights of whole + 1, whole + 2, ... on both sides
        bool operator==(const Row&) const = default;
    };
    std::vector<Row> rows_;  ///< for |dy| = 0, 1, ...
    float wholeWeight_ = 1.0F;
};

}  // namespace ilf
