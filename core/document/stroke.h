// From pointer positions to dabs: a brush stroke as data.
#pragma once

#include <optional>
#include <vector>

#include "core/base/geometry.h"
#include "core/base/tile_grid.h"

namespace ilf {

/// A round brush. `radius` in camera pixels; `hardness` 0..1 is the share of the radius that is fully covered, the rest
/// falls off smoothly to the edge, over no less than one pixel about it; `opacity` 0..1.
struct Brush {
    double radius = 20.0;
    double hardness = 0.8;
    double opacity = 1.0;
    bool operator==(const Brush&) const = default;
};

/// One touch of the brush.
struct Dab {
    Point<CameraFrame> at;
    Brush brush;
    bool operator==(const Dab&) const = default;
};

/// Distance between the dabs of a stroke, in camera pixels: a quarter of the radius, less for large brushes, so that
/// the scallops a hard brush leaves at its edge (spacing^2 / 8 radius) stay below a quarter of a pixel; at least 1.
double dabSpacing(const Brush& brush);

/// Dabs along the way from `from` to `to` for a stroke in progress, `dabSpacing` apart. `carry` is the way left over
/// since the last dab, and is updated, so that a stroke gives the same dabs however its pointer positions were split.
/// The first call of a stroke (carry nothing) also gives the dab at `from`.
std::vector<Dab> spacedDabs(Point<CameraFrame> from, Point<CameraFrame> to, const Brush& brush,
                            std::optional<double>& carry);

enum class PaintMode {
    add,    ///< values combine by maximum
    erase,  ///< values combine by minimum
};

/// `mask` with dabs painted on it. Brushes combine by maximum, erasers by minimum, so a stroke painted dab by dab is
/// the stroke painted at once, in any order. `keepOut`, if given, is coverage that must not be painted over (other
/// regions): where it is k, no more than 255 - k is added; erasers take no notice of it. Shares every tile that no dab
/// changes.
Mask painted(const Mask& mask, const std::vector<Dab>& dabs, PaintMode mode, const Mask* keepOut = nullptr);

/// Pixels a dab can change, not clipped.
PixelRect<CameraFrame> reach(const Dab& dab);

}  // namespace ilf
