#include "core/solid/texture.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "core/base/srgb.h"

namespace ilf {

Texture::Texture(const Material& material) : wrap_(material.wrap) {
    assert(material.texture.channels() == 3);
    static const std::array<std::uint16_t, 256> kLinear = [] {
        std::array<std::uint16_t, 256> table{};
        for (std::size_t i = 0; i < table.size(); ++i)
            table[i] =
                static_cast<std::uint16_t>(std::lround(65535.0 * linearFromSrgb(static_cast<double>(i) / 255.0)));
        return table;
    }();
    Level full{material.texture.size(), {}};
    full.linear.reserve(material.texture.pixels().size());
    for (const std::uint8_t code : material.texture.pixels())
        full.linear.push_back(kLinear[code]);
    levels_.push_back(std::move(full));
    while (levels_.back().size.width > 1 || levels_.back().size.height > 1) {
        const Level& from = levels_.back();
        Level half{{std::max(1, from.size.width / 2), std::max(1, from.size.height / 2)}, {}};
        half.linear.resize(3 * static_cast<std::size_t>(half.size.width) * static_cast<std::size_t>(half.size.height));
        std::size_t to = 0;
        for (int y = 0; y < half.size.height; ++y) {
            for (int x = 0; x < half.size.width; ++x) {
                for (std::size_t c = 0; c < 3; ++c) {
                    std::uint32_t sum = 2;
                    for (const int corner : {0, 1, 2, 3}) {
                        const int fromX = std::min(2 * x + corner % 2, from.size.width - 1);
                        const int fromY = std::min(2 * y + corner / 2, from.size.height - 1);
                        sum += from.linear[3 * (static_cast<std::size_t>(fromY) *
                                                    static_cast<std::size_t>(from.size.width) +
                                                static_cast<std::size_t>(fromX)) +
                                           c];
                    }
                    half.linear[to++] = static_cast<std::uint16_t>(sum / 4);
                }
            }
        }
        levels_.push_back(std::move(half));
    }
}

int Texture::wrapped(int i, int count, std::size_t axis) const {
    switch (wrap_[axis]) {
    case Material::Wrap::clamp:
        return std::clamp(i, 0, count - 1);
    case Material::Wrap::mirror: {
        const int there = ((i % (2 * count)) + 2 * count) % (2 * count);
        return there < count ? there : 2 * count - 1 - there;
    }
    case Material::Wrap::repeat:
        break;
    }
    return ((i % count) + count) % count;
}

std::array<float, 3> Texture::at(float u, float v, float texels) const {
    // A texel or less a pixel: the full picture; 2 of them: halves; ...
    const float doublings = std::log2(std::max(texels, 1.0F));
    const auto level = std::min(levels_.size() - 1, static_cast<std::size_t>(std::lround(std::min(doublings, 30.0F))));
    const Level& from = levels_[level];
    // Coordinates that no texture is meant for stay within what an int holds.
    const float x = std::clamp(u, -1e4F, 1e4F) * static_cast<float>(from.size.width) - 0.5F;
    const float y = std::clamp(v, -1e4F, 1e4F) * static_cast<float>(from.size.height) - 0.5F;
    const float left = std::floor(x), top = std::floor(y);
    const float fx = x - left, fy = y - top;
    const auto row = [&](int i) {
        return static_cast<std::size_t>(wrapped(static_cast<int>(top) + i, from.size.height, 1)) *
               static_cast<std::size_t>(from.size.width);
    };
    const auto column = [&](int i) {
        return static_cast<std::size_t>(wrapped(static_cast<int>(left) + i, from.size.width, 0));
    };
    const std::size_t rows[2] = {row(0), row(1)}, columns[2] = {column(0), column(1)};
    std::array<float, 3> value{};
    for (std::size_t c = 0; c < 3; ++c) {
        const auto texel = [&](std::size_t j, std::size_t i) {
            return static_cast<float>(from.linear[3 * (rows[j] + columns[i]) + c]);
        };
        const float upper = texel(0, 0) + fx * (texel(0, 1) - texel(0, 0));
        const float lower = texel(1, 0) + fx * (texel(1, 1) - texel(1, 0));
        value[c] = (upper + fy * (lower - upper)) / 65535.0F;
    }
    return value;
}

}  // namespace ilf
