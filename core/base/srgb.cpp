#include "core/base/srgb.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace ilf {
namespace {

/// Linear light of the 65536 codes of a picture.
const std::vector<float>& linearTable() {
    static const std::vector<float> table = [] {
        std::vector<float> t(65536);
        for (std::size_t i = 0; i < t.size(); ++i) {
            t[i] = static_cast<float>(linearFromSrgb(static_cast<double>(i) / 65535.0));
        }
        return t;
    }();
    return table;
}

/// Where each code ends, and the code at the start of each of 4096 steps of linear light. The steepest part of the
/// curve (12.92 * 255 codes a unit) passes less than one code in a step, so one comparison settles the rest.
struct Codes {
    static constexpr int kSteps = 4096;
    std::array<float, 256> upper{};
    std::array<std::uint8_t, kSteps + 1> first{};
    Codes() {
        for (int c = 0; c < 255; ++c) {
            upper[static_cast<std::size_t>(c)] = static_cast<float>(linearFromSrgb((c + 0.5) / 255.0));
        }
        upper[255] = 2.0F;
        for (int i = 0; i <= kSteps; ++i) {
            const double code = 255.0 * srgbFromLinear(static_cast<double>(i) / kSteps);
            first[static_cast<std::size_t>(i)] = static_cast<std::uint8_t>(std::lround(code));
        }
    }

    /// NaN becomes 0; without branches, so that a loop over many keeps its pace.
    std::uint8_t of(float linear) const {
        const float v = linear > 0.0F ? std::min(linear, 1.0F) : 0.0F;
        const auto code = first[static_cast<std::size_t>(v * static_cast<float>(kSteps))];
        return static_cast<std::uint8_t>(code + (v >= upper[code] ? 1 : 0));
    }
};

const Codes& codes() {
    static const Codes table;
    return table;
}

template <class To, class From, class Map>
Image<To> mapped(const Image<From>& image, const Map& map) {
    std::vector<To> pixels(image.pixels().size());
    std::transform(image.pixels().begin(), image.pixels().end(), pixels.begin(), map);
    return Image<To>(image.size(), image.channels(), std::move(pixels));
}

}  // namespace

double linearFromSrgb(double encoded) {
    return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

double srgbFromLinear(double linear) {
    const double v = std::clamp(linear, 0.0, 1.0);
    return v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1.0 / 2.4) - 0.055;
}

Radiance toLinear(const Picture& picture) {
    const auto& table = linearTable();
    return mapped<float>(picture, [&](std::uint16_t v) { return table[v]; });
}

std::uint8_t srgb8(float linear) { return codes().of(linear); }

Image<std::uint8_t> toSrgb8(const Radiance& radiance) {
    const Codes& table = codes();
    return mapped<std::uint8_t>(radiance, [&](float v) { return table.of(v); });
}

void srgb8FromPlanes(const float* red, const float* green, const float* blue, std::size_t count, std::uint8_t* rgba) {
    const Codes& table = codes();
    for (std::size_t i = 0; i < count; ++i) {
        rgba[4 * i] = table.of(red[i]);
        rgba[4 * i + 1] = table.of(green[i]);
        rgba[4 * i + 2] = table.of(blue[i]);
        rgba[4 * i + 3] = 255;
    }
}

Image<std::uint8_t> toBytes(const Picture& picture) {
    return mapped<std::uint8_t>(picture, [](std::uint16_t v) { return static_cast<std::uint8_t>((v + 128) / 257); });
}

Picture toPicture(const Image<std::uint8_t>& rgb) {
    return mapped<std::uint16_t>(rgb, [](std::uint8_t v) { return static_cast<std::uint16_t>(v * 257); });
}

}  // namespace ilf
