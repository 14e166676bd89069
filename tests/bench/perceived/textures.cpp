#include "tests/bench/perceived/textures.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/srgb.h"

namespace ilf::bench {
namespace {

/// A well mixed number of a place (0..1), the same on every machine.
double hashed(int x, int y, unsigned seed) {
    std::uint32_t h = static_cast<std::uint32_t>(x) * 0x9e3779b1U ^ static_cast<std::uint32_t>(y) * 0x85ebca77U ^
                      (seed + 1U) * 0xc2b2ae3dU;
    for (const std::uint32_t k : {0x2c1b3c6dU, 0x297a2d39U}) {
        h ^= h >> 15U;
        h *= k;
        h ^= h >> 13U;
    }
    return static_cast<double>(h) / 4294967296.0;
}

/// Lines of 12 px with words of random strokes; a letter is a cell of 8 x 9 px with three strokes in it.
double text(int x, int y, unsigned seed) {
    const int line = y / 12, row = y % 12, cell = x / 8, column = x % 8;
    if (row >= 9 || column >= 7 || hashed(cell, line, seed) < 0.15) return 1.0;
    for (int stroke = 0; stroke < 3; ++stroke) {
        const double kind = hashed(3 * cell + stroke, line, seed + 1), at = hashed(3 * cell + stroke, line, seed + 2);
        const int width = 1 + static_cast<int>(2.0 * hashed(cell, line, seed + 3));
        const int along = kind < 0.5 ? column : row;
        const int from = static_cast<int>(at * (kind < 0.5 ? 6.0 : 8.0));
        if (along >= from && along < from + width) return 0.0;
    }
    return 1.0;
}

double smooth(double t) { return t * t * (3.0 - 2.0 * t); }

double natural(double x, double y, unsigned seed) {
    double value = 0.0, weight = 0.0;
    for (int octave = 0; octave < 5; ++octave) {
        const double cell = 64.0 / (1 << octave), part = std::pow(0.6, octave);
        const double u = x / cell, v = y / cell;
        const int i = static_cast<int>(std::floor(u)), j = static_cast<int>(std::floor(v));
        const double fx = smooth(u - i), fy = smooth(v - j);
        const unsigned s = seed + 10U * static_cast<unsigned>(octave);
        const double top = hashed(i, j, s) * (1.0 - fx) + hashed(i + 1, j, s) * fx;
        const double bottom = hashed(i, j + 1, s) * (1.0 - fx) + hashed(i + 1, j + 1, s) * fx;
        value += part * (top * (1.0 - fy) + bottom * fy);
        weight += part;
    }
    // A hard-edged disc in every second field of 96 px.
    const int i = static_cast<int>(x) / 96, j = static_cast<int>(y) / 96;
    const double dx = x - 96.0 * (i + 0.3 + 0.4 * hashed(i, j, seed + 7)), dy = y - 96.0 * (j + 0.5);
    const double radius = 12.0 + 20.0 * hashed(i, j, seed + 8);
    double mean = value / weight;
    if ((i + j) % 2 == 0 && dx * dx + dy * dy < radius * radius) mean = 0.35 * mean + 0.5 * hashed(i, j, seed + 9);
    return std::clamp(mean, 0.0, 1.0);
}

double lights(int x, int y, unsigned seed) { return hashed(x, y, seed) > 0.9985 ? 1.0 : 0.0; }

double value(int x, int y, Texture texture, unsigned seed) {
    switch (texture) {
    case Texture::text:
        return text(x, y, seed);
    case Texture::natural:
        return natural(x, y, seed);
    case Texture::lights:
        return lights(x, y, seed);
    }
    return 0.0;
}

}  // namespace

std::vector<float> plane(Size size, Texture texture, unsigned seed) {
    std::vector<float> values;
    values.reserve(static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height));
    for (int y = 0; y < size.height; ++y)
        for (int x = 0; x < size.width; ++x)
            values.push_back(static_cast<float>(value(x, y, texture, seed)));
    return values;
}

Picture mixedPicture(Size size, unsigned seed) {
    const int field = std::max(32, size.width / 8);
    std::vector<std::uint16_t> pixels;
    pixels.reserve(static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height) * 3);
    for (int y = 0; y < size.height; ++y) {
        for (int x = 0; x < size.width; ++x) {
            const int i = x / field, j = y / field, kind = (i + 2 * j) % 5;
            const Texture texture = kind < 2 ? Texture::text : kind < 4 ? Texture::natural : Texture::lights;
            for (unsigned c = 0; c < 3; ++c) {
                const double tint = 0.6 + 0.4 * hashed(i, j, seed + 100U + c);
                // Letters are one shape in all colours; noise has colours of its own; lights stand on dark grey.
                const double here = texture == Texture::natural ? value(x, y, texture, seed + 40U * c)
                                    : texture == Texture::text  ? tint * (0.03 + 0.97 * value(x, y, texture, seed))
                                                                : 0.05 * tint + 0.95 * value(x, y, texture, seed);
                pixels.push_back(static_cast<std::uint16_t>(std::lround(65535.0 * srgbFromLinear(here))));
            }
        }
    }
    return Picture(size, 3, std::move(pixels));
}

}  // namespace ilf::bench
