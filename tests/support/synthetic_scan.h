// Pictures a made-up camera takes of a projector's patterns, for tests of what reads them. Shares nothing with the
// decoder but the names of patterns: bits are numbered here anew.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <random>
#include <utility>
#include <vector>

#include "core/registration/gray_code.h"

namespace ilf {

struct SyntheticCamera {
    Size camera{256, 192};
    Size projector{128, 96};
    /// Where on the raster a point of the picture looks (centres at + 0.5).
    std::function<std::array<double, 2>(double, double)> look = [](double x, double y) {
        return std::array{0.5 * x, 0.5 * y};
    };
    /// How much of the light comes back, 0 to 1; 0: shadow.
    std::function<double(double, double)> albedo = [](double, double) { return 1.0; };
    double ambient = 10.0, light = 150.0;  ///< levels
    double noise = 0.0;                    ///< rms, levels
    double second = 0.0;                   ///< share of light from another part of the raster: gloss
    int samples = 4;                       ///< along each side of a pixel
};

inline bool litBit(int at, int count, int bit) {
    int bits = 0;
    while ((1 << bits) < count)
        ++bits;
    bits = std::max(bits, 1);
    const auto binary = [&](int b) { return b < 0 ? 0 : (at >> (bits - 1 - b)) & 1; };
    return binary(bit) != binary(bit - 1);
}

/// Raster pixels that the samples of each camera pixel look at, -1 outside: worked out once for all patterns.
struct Looks {
    std::vector<std::array<short, 2>> at;
    std::vector<double> albedo;
};
inline Looks looksOf(const SyntheticCamera& at) {
    Looks looks;
    for (int j = 0; j < at.camera.height; ++j) {
        for (int i = 0; i < at.camera.width; ++i) {
            looks.albedo.push_back(at.albedo(i + 0.5, j + 0.5));
            for (int n = 0; n < at.samples * at.samples; ++n) {
                const double u = (n % at.samples + 0.5) / at.samples, v = (n / at.samples + 0.5) / at.samples;
                const auto [x, y] = at.look(i + u, j + v);
                const bool inside = x >= 0.0 && y >= 0.0 && x < at.projector.width && y < at.projector.height;
                looks.at.push_back({static_cast<short>(inside ? x : -1.0), static_cast<short>(inside ? y : -1.0)});
            }
        }
    }
    return looks;
}

inline Image<std::uint8_t> photographed(const SyntheticCamera& at, const Looks& looks, const Pattern& pattern,
                                        unsigned seed) {
    using enum Pattern::Kind;
    std::vector<double> acrossX(static_cast<std::size_t>(at.projector.width), pattern.kind == black ? 0.0 : 1.0);
    std::vector<double> acrossY(static_cast<std::size_t>(at.projector.height), 1.0);
    for (std::size_t x = 0; pattern.kind == column && x < acrossX.size(); ++x)
        acrossX[x] = litBit(static_cast<int>(x), at.projector.width, pattern.bit) != pattern.inverse ? 1.0 : 0.0;
    for (std::size_t y = 0; pattern.kind == row && y < acrossY.size(); ++y)
        acrossY[y] = litBit(static_cast<int>(y), at.projector.height, pattern.bit) != pattern.inverse ? 1.0 : 0.0;
    std::mt19937 random(seed);
    std::normal_distribution<double> noise(0.0, std::max(1e-9, at.noise));
    const auto samples = static_cast<std::size_t>(at.samples * at.samples);
    std::vector<std::uint8_t> pixels(looks.albedo.size());
    for (std::size_t n = 0; n < pixels.size(); ++n) {
        double light = 0.0;
        for (std::size_t k = n * samples; k < (n + 1) * samples; ++k) {
            const auto [x, y] = looks.at[k];
            if (x < 0) continue;
            const auto column = static_cast<std::size_t>(x), line = static_cast<std::size_t>(y);
            light += acrossX[column] * acrossY[line];
            if (at.second <= 0.0) continue;
            const std::size_t width = acrossX.size(), height = acrossY.size();
            light += at.second * acrossX[(column * 7 / 10 + 41) % width] * acrossY[(line * 6 / 10 + 29) % height];
        }
        light *= looks.albedo[n] * at.light / static_cast<double>(samples);
        const double level = at.ambient + light + (at.noise > 0.0 ? noise(random) : 0.0);
        pixels[n] = static_cast<std::uint8_t>(std::clamp(std::lround(level), 0L, 255L));
    }
    return {at.camera, 1, std::move(pixels)};
}
inline Image<std::uint8_t> photographed(const SyntheticCamera& at, const Pattern& pattern, unsigned seed = 1) {
    return photographed(at, looksOf(at), pattern, seed);
}

inline Scan scanned(const SyntheticCamera& at) {
    Scan scan{at.projector, grayCodePatterns(at.projector), {}};
    const Looks looks = looksOf(at);
    unsigned seed = 1;
    for (const Pattern& pattern : scan.patterns)
        scan.pictures.push_back(photographed(at, looks, pattern, seed++));
    return scan;
}

/// Another picture, each level changed.
inline Image<std::uint8_t> changed(const Image<std::uint8_t>& picture, const std::function<double(int, int, int)>& f) {
    std::vector<std::uint8_t> pixels;
    for (int y = 0; y < picture.height(); ++y) {
        for (int x = 0; x < picture.width(); ++x)
            pixels.push_back(static_cast<std::uint8_t>(std::clamp(f(picture.at(x, y), x, y), 0.0, 255.0)));
    }
    return {picture.size(), 1, std::move(pixels)};
}

struct MapError {
    int decoded = 0;
    double rms = 0.0, worst = 0.0;  ///< raster pixels, in two dimensions
};
inline MapError errorOf(const DecodedScan& decoded, const SyntheticCamera& at) {
    MapError error;
    for (int j = 0; j < at.camera.height; ++j) {
        for (int i = 0; i < at.camera.width; ++i) {
            if (decoded.confidence.at(i, j) == 0) continue;
            const auto [x, y] = at.look(i + 0.5, j + 0.5);
            const double off = std::hypot(double(decoded.projectorOfCamera.at(i, j, 0)) - x,
                                          double(decoded.projectorOfCamera.at(i, j, 1)) - y);
            ++error.decoded;
            error.rms += off * off;
            error.worst = std::max(error.worst, off);
        }
    }
    error.rms = error.decoded > 0 ? std::sqrt(error.rms / error.decoded) : 0.0;
    return error;
}

}  // namespace ilf
