// Rectangles, ellipses, polygons and lassos as coverage, and masks grown, shrunk, inverted.
#pragma once

#include <variant>
#include <vector>

#include "core/base/tile_grid.h"
#include "core/document/document.h"

namespace ilf {

struct Rectangle {
    Point<CameraFrame> a, b;  ///< two opposite corners
    bool operator==(const Rectangle&) const = default;
};
struct Ellipse {
    Point<CameraFrame> a, b;  ///< two opposite corners of its box
    bool operator==(const Ellipse&) const = default;
};
/// Polygon and lasso alike; closed, non-zero winding.
using Shape = std::variant<Rectangle, Ellipse, Outline>;

/// Coverage of a shape over a picture of `size`: the exact share of each pixel's area (of an ellipse, to 0.005 px of
/// its outline). Where the outline crosses itself inside one pixel, that pixel is approximate.
Mask rasterised(const Shape& shape, Size size);

/// max(a, b); min(a, 255 - b); 255 - mask. Sizes must agree. Uniform tiles are shared, not computed.
Mask united(const Mask& a, const Mask& b);
Mask subtracted(const Mask& a, const Mask& b);
Mask inverted(const Mask& mask);

/// Coverage dilated (radius > 0) or eroded (radius < 0) by a disc of |radius| camera pixels. Each level of coverage
/// moves by the same distance, so hard edges stay hard and soft ones soft; a fraction of a pixel is blended between the
/// two whole radii about it. More than 12 levels of coverage are taken as 12 and what lies between is interpolated.
/// What lies outside the picture does not erode it.
Mask grown(const Mask& mask, double radius);

}  // namespace ilf
