// The bump watch: a camera that stands still says nothing, one that was moved does, and a new reference is looked at
// anew.
#include "app/studio/bump_watch.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <random>
#include <thread>
#include <vector>

using namespace ilf;
using namespace ilf::app;

namespace {

constexpr Size kCamera{480, 360};

/// Grey tiles at random on grey ground, `shift` pixels to the right; `gain`: of the light.
std::vector<std::uint8_t> table(int shift, double gain = 1.0, unsigned seed = 4) {
    std::vector<double> grey(480 * 360, 90.0);
    std::mt19937 random(seed);
    const auto number = [&](int n) { return static_cast<int>(random() % static_cast<unsigned>(n)); };
    for (int i = 0; i < 260; ++i) {
        const int x0 = number(520) - 20 + shift, y0 = number(360), w = 8 + number(40), h = 8 + number(30);
        const double ink = 30.0 + number(150);
        for (int y = y0; y < std::min(360, y0 + h); ++y) {
            for (int x = std::max(0, x0); x < std::min(480, x0 + w); ++x)
                grey[static_cast<std::size_t>(480 * y + x)] = ink;
        }
    }
    std::vector<std::uint8_t> rgb;
    for (int y = 0; y < 360; ++y) {
        for (int x = 0; x < 480; ++x) {
            // As a lens softens edges: equal pixels side by side are no corner.
            double sum = 0.0;
            for (int k = 0; k < 9; ++k) {
                const int u = std::clamp(x + k % 3 - 1, 0, 479), v = std::clamp(y + k / 3 - 1, 0, 359);
                sum += (k == 4 ? 4.0 : k % 2 == 1 ? 2.0 : 1.0) * grey[static_cast<std::size_t>(480 * v + u)];
            }
            rgb.insert(rgb.end(), 3, static_cast<std::uint8_t>(std::min(255.0, gain * sum / 16.0)));
        }
    }
    return rgb;
}

Image<std::uint8_t> seen(int shift, double gain = 1.0, unsigned seed = 4) {
    return {kCamera, 3, table(shift, gain, seed)};
}

Box<Picture> reference(unsigned seed = 4) {
    std::vector<std::uint16_t> wide;
    for (const std::uint8_t value : table(0, 1.0, seed))
        wide.push_back(static_cast<std::uint16_t>(257 * value));
    return Box(Picture(kCamera, 3, std::move(wide)));
}

std::optional<BumpReport> report(BumpWatch& watch, const Box<Picture>& was, const Image<std::uint8_t>& now) {
    watch.compare(was, now);
    const auto patience = std::chrono::steady_clock::now() + std::chrono::seconds(20);
    while (std::chrono::steady_clock::now() < patience) {
        if (auto found = watch.tryTake()) return found;
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return std::nullopt;
}

}  // namespace

TEST_CASE("bump watch: still, in other light, moved, moved back, and against a new reference") {
    std::atomic<int> news = 0;
    BumpWatch watch([&] { ++news; });
    const Box<Picture> was = reference();
    const auto still = report(watch, was, seen(0));
    REQUIRE(still);
    CHECK_FALSE(still->bumped);
    CHECK(still->features >= 40);
    const auto dimmer = report(watch, was, seen(0, 0.7));
    REQUIRE(dimmer);
    CHECK_FALSE(dimmer->bumped);
    const auto moved = report(watch, was, seen(7));
    REQUIRE(moved);
    CHECK(moved->bumped);
    CHECK(moved->moved_px == doctest::Approx(7.0).epsilon(0.1));
    REQUIRE(moved->newFromOld);
    const auto at = (*moved->newFromOld)({200.0, 150.0});
    CHECK(at.x == doctest::Approx(207.0).epsilon(0.005));
    CHECK(at.y == doctest::Approx(150.0).epsilon(0.005));
    const auto back = report(watch, was, seen(0));
    REQUIRE(back);
    CHECK_FALSE(back->bumped);
    // Another place altogether is the reference now: what is seen of it has not moved.
    const auto elsewhere = report(watch, reference(9), seen(0, 1.0, 9));
    REQUIRE(elsewhere);
    CHECK_FALSE(elsewhere->bumped);
    CHECK_FALSE(elsewhere->blind);
    const auto strange = report(watch, reference(9), seen(0));
    REQUIRE(strange);
    CHECK_FALSE(strange->bumped);
    CHECK(strange->blind);
    CHECK(news == 6);
}

TEST_CASE("bump watch: without features nothing is said, and it goes on looking") {
    BumpWatch watch({});
    const Box<Picture> blank = Box(Picture(kCamera, 3, std::vector<std::uint16_t>(480 * 360 * 3, 20000)));
    watch.compare(blank, seen(0));
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    CHECK_FALSE(watch.tryTake());
    const auto next = report(watch, reference(), seen(5));
    REQUIRE(next);
    CHECK(next->bumped);
}
