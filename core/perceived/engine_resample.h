// Where each pixel of a tile looks in a coarser or unmagnified picture, and with which weights.
#pragma once

#include <array>
#include <vector>

#include "core/perceived/engine_planes.h"

namespace ilf::view {

/// How values between samples are found.
enum class Interpolation {
    linear,  ///< of pictures that are not blurred: what lies between pixels is bilinear
    smooth,  ///< of blurred ones: a cubic, or for coarse ones four taps fitted to undo what averaging took away
};

/// A map from view pixels to samples of a picture averaged over `coarse` pixels, about an optical centre:
/// sample = (centre + (pixel - centre) / magnification) / coarse, both at their own pixels' centres.
struct Placing {
    int coarse = 1;  ///< 1, 2 or 4
    double magnification = 1.0;
    double centreX = 0.0, centreY = 0.0;
    Interpolation interpolation = Interpolation::smooth;
    /// Linear only: a disc of this radius (samples, below 1) is laid over what is found, by its profile along each
    /// axis.
    double softness = 0.0;
    bool operator==(const Placing&) const = default;
};

/// Pixels of one row of a tile, sixteen at a time: pixel = coarse * (16 group + lane) + phase.
struct AcrossTaps {
    static constexpr int kLanes = 16;
    int first = 0, width = 0;  ///< samples that are read
    int coarse = 1;
    int taps = 4;  ///< of every group; a magnified picture needs some more than four
    struct Group {
        int base = 0;     ///< lane l reads samples first + base + l .. + taps
        int weights = 0;  ///< index into `weights`, taps x 16
    };
    std::vector<Group> groups;  ///< phase by phase, in each from left to right
    std::vector<float> weights;
};
AcrossTaps acrossTaps(const Placing& placing, int column);

/// Rows of a tile: row y is the sum of four rows of samples.
struct DownTaps {
    int first = 0, height = 0;
    std::array<int, kTileH> row{};  ///< from `first`
    std::array<std::array<float, 4>, kTileH> weights{};
};
DownTaps downTaps(const Placing& placing, int row);

/// Averaging to 1/2 weighs four pixels so, along each axis; to 1/4 it is done twice.
inline constexpr float kOuterTap = 0.1F, kInnerTap = 0.4F;
/// Pixels it reads beyond its own, to either side.
constexpr int averagingLead(int coarse) { return coarse == 1 ? 0 : coarse == 2 ? 1 : 3; }

}  // namespace ilf::view
