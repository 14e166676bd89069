// Scenes seen through one still lens power by an eye that stays as it is, for the reference to be measured on.
#pragma once

#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>

#include "core/lens/waveform.h"
#include "core/perceived/reference.h"
#include "tests/core/perceived/small_scene.h"

namespace ilf::test {

inline const RegionId kHere = "here";  ///< the region the eye looks at

inline Mask maskIn(PixelRect<CameraFrame> rect) {
    return maskOf(kSmall, [=](int x, int y) { return x >= rect.x0 && x < rect.x1 && y >= rect.y0 && y < rect.y1; });
}

/// Black and white.
inline Picture drawn(const std::function<bool(int, int)>& white) {
    std::vector<std::uint16_t> pixels;
    for (int y = 0; y < kSmall.height; ++y) {
        for (int x = 0; x < kSmall.width; ++x)
            pixels.insert(pixels.end(), 3, white(x, y) ? std::uint16_t{65535} : std::uint16_t{0});
    }
    return Picture(kSmall, 3, std::move(pixels));
}
inline Picture point(int atX, int atY) {
    return drawn([=](int x, int y) { return x == atX && y == atY; });
}
inline Picture white() {
    return drawn([](int, int) { return true; });
}

/// The picture lies at `seen`; the eye looks at kHere, a patch in the corner, at `attended`; one lens in the middle.
/// Blur shows large: a pixel is 1/2000 of slope.
inline Document lookingAt(Picture picture, double seen, double attended) {
    Document d = document({region(kHere, Look::focus, attended, maskIn({0, 0, 6, 6}))}, Look::blur, seen);
    d.scene.picture = Box<Picture>(std::move(picture));
    d.scene.scale.focalPixels = 2000.0;
    d.wearer.axes = {LensAxis{}, LensAxis{}};
    return d;
}

/// One level lights everything, all the time, through `power`; the picture is taken, and the eye is accommodated,
/// through the lens at 0 D.
inline Played through(const Document& document, double power) {
    Played p = played(document);
    p.plan.waveform = stillWave(0.0_D, Dioptre::fromSi(power), p.plan.waveform.rate);
    p.plan.focusPower = 0.0_D;
    for (RegionPlan& one : p.plan.regions)
        one.levelPower = 0.0_D;
    for (std::size_t i = 0; i < p.program.images.size(); ++i)
        p.program.images[i] = TileGrid(p.program.projector, i == 0 ? std::uint8_t{255} : std::uint8_t{0});
    return p;
}

inline ViewRequest lookingHere(Eye eye = Eye::left) {
    ViewRequest request;
    request.eye = eye;
    request.attending = kHere;
    return request;
}

inline ReferencePixels rays(const Played& p, const ViewRequest& request, const std::vector<ViewPixel>& pixels,
                            int samples = 4096, unsigned seed = 1) {
    return *Reference::of(p.document, p.plan, p.program, request)->pixels(pixels, {samples, seed});
}

inline std::vector<ViewPixel> pixelsIn(PixelRect<CameraFrame> rect) {
    std::vector<ViewPixel> pixels;
    for (int y = rect.y0; y < rect.y1; ++y) {
        for (int x = rect.x0; x < rect.x1; ++x)
            pixels.push_back({x, y});
    }
    return pixels;
}

inline std::vector<ViewPixel> somePixels(PixelRect<CameraFrame> rect, int count) {
    std::mt19937 random(3);
    std::vector<ViewPixel> pixels;
    for (int i = 0; i < count; ++i) {
        pixels.push_back({rect.x0 + static_cast<int>(random() % static_cast<unsigned>(rect.width())),
                          rect.y0 + static_cast<int>(random() % static_cast<unsigned>(rect.height()))});
    }
    return pixels;
}

/// How a point is seen: where, how large a disc, and how much light in all. Of a uniform disc the variance along x is a
/// quarter of the squared radius; the tent of a pixel between its neighbours adds 1/6 of a pixel, magnified.
struct SeenPoint {
    double x = 0.0, y = 0.0, radius = 0.0, light = 0.0;
};
inline SeenPoint seenPoint(const ReferencePixels& seen, const std::vector<ViewPixel>& pixels, double magnification,
                           std::size_t colour = 0) {
    SeenPoint point;
    double second = 0.0;
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        const double here = seen.radiance[i][colour], x = pixels[i].x + 0.5, y = pixels[i].y + 0.5;
        point.light += here;
        point.x += here * x;
        point.y += here * y;
        second += here * x * x;
    }
    point.x /= point.light;
    point.y /= point.light;
    const double variance = second / point.light - point.x * point.x - magnification * magnification / 6.0;
    point.radius = 2.0 * std::sqrt(std::max(0.0, variance));
    return point;
}

/// PSNR of values against a reference's pixels.
inline double agreement(const ReferencePixels& seen, const std::vector<std::array<double, 3>>& model) {
    double sum = 0.0;
    for (std::size_t i = 0; i < model.size(); ++i) {
        for (std::size_t c = 0; c < 3; ++c)
            sum += (seen.radiance[i][c] - model[i][c]) * (seen.radiance[i][c] - model[i][c]);
    }
    return -10.0 * std::log10(sum / (3.0 * static_cast<double>(model.size())));
}

/// A picture between its pixel centres.
inline std::array<double, 3> bilinear(const Radiance& picture, double x, double y) {
    const int i = static_cast<int>(std::floor(x - 0.5)), j = static_cast<int>(std::floor(y - 0.5));
    const double fx = x - 0.5 - i, fy = y - 0.5 - j;
    std::array<double, 3> value{};
    for (int c = 0; c < 3; ++c) {
        const auto at = [&](int dx, int dy) { return static_cast<double>(picture.at(i + dx, j + dy, c)); };
        value[static_cast<std::size_t>(c)] =
            (1.0 - fy) * ((1.0 - fx) * at(0, 0) + fx * at(1, 0)) + fy * ((1.0 - fx) * at(0, 1) + fx * at(1, 1));
    }
    return value;
}

/// Mean of `shown(px, py)` over the unit disc: rings of equal area, points spread evenly along each.
inline std::array<double, 3> overDisc(const std::function<std::array<double, 3>(double, double)>& shown) {
    constexpr int kRings = 48, kSpokes = 96;
    std::array<double, 3> sum{};
    for (int ring = 0; ring < kRings; ++ring) {
        const double radius = std::sqrt((ring + 0.5) / kRings);
        for (int spoke = 0; spoke < kSpokes; ++spoke) {
            const double angle = 2.0 * std::numbers::pi * (spoke + 0.618 * ring) / kSpokes;
            const auto value = shown(radius * std::cos(angle), radius * std::sin(angle));
            for (std::size_t c = 0; c < 3; ++c)
                sum[c] += value[c] / (kRings * kSpokes);
        }
    }
    return sum;
}

}  // namespace ilf::test
