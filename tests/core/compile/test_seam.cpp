// Borders between focused and blurred light, as an eye receives them.
#include <doctest/doctest.h>

#include "tests/core/compile/received.h"

namespace {

using namespace ilf;

constexpr Size kSize{512, 384};

/// A blurred ellipse on a sharp surface at half a metre.
Document scene(Point<CameraFrame> a, Point<CameraFrame> b, Blending blending, Look background = Look::focus) {
    Document document = flatDocument(kSize, background, 0.5_m);
    document.rig.projector = kSize;
    document.regions = {regionOf("clutter", Look::blur, 0.5_m, rasterised(Ellipse{a, b}, kSize))};
    document.seam = {blending, 10.0_mm};
    return document;
}
const Point<CameraFrame> kOverA{180, 120}, kOverB{330, 270};   // holds the optical centre
const Point<CameraFrame> kAsideA{360, 60}, kAsideB{480, 200};  // lies aside of it

}  // namespace

TEST_CASE("closed form: a seam around the optical centre and one aside of it are even to 1.5 %") {
    for (const auto& [a, b] : {std::pair{kOverA, kOverB}, std::pair{kAsideA, kAsideB}}) {
        const Compiled compiled = compiledFrom(scene(a, b, Blending::closedForm));
        REQUIRE(compiled.plan.sweeps());
        const LightRange light = receivedOver(compiled, 0.5_m,
                                              {static_cast<int>(a.x) - 30, static_cast<int>(a.y) - 30,
                                               static_cast<int>(b.x) + 30, static_cast<int>(b.y) + 30},
                                              3);
        INFO(light.least, " ", light.most);
        CHECK(light.worst() < 0.015);
        CHECK(compiled.counters.seamTiles > 0);
    }
}

TEST_CASE("none: overlap is bright where blurred light lies nearer the centre, gap is dark where it lies outside") {
    const auto along = [](const Compiled& compiled, int from, int to) {
        return receivedOver(compiled, 0.5_m, {from, 130, to, 131}, 1);
    };
    // The right border of a region that lies aside: its blurred light is nearer the centre and grows over the border.
    const Compiled none = compiledFrom(scene(kAsideA, kAsideB, Blending::none));
    const LightRange outer = along(none, 465, 500), inner = along(none, 345, 375);
    CHECK(outer.most > 1.5);
    CHECK(outer.least > 0.97);
    CHECK(inner.least < 0.6);
    CHECK(inner.most < 1.03);
}

TEST_CASE("the paper's ramps: better than none, the apparent reading better than the literal one, closed form best") {
    const auto worst = [](Blending blending) {
        const Compiled compiled = compiledFrom(scene(kAsideA, kAsideB, blending));
        return receivedOver(compiled, 0.5_m, {340, 40, 500, 220}, 3).worst();
    };
    const double none = worst(Blending::none), object = worst(Blending::linearObject);
    const double apparent = worst(Blending::linearPerceived), closed = worst(Blending::closedForm);
    INFO(none, " ", object, " ", apparent, " ", closed);
    CHECK(object < none);
    CHECK(apparent < object);
    CHECK(closed < 0.25 * apparent);
}

TEST_CASE("a neutral surface beside a blurred or focused one is as even as those two are") {
    const Compiled blurOnNeutral = compiledFrom(scene(kAsideA, kAsideB, Blending::closedForm, Look::neutral));
    CHECK(receivedOver(blurOnNeutral, 0.5_m, {340, 40, 500, 220}, 4).worst() < 0.015);

    Document three = scene(kAsideA, kAsideB, Blending::closedForm);
    three.regions.push_back(
        regionOf("label", Look::neutral, 0.5_m, rasterised(Rectangle{{60, 100}, {420, 300}}, kSize)));
    CHECK(receivedOver(compiledFrom(three), 0.5_m, {40, 60, 480, 320}, 7).worst() < 0.02);
}

TEST_CASE("two blurs of different strength side by side stay even") {
    Document document = scene(kAsideA, kAsideB, Blending::closedForm);
    Region weak = *regionOf("weak", Look::blur, 0.5_m, rasterised(Rectangle{{300, 60}, {425, 200}}, kSize));
    weak.strength = 0.2_D;
    Region strong = *document.regions[0];
    strong.strength = 0.8_D;
    document.rig.slotRate = document.rig.fastest =
        4800.0_Hz;  // short slots: the sine holds the weaker level in the middle of the sweep too
    document.regions = {Box<Region>(strong), Box<Region>(weak)};
    const Compiled compiled = compiledFrom(document);
    REQUIRE(compiled.plan.levels.size() == 3);
    const LightRange light = receivedOver(compiled, 0.5_m, {280, 40, 500, 220}, 4);
    INFO(light.least, " ", light.most);
    CHECK(light.worst() < 0.05);
}

TEST_CASE("away from borders the weights of all levels add up to all light") {
    const Compiled compiled = compiledFrom(scene(kAsideA, kAsideB, Blending::closedForm));
    for (const auto& [x, y] : {std::pair{20, 20}, std::pair{420, 130}, std::pair{250, 350}}) {
        int sum = 0;
        for (std::size_t l = 0; l < compiled.plan.levels.size(); ++l)
            sum += compiled.program.images[l].at(x, y);
        CHECK(sum == 255);
    }
}

TEST_CASE("across a depth step masks stay as painted") {
    Document document = scene(kAsideA, kAsideB, Blending::closedForm);
    document.background = regionOf(kBackgroundId, Look::focus, 0.6_m, {});  // 1/0.5 - 1/0.6 = 0.33 D
    const Compiled step = compiledFrom(document);
    REQUIRE(step.program.images.size() == 2);
    const Mask& mask = document.regions[0]->mask;
    const double full = 255.0;
    int wrong = 0;
    for (int y = 30; y < 230; ++y) {
        for (int x = 330; x < 510; ++x) {
            wrong += std::abs(step.program.images[1].at(x, y) - full * mask.at(x, y) / 255.0) > 1.0 ? 1 : 0;
            wrong += std::abs(step.program.images[0].at(x, y) + step.program.images[1].at(x, y) - 255) > 2 ? 1 : 0;
        }
    }
    CHECK(wrong == 0);
    // The same surfaces 0.1 D apart are one surface to the eye: blended.
    document.background = regionOf(kBackgroundId, Look::focus, Metre::fromSi(1.0 / 1.9), {});
    const Compiled smooth = compiledFrom(document);
    int between = 0;
    for (int x = 330; x < 510; ++x) {
        const int v = smooth.program.images[1].at(x, 130);
        between += v > 20 && v < 235 ? 1 : 0;
    }
    CHECK(between > 10);
}

TEST_CASE("a brush softer than the feather keeps its own softness") {
    Document document = scene(kAsideA, kAsideB, Blending::closedForm);
    std::vector<std::uint8_t> pixels;
    for (int y = 0; y < kSize.height; ++y)
        for (int x = 0; x < kSize.width; ++x)
            pixels.push_back(static_cast<std::uint8_t>(std::clamp(255 * (x - 200) / 120, 0, 255)));
    document.regions = {regionOf("soft", Look::blur, 0.5_m, toTiles(Image<std::uint8_t>(kSize, 1, pixels)))};
    const Compiled compiled = compiledFrom(document);
    // 120 px of brush against 9 px of feather: 5 % and 95 % lie 108 px apart, not 8.
    int first = 0, last = 0;
    for (int x = 150; x < 400; ++x) {
        if (first == 0 && compiled.program.images[1].at(x, 192) > 12) first = x;
        if (last == 0 && compiled.program.images[1].at(x, 192) > 242) last = x;
    }
    CHECK(last - first == doctest::Approx(108).epsilon(0.06));
}
