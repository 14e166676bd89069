// The scene in one window of the view: surfaces nearest first, what they reflect, and the light that falls on them.
#pragma once

#include <vector>

#include "core/base/geometry.h"
#include "core/document/document.h"
#include "core/perceived/perceived.h"
#include "core/plan/plan.h"

namespace ilf::view {

/// Pixels of a view: the picture's, times the request's scale.
struct ViewFrame {};

/// View pixels per picture pixel along each axis, and the view's size: whole pixels, so the two differ a little.
struct ViewScale {
    Size size;
    double nominal = 1.0;
    double x = 1.0, y = 1.0;
};
ViewScale viewScale(const Document& document, double scale);

/// A surface of constant distance. `alpha` is what it covers of what nearer surfaces leave (so an unblurred stack
/// composes to exactly the picture); one channel, the window's size.
struct Surface {
    Metre distance;
    Image<float> alpha;
    PixelRect<ViewFrame> covered;  ///< in the window: where alpha is above 0
    RegionId region{};             ///< the first one that lies there
};
std::vector<Surface> surfaces(const std::vector<SceneLayer>& layers, PixelRect<ViewFrame> window);

/// Linear reflectance of the picture in the view, 3 channels.
Radiance albedo(const Document& document, const ViewScale& scale);

/// Box-filtered to `size` (each side at most the image's own).
Image<float> shrunk(const Image<float>& image, Size size);

/// The light of slots that share image and power, as it falls on the scene: window's size, one channel, `weight` of the
/// picture's own brightness where it is 1.
struct Light {
    Image<float> light;
    Dioptre power;
    double weight = 1.0;
};

}  // namespace ilf::view
