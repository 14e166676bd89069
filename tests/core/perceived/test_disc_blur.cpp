// The disc blur against plain summation, and what it conserves.
#include "core/perceived/disc_blur.h"

#include <cmath>
#include <numbers>
#include <random>

#include "tests/support/law.h"

using namespace ilf;
using namespace ilf::view;

namespace {

Block noise(int width, int height, int channels, unsigned seed) {
    std::mt19937 random(seed);
    Block block(width, height, channels);
    for (float& value : block.values)
        value = static_cast<float>(random() % 1000) / 1000.0F;
    return block;
}

/// What a disc holds of the tent of the pixel at (dx, dy), by points.
double tentInside(double radius, int dx, int dy) {
    const int n = 128;
    double sum = 0.0;
    for (int j = 0; j < n; ++j) {
        for (int i = 0; i < n; ++i) {
            const double u = -1.0 + 2.0 * (i + 0.5) / n, v = -1.0 + 2.0 * (j + 0.5) / n;
            if (std::hypot(dx + u, dy + v) < radius) sum += (1.0 - std::abs(u)) * (1.0 - std::abs(v));
        }
    }
    return 4.0 * sum / (n * n);
}

}  // namespace

TEST_CASE("disc blur: equals the sum over all pixels under the disc") {
    for (const double radius : {0.4, 1.0, 2.7, 6.3}) {
        const Block block = noise(23, 17, 3, 5);
        const Block blurred = discBlurred(block, radius);
        const int reach = discReach(radius);
        REQUIRE(blurred.width == 23 + 2 * reach);
        const int side = 2 * reach + 1;
        std::vector<double> kernel;
        for (int k = 0; k < side * side; ++k)
            kernel.push_back(tentInside(radius, k % side - reach, k / side - reach));
        double worst = 0.0;
        for (int y = 0; y < blurred.height; ++y) {
            for (int x = 0; x < blurred.width; ++x) {
                double sum = 0.0;
                for (int dy = -reach; dy <= reach; ++dy) {
                    for (int dx = -reach; dx <= reach; ++dx) {
                        const int i = x - reach + dx, j = y - reach + dy;
                        if (i < 0 || j < 0 || i >= block.width || j >= block.height) continue;
                        sum += kernel[static_cast<std::size_t>((dy + reach) * side + dx + reach)] *
                               static_cast<double>(block.row(j)[i * 3 + 1]);
                    }
                }
                sum /= std::numbers::pi * radius * radius;
                worst = std::max(worst, std::abs(sum - static_cast<double>(blurred.row(y)[x * 3 + 1])));
            }
        }
        CHECK(worst < 6e-3);
    }
}

TEST_CASE("disc blur: light is conserved") {
    law("the sum over all pixels stays", [] {
        const Block block = noise(*rc::gen::inRange(1, 40), *rc::gen::inRange(1, 40), 1, 3);
        const double radius = 0.01 * *rc::gen::inRange(30, 1500);
        double before = 0.0, after = 0.0;
        for (const float v : block.values)
            before += static_cast<double>(v);
        for (const float v : discBlurred(block, radius).values)
            after += static_cast<double>(v);
        RC_ASSERT(std::abs(after / before - 1.0) < 1e-4);
    });
}
