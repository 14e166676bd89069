#include "core/registration/hole_filling.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "core/base/parallel.h"

namespace ilf {

namespace {

/// Half the size, rounded up: weighted means of 2 x 2.
Field coarser(const Field& fine) {
    Field out;
    out.size = {(fine.size.width + 1) / 2, (fine.size.height + 1) / 2};
    const auto columns = static_cast<std::size_t>(out.size.width);
    out.values.resize(2 * columns * static_cast<std::size_t>(out.size.height));
    out.known.resize(columns * static_cast<std::size_t>(out.size.height));
    parallelFor(out.size.height, [&](int j) {
        for (int i = 0; i < out.size.width; ++i) {
            float x = 0.0F, y = 0.0F, weight = 0.0F;
            for (int v = 2 * j; v < std::min(2 * j + 2, fine.size.height); ++v) {
                for (int u = 2 * i; u < std::min(2 * i + 2, fine.size.width); ++u) {
                    const auto n = static_cast<std::size_t>(v) * static_cast<std::size_t>(fine.size.width) +
                                   static_cast<std::size_t>(u);
                    x += fine.known[n] * fine.values[2 * n];
                    y += fine.known[n] * fine.values[2 * n + 1];
                    weight += fine.known[n];
                }
            }
            const std::size_t to = static_cast<std::size_t>(j) * columns + static_cast<std::size_t>(i);
            out.known[to] = std::min(1.0F, weight);
            out.values[2 * to] = weight > 0.0F ? x / weight : 0.0F;
            out.values[2 * to + 1] = weight > 0.0F ? y / weight : 0.0F;
        }
    });
    return out;
}

/// Whatever the finer field does not know it takes from the coarser one, bilinearly.
void blend(Field& fine, const Field& coarse) {
    parallelFor(fine.size.height, [&](int j) {
        const float v =
            std::clamp((static_cast<float>(j) + 0.5F) / 2.0F - 0.5F, 0.0F, static_cast<float>(coarse.size.height - 1));
        const int row = std::min(static_cast<int>(v), std::max(0, coarse.size.height - 2));
        const int below = std::min(row + 1, coarse.size.height - 1);
        const float b = v - static_cast<float>(row);
        for (int i = 0; i < fine.size.width; ++i) {
            const std::size_t n =
                static_cast<std::size_t>(j) * static_cast<std::size_t>(fine.size.width) + static_cast<std::size_t>(i);
            if (fine.known[n] >= 1.0F) continue;
            const float u = std::clamp((static_cast<float>(i) + 0.5F) / 2.0F - 0.5F, 0.0F,
                                       static_cast<float>(coarse.size.width - 1));
            const int column = std::min(static_cast<int>(u), std::max(0, coarse.size.width - 2));
            const int right = std::min(column + 1, coarse.size.width - 1);
            const float a = u - static_cast<float>(column);
            for (std::size_t channel = 0; channel < 2; ++channel) {
                const auto at = [&](int x, int y) {
                    return coarse
                        .values[2 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(coarse.size.width) +
                                     static_cast<std::size_t>(x)) +
                                channel];
                };
                const float around = (at(column, row) * (1.0F - a) + at(right, row) * a) * (1.0F - b) +
                                     (at(column, below) * (1.0F - a) + at(right, below) * a) * b;
                float& here = fine.values[2 * n + channel];
                here = fine.known[n] * here + (1.0F - fine.known[n]) * around;
            }
        }
    });
}

}  // namespace

void fillHoles(Field& field) {
    std::vector<Field> levels;
    const Field* last = &field;
    while (last->size.width > 1 || last->size.height > 1) {
        levels.push_back(coarser(*last));
        last = &levels.back();
    }
    for (std::size_t level = levels.size(); level-- > 0;)
        blend(level == 0 ? field : levels[level - 1], levels[level]);
}

}  // namespace ilf
