// The decoder's vectors count what a plain loop counts.
#include <cstdlib>
#include <vector>

#include "core/registration/gray_code_agree.h"
#include "tests/support/law.h"

namespace {

using namespace ilf;

TEST_CASE("neighbours that agree are counted as a plain loop counts them, whatever the width") {
    law("counts", [] {
        constexpr std::int16_t kNowhere = 20000;
        const int width = *rc::gen::inRange(1, 150), height = 2 * kAgreeReach + 1;
        const auto gateX = *rc::gen::inRange<std::int16_t>(1, 1200), gateY = *rc::gen::inRange<std::int16_t>(1, 1200);
        const auto stride = static_cast<std::size_t>(width + 2 * kAgreeReach);
        std::vector<std::int16_t> x(stride * static_cast<std::size_t>(height) + kAgreeOverrun, kNowhere), y = x;
        auto seed = *rc::gen::arbitrary<std::uint32_t>();
        const auto random = [&](int below) {
            seed = seed * 1664525U + 1013904223U;
            return static_cast<int>(seed >> 8) % below;
        };
        const int spread = random(2) == 0 ? 16000 : 100;  // hardly any agree, or most
        for (int j = 0; j < height; ++j) {
            for (int i = 0; i < width; ++i) {
                if (random(4) == 0) continue;
                const std::size_t n = static_cast<std::size_t>(j) * stride + static_cast<std::size_t>(i + kAgreeReach);
                x[n] = static_cast<std::int16_t>(random(spread) - spread / 2);
                y[n] = static_cast<std::int16_t>(random(spread) - spread / 2);
            }
        }
        const std::size_t row = kAgreeReach * stride + kAgreeReach;
        Agreement got(static_cast<std::size_t>(width));
        countAgreeing({x.data() + row, y.data() + row, static_cast<std::ptrdiff_t>(stride), kNowhere}, width, gateX,
                      gateY, got);
        for (std::size_t i = 0; i < static_cast<std::size_t>(width); ++i) {
            int agree = 0, known = 0, sumX = 0, sumY = 0;
            for (std::size_t v = 0; v < static_cast<std::size_t>(height); ++v) {
                for (std::size_t u = 0; u <= 2 * kAgreeReach; ++u) {
                    const std::size_t there = v * stride + i + u;
                    const int dx = x[there] - x[row + i], dy = y[there] - y[row + i];
                    known += x[there] != kNowhere ? 1 : 0;
                    if (std::abs(dx) >= gateX || std::abs(dy) >= gateY) continue;
                    ++agree;
                    sumX += dx;
                    sumY += dy;
                }
            }
            RC_ASSERT(got.agree[i] == agree);
            RC_ASSERT(got.known[i] == known);
            RC_ASSERT(got.sumX[i] == sumX);
            RC_ASSERT(got.sumY[i] == sumY);
        }
    });
}

}  // namespace
