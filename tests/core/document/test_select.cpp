// Click-select: on pictures whose right answer is known.
#include "core/document/select.h"

#include <cmath>

#include "core/document/shape.h"
#include "tests/support/law.h"

namespace ilf {

namespace {

/// A reddish disc on a bluish ground, both with a little texture.
Picture discOn(Size size, Point<CameraFrame> centre, double radius) {
    std::vector<std::uint16_t> pixels;
    unsigned noise = 1;
    for (int y = 0; y < size.height; ++y) {
        for (int x = 0; x < size.width; ++x) {
            const bool disc = std::hypot(x + 0.5 - centre.x, y + 0.5 - centre.y) < radius;
            for (int c = 0; c < 3; ++c) {
                noise = noise * 1664525u + 1013904223u;
                const int base = disc ? (c == 0 ? 48000 : 15000) : (c == 2 ? 42000 : 24000);
                pixels.push_back(static_cast<std::uint16_t>(base + static_cast<int>(noise >> 20)));
            }
        }
    }
    return {size, 3, std::move(pixels)};
}

/// Share of pixels, among those of either, on which two masks agree (intersection over union).
double overlap(const Mask& a, const Mask& b) {
    const auto ia = toImage(a), ib = toImage(b);
    double both = 0.0, either = 0.0;
    for (std::size_t i = 0; i < ia.pixels().size(); ++i) {
        both += std::min(ia.pixels()[i], ib.pixels()[i]);
        either += std::max(ia.pixels()[i], ib.pixels()[i]);
    }
    return both / either;
}

Mask disc(Size size, Point<CameraFrame> c, double r) {
    return rasterised(Ellipse{{c.x - r, c.y - r}, {c.x + r, c.y + r}}, size);
}

}  // namespace

TEST_CASE("flood: the connected area of like colour, and only that") {
    const Size size{300, 200};
    const Picture picture = discOn(size, {120.0, 90.0}, 50.0);
    const auto mask = flooded(picture, {120.0, 90.0}, 0.15);
    REQUIRE(mask);
    CHECK(overlap(*mask, disc(size, {120.0, 90.0}, 50.0)) > 0.97);
    const auto ground = flooded(picture, {5.0, 5.0}, 0.15);
    REQUIRE(ground);
    CHECK(overlap(*ground, inverted(disc(size, {120.0, 90.0}, 50.0))) > 0.97);
    CHECK(flooded(picture, {5.0, 5.0}, 1.0) == Mask(size, 255));
}

TEST_CASE("flood: grey pictures and single pixels work too") {
    const Picture grey({4, 3}, 1, {0, 0, 0, 0, 0, 65535, 0, 0, 0, 0, 0, 0});
    const auto mask = flooded(grey, {0.5, 0.5}, 0.2);  // the white pixel is a ninth of the mean
    REQUIRE(mask);
    CHECK(mask->at(3, 2) == 255);
    CHECK(mask->at(1, 1) == 191);  // one pixel left out, its edge smoothed over itself
    CHECK(flooded(Picture({1, 1}, 3, {1, 2, 3}), {0.5, 0.5}, 0.0) == Mask({1, 1}, 255));
}

TEST_CASE("flood: refusals") {
    const Picture picture = discOn({40, 30}, {20.0, 15.0}, 8.0);
    CHECK(flooded(picture, {40.0, 3.0}, 0.1).error().what ==
          "The click was outside the picture: click on what shall be selected.");
    CHECK(flooded(picture, {4.0, 3.0}, std::nan("")).error().what ==
          "The tolerance of a selection must be from 0 to 1.");
    CHECK(flooded({}, {0.0, 0.0}, 0.1).error().what == "There is no picture to select in.");
}

TEST_CASE("cut out: the object in the box, told from what surrounds it") {
    const Size size{300, 200};
    const auto mask = cutOut(discOn(size, {120.0, 90.0}, 50.0), {60, 30, 180, 150});
    REQUIRE(mask);
    CHECK(overlap(*mask, disc(size, {120.0, 90.0}, 50.0)) > 0.97);
    CHECK(cutOut(discOn(size, {120.0, 90.0}, 50.0), {60, 30, 180, 150}) == mask);
}

TEST_CASE("cut out: a large picture is worked on at reduced size and refined to its own pixels") {
    const Size size{1600, 1200};
    const auto mask = cutOut(discOn(size, {800.0, 600.0}, 420.0), {350, 150, 1250, 1050});
    REQUIRE(mask);
    CHECK(overlap(*mask, disc(size, {800.0, 600.0}, 420.0)) > 0.99);
    CHECK(mask->at(800, 600) == 255);
    CHECK(mask->at(10, 10) == 0);
}

TEST_CASE("cut out: refusals") {
    const Picture picture = discOn({100, 80}, {50.0, 40.0}, 20.0);
    CHECK(cutOut(picture, {10, 10, 17, 60}).error().what ==
          "Draw a box of at least 8 x 8 pixels around what shall be selected.");
    CHECK(cutOut(picture, {-10, -10, 200, 200}).error().what ==
          "The box holds the whole picture: draw it so that some of the surroundings stay outside.");
    CHECK_FALSE(cutOut({}, {0, 0, 50, 50}));
}

}  // namespace ilf
