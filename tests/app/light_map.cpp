// What a scan that came to no decoding shows of its light.
#include "app/scan/light_map.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <string>

using namespace ilf;
using namespace ilf::app;

namespace {

constexpr Size kSize{40, 30};

/// `left` on the left half, `right` on the right.
Image<std::uint8_t> halves(std::uint8_t left, std::uint8_t right) {
    std::vector<std::uint8_t> pixels;
    for (int i = 0; i < kSize.width * kSize.height; ++i)
        pixels.push_back(i % kSize.width < kSize.width / 2 ? left : right);
    return Image<std::uint8_t>(kSize, 1, std::move(pixels));
}

std::array<std::uint8_t, 3> at(const LightMap& map, int x) {
    return {map.rgb.at(x, 5, 0), map.rgb.at(x, 5, 1), map.rgb.at(x, 5, 2)};
}
std::array<std::uint8_t, 3> inkOf(const LightMap& map, const std::string& word) {
    const auto found =
        std::ranges::find_if(map.legend, [&](const auto& entry) { return entry.words.starts_with(word); });
    REQUIRE(found != map.legend.end());
    return found->rgb;
}

}  // namespace

TEST_CASE("light map: what is told from black, hardly, and what is at the sensor's end have the legend's colours") {
    const LightMap some = lightMap(halves(200, 30), halves(20, 20), {});
    CHECK(at(some, 3) == inkOf(some, "green"));
    CHECK(at(some, 30) == inkOf(some, "pale green"));
    const LightMap bright = lightMap(halves(255, 21), halves(20, 20), {});
    CHECK(at(bright, 3) == inkOf(bright, "yellow"));
    CHECK(at(bright, 30) == inkOf(bright, "black"));
}

TEST_CASE("light map: where something moved, that is orange and the rest is the picture") {
    const LightMap moved = lightMap(halves(200, 100), halves(20, 20), halves(200, 140));
    CHECK(at(moved, 3) == std::array<std::uint8_t, 3>{100, 100, 100});
    CHECK(at(moved, 30) == inkOf(moved, "orange"));
}

TEST_CASE("light map: where nothing follows the projector it is what the camera saw, not a map of specks") {
    const LightMap other = lightMap(halves(180, 60), halves(178, 61), {});
    CHECK(at(other, 3) == std::array<std::uint8_t, 3>{180, 180, 180});
    CHECK(at(other, 30) == std::array<std::uint8_t, 3>{60, 60, 60});
    CHECK(other.legend.size() == 1);
}
