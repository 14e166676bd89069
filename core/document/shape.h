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

/// Anti-aliased coverage of a shape over a picture of `size`.
Mask rasterised(const Shape& shape, Size size);

/// Combinations by maximum, minimum and subtraction; sizes must agree. Uniform tiles are shared, not computed.
Mask united(const Mask& a, const Mask& b);
Mask subtracted(const Mask& a, const Mask& b);
Mask inverted(const Mask& mask);

/// Coverage dilated (radius > 0) or eroded (radius < 0) by a disc of |radius| camera pixels; soft edges stay soft.
Mask grown(const Mask& mask, double radius);

}  // namespace ilf
