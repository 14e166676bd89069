#include "core/registration/gray_code.h"

#include <utility>

#include "core/registration/gray_code_bits.h"

namespace ilf {

int bitsFor(int count) {
    int bits = 1;
    while ((1 << bits) < count)
        ++bits;
    return bits;
}

std::vector<Pattern> grayCodePatterns(Size projector) {
    using enum Pattern::Kind;
    std::vector<Pattern> patterns{{white, 0, false}, {black, 0, false}};
    for (const auto& [kind, count] : {std::pair{column, projector.width}, std::pair{row, projector.height}}) {
        for (int bit = 0; bit < bitsFor(count); ++bit) {
            patterns.push_back({kind, bit, false});
            patterns.push_back({kind, bit, true});
        }
    }
    return patterns;
}

Image<std::uint8_t> patternPicture(const Pattern& pattern, Size projector) {
    const auto bit = [&](int at, int count) {
        const int gray = at ^ (at >> 1);
        return (gray >> (bitsFor(count) - 1 - pattern.bit) & 1) != 0;
    };
    const auto lit = [&](int x, int y) {
        using enum Pattern::Kind;
        switch (pattern.kind) {
        case white:
            return true;
        case black:
            return false;
        case column:
            return bit(x, projector.width) != pattern.inverse;
        case row:
            return bit(y, projector.height) != pattern.inverse;
        case marker:
            break;
        }
        // One quarter of the raster, clockwise from the upper left.
        const bool right = 2 * x >= projector.width, below = 2 * y >= projector.height;
        return (right == (pattern.bit == 1 || pattern.bit == 2) && below == (pattern.bit >= 2)) != pattern.inverse;
    };
    std::vector<std::uint8_t> pixels;
    pixels.reserve(static_cast<std::size_t>(projector.width) * static_cast<std::size_t>(projector.height));
    for (int y = 0; y < projector.height; ++y) {
        for (int x = 0; x < projector.width; ++x)
            pixels.push_back(lit(x, y) ? 255 : 0);
    }
    return {projector, 1, std::move(pixels)};
}

}  // namespace ilf
