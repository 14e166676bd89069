// A marker drawn where it is known to be, to a fraction of a pixel: what a camera without noise would see of it.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <opencv2/aruco.hpp>
#include <random>
#include <vector>

#include "core/base/image.h"
#include "core/track/quad.h"

namespace ilf {

inline constexpr int kQuiet = 1;  ///< white cells around the black border

/// Cells of a marker along a side, with border and quiet zone; 1 is white.
inline std::vector<std::uint8_t> markerCells(int dictionary, int id, int& side) {
    const auto set = cv::aruco::getPredefinedDictionary(dictionary);
    const int inner = set->markerSize + 2;
    cv::Mat drawn;
    cv::aruco::drawMarker(set, id, inner, drawn, 1);
    side = inner + 2 * kQuiet;
    std::vector<std::uint8_t> cells(static_cast<std::size_t>(side * side), 1);
    for (int y = 0; y < inner; ++y) {
        for (int x = 0; x < inner; ++x)
            cells[static_cast<std::size_t>((y + kQuiet) * side + x + kQuiet)] =
                drawn.at<std::uint8_t>(y, x) > 127 ? 1 : 0;
    }
    return cells;
}

struct DrawnScene {
    Size size{640, 360};
    double dark = 30.0, light = 200.0, ground = 110.0, noise = 0.0;
    unsigned seed = 1;
};

/// The marker whose black square has these corners, on plain ground; every pixel is the mean of 8 x 8 samples.
inline Image<std::uint8_t> drawnMarker(const DrawnScene& scene, int dictionary, int id, const Quad& corners) {
    int side = 0;
    const auto cells = markerCells(dictionary, id, side);
    const double a = kQuiet, b = side - kQuiet;
    const Motion cellFromPicture = motionBetween(corners, Quad{{{a, a}, {b, a}, {b, b}, {a, b}}}).value();
    const auto around = boxAround(corners).grown(static_cast<int>(std::sqrt(std::abs(signedArea(corners))) / 2));
    std::mt19937 random(scene.seed);
    std::normal_distribution<double> noise(0.0, std::max(scene.noise, 1e-9));
    std::vector<std::uint8_t> pixels(static_cast<std::size_t>(scene.size.width) *
                                     static_cast<std::size_t>(scene.size.height));
    constexpr int kSamples = 8;
    for (int y = 0; y < scene.size.height; ++y) {
        for (int x = 0; x < scene.size.width; ++x) {
            double value = scene.ground;
            if (x >= around.x0 && x < around.x1 && y >= around.y0 && y < around.y1) {
                double sum = 0.0;
                for (int i = 0; i < kSamples * kSamples; ++i) {
                    const auto c = cellFromPicture(
                        Point<CameraFrame>{x + (i % kSamples + 0.5) / kSamples, y + (i / kSamples + 0.5) / kSamples});
                    const bool on = c.x >= 0.0 && c.y >= 0.0 && c.x < side && c.y < side;
                    const auto cell = [&] {
                        return cells[static_cast<std::size_t>(static_cast<int>(c.y) * side + static_cast<int>(c.x))];
                    };
                    sum += !on ? scene.ground : cell() != 0 ? scene.light : scene.dark;
                }
                value = sum / (kSamples * kSamples);
            }
            if (scene.noise > 0.0) value += noise(random);
            pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(scene.size.width) +
                   static_cast<std::size_t>(x)] = static_cast<std::uint8_t>(std::clamp(std::lround(value), 0L, 255L));
        }
    }
    return {scene.size, 1, std::move(pixels)};
}

}  // namespace ilf
