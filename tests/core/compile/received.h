// What an eye receives from a compiled program on one flat, evenly coloured surface, summed point by point.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include "core/compile/compile.h"
#include "core/document/shape.h"

namespace ilf {

/// A picture without content, `size` pixels, seen at 60 degrees.
inline Scene blankScene(Size size) {
    Scene scene;
    scene.picture = Box<Picture>(
        Picture(size, 3,
                std::vector<std::uint16_t>(
                    static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height) * 3, 0x8000)));
    scene.scale = {focalPixels(size.width, 60.0), PixelScale::Source::assumed};
    return scene;
}

inline Box<Region> regionOf(const std::string& id, Look look, Metre distance, Mask mask) {
    Region region;
    region.id = region.name = id;
    region.look = look;
    region.distance = ConstantDistance{distance, {}};
    region.mask = std::move(mask);
    return Box<Region>(region);
}

/// Everything at one distance: the background of one look, the regions of others.
inline Document flatDocument(Size size, Look background, Metre distance) {
    Document document = newDocument(blankScene(size));
    document.background = regionOf(kBackgroundId, background, distance, {});
    return document;
}

inline Plan planned(const Document& document) { return plan(planInput(document)).value(); }
inline Compiled compiledFrom(const Document& document, const Compiled* previous = nullptr) {
    return compile(document, planned(document), previous).value();
}

/// Light at the apparent place `at` (projector pixels), 1 = a region away from borders. Independent of the compiler's
/// way: every level is looked up at 300 points of the eye's blur disc, each carried back through the magnification.
/// Assumes the picture fitted into the raster and one distance everywhere.
inline double received(const Compiled& compiled, Metre distance, Point<ProjectorFrame> at) {
    const Document& document = compiled.document;
    const Plan& plan = compiled.plan;
    const EyeOptics eye = eyeOptics(document.wearer);
    const auto map = pixelMap(document).nearest();
    const Point<CameraFrame> left = opticalCentre(document, Eye::left, distance);
    const Point<CameraFrame> right = opticalCentre(document, Eye::right, distance);
    const Point<ProjectorFrame> c = map(Point<CameraFrame>{0.5 * (left.x + right.x), 0.5 * (left.y + right.y)});
    double sum = 0.0;
    for (std::size_t l = 0; l < plan.levels.size(); ++l) {
        const Level& level = plan.levels[l];
        const TileGrid& image = compiled.program.images[l];
        const double s = magnification(eye, distance, plan.focusPower, level.power);
        const Metre onRetina = blurDiameterAttending(eye, distance, level.power, distance, plan.focusPower);
        const double radius = document.scene.scale.focalPixels * (onRetina / (2.0 * eye.retina)) * map.m[0];
        const auto look = [&](double x, double y) {
            const double fx = c.x + (x - c.x) / s - 0.5, fy = c.y + (y - c.y) / s - 0.5;
            const int ix = static_cast<int>(std::floor(fx)), iy = static_cast<int>(std::floor(fy));
            const double ax = fx - ix, ay = fy - iy;
            const auto pixel = [&](int i, int j) {
                return static_cast<double>(
                    image.at(std::clamp(i, 0, image.size().width - 1), std::clamp(j, 0, image.size().height - 1)));
            };
            return (pixel(ix, iy) * (1 - ax) + pixel(ix + 1, iy) * ax) * (1 - ay) +
                   (pixel(ix, iy + 1) * (1 - ax) + pixel(ix + 1, iy + 1) * ax) * ay;
        };
        double light = 0.0;
        constexpr int kSamples = 300;
        for (int i = 0; i < kSamples; ++i) {  // a sunflower: even over the disc
            const double r = radius * std::sqrt((i + 0.5) / kSamples), a = i * std::numbers::pi * (3 - std::sqrt(5.0));
            light += look(at.x + r * std::cos(a), at.y + r * std::sin(a));
        }
        sum += light / kSamples / 255.0;
    }
    return sum;
}

struct LightRange {
    double least = 1e9, most = -1e9;
    double worst() const { return std::max(std::abs(least - 1.0), std::abs(most - 1.0)); }
};
inline LightRange receivedOver(const Compiled& compiled, Metre distance, PixelRect<ProjectorFrame> rect, int step) {
    LightRange extremes;
    for (int y = rect.y0; y < rect.y1; y += step) {
        for (int x = rect.x0; x < rect.x1; x += step) {
            const double v = received(compiled, distance, {x + 0.5, y + 0.5});
            extremes.least = std::min(extremes.least, v);
            extremes.most = std::max(extremes.most, v);
        }
    }
    return extremes;
}

}  // namespace ilf
