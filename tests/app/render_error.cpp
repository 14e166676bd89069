// The figures of an error map: known values, and equal views.
#include "app/headless/render_error.h"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "app/headless/render_shots.h"

using namespace ilf;
using namespace ilf::app;

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

Radiance flat(Size size, float value) {
    return Radiance(
        size, 3,
        std::vector<float>(static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height) * 3, value));
}

/// Two regions side by side: the border runs down at x = `border`.
Compiled sideBySide(Size size, int border) {
    Scene scene;
    scene.picture = Box<Picture>(
        Picture(size, 3,
                std::vector<std::uint16_t>(
                    static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height) * 3, 40000)));
    Compiled compiled;
    compiled.document = newDocument(std::move(scene));
    std::vector<std::uint8_t> mask;
    for (int i = 0; i < size.width * size.height; ++i)
        mask.push_back(i % size.width < border ? 255 : 0);
    Region region;
    region.id = region.name = "left";
    region.mask = toTiles(Image<std::uint8_t>(size, 1, std::move(mask)));
    compiled.document.regions.emplace_back(region);
    return compiled;
}

}  // namespace

TEST_CASE("error map: a view against itself is 0 everywhere") {
    const Radiance view = flat({5, 4}, 0.3F);
    const ErrorMap map = errorMap(view, view, Image<std::uint8_t>({5, 4}, 1, std::vector<std::uint8_t>(20, 255)));
    for (const float d : map.difference.pixels())
        CHECK(d == 0.0F);
    CHECK(map.figures.psnr_dB == kInfinity);
    CHECK(map.figures.bandPsnr_dB == kInfinity);
    CHECK(map.figures.worst == 0.0);
    CHECK(spokenPsnr(map.figures.psnr_dB, kInfinity) == "no difference");
}

TEST_CASE("error map: sign, PSNR, band and worst pixel are those of the difference") {
    const Size size{10, 10};
    std::vector<float> seen(300, 0.5F);
    seen[3 * (7 * 10 + 2) + 1] = 0.2F;  // green of pixel 2,7: 0.3 too dark
    std::vector<std::uint8_t> band(100, 0);
    band[7 * 10 + 2] = band[0] = 255;
    const ErrorMap map =
        errorMap(Radiance(size, 3, seen), flat(size, 0.5F), Image<std::uint8_t>(size, 1, std::move(band)));
    CHECK(map.difference.at(2, 7, 1) == doctest::Approx(-0.3));
    CHECK(map.figures.worst == doctest::Approx(0.3));
    CHECK(map.figures.worstX == 2);
    CHECK(map.figures.worstY == 7);
    CHECK(map.figures.psnr_dB == doctest::Approx(-10.0 * std::log10(0.09 / 300.0)));
    CHECK(map.figures.bandPsnr_dB == doctest::Approx(-10.0 * std::log10(0.09 / 6.0)));
    CHECK(map.figures.psnr_dB == doctest::Approx(psnr(Radiance(size, 3, seen), flat(size, 0.5F))));
}

TEST_CASE("error map: white is the next of 1, 2 and 5 that nothing exceeds") {
    CHECK(whiteFor(0.0544) == doctest::Approx(0.1));
    CHECK(whiteFor(0.05) == doctest::Approx(0.05));
    CHECK(whiteFor(0.0021) == doctest::Approx(0.005));
    CHECK(whiteFor(0.0011) == doctest::Approx(0.002));
    CHECK(whiteFor(7.0) == doctest::Approx(10.0));
    CHECK(whiteFor(0.0) == doctest::Approx(0.001));
}

TEST_CASE("error map: what drowns in the reference's noise is not told as a figure") {
    CHECK(spokenPsnr(47.23, 60.0) == "47.2 dB");
    CHECK(spokenPsnr(58.0, 60.0) == "above 57.0 dB");
    CHECK(spokenPsnr(kInfinity, 60.0) == "above 57.0 dB");
}

TEST_CASE("error map: the band follows the regions' borders at the view's scale, and no farther than it reaches") {
    const Compiled compiled = sideBySide({40, 20}, 16);
    const auto whole = bordersOf(compiled, {40, 20}, 3);
    const auto half = bordersOf(compiled, {20, 10}, 2);
    for (int x = 0; x < 40; ++x)
        CHECK((whole.at(x, 9) == 255) == (x >= 12 && x <= 18));
    for (int x = 0; x < 20; ++x)
        CHECK((half.at(x, 4) == 255) == (x >= 5 && x <= 9));
    const auto none = bordersOf(sideBySide({40, 20}, 40), {40, 20}, 3);
    for (const auto v : none.pixels())
        REQUIRE(v == 0);
}

TEST_CASE("shots: names tell several pictures apart, and one alone keeps its own") {
    RenderOptions options;
    const auto names = [&] { return filesFor("out/seen.tif", *shotsOf(options, 12)); };
    CHECK(names() == std::vector<std::string>{"out/seen.tif"});
    options.eye = "both";
    CHECK(names() == std::vector<std::string>{"out/seen-left.tif", "out/seen-right.tif"});
    options.views = {"overlay", "perceived", "overlay"};
    CHECK(names() == std::vector<std::string>{"out/seen-overlay.tif", "out/seen-perceived-left.tif",
                                              "out/seen-perceived-right.tif"});
    options.views = {"slots"};
    CHECK(names().size() == 12);
    CHECK(names()[3] == "out/seen-03.tif");
    options.views = {"slot:11"};
    CHECK(names() == std::vector<std::string>{"out/seen.tif"});
    for (const char* none : {"slot:12", "slot:-1", "slot:1.5", "slot:", "slot:x"}) {
        options.views = {none};
        REQUIRE_FALSE_MESSAGE(shotsOf(options, 12), none);
        CHECK(shotsOf(options, 12).error().what.find("slots 0 to 11") != std::string::npos);
    }
    CHECK(checkedViews({"perceived", "error", "plain", "camera", "overlay", "slots", "slot:3"}));
    CHECK_FALSE(checkedViews({"perceived", "depth"}));
}

TEST_CASE("request: what the options say is what is asked of the view") {
    Document document = sideBySide({40, 20}, 16).document;
    RenderOptions options;
    ViewRequest expected;
    expected.eye = Eye::right;
    CHECK(*requestOf(options, document, Eye::right) == expected);
    options.attend = "left";
    options.gaze = "12.5,7";
    options.rung = "idle";
    options.scale = 0.5;
    options.chromatic = options.lensField = true;
    const auto request = requestOf(options, document, Eye::left);
    REQUIRE(request);
    expected = {};
    expected.attending = "left";
    expected.scale = 0.5;
    expected.rung = Rung::idle;
    expected.gaze = Gaze::fixed;
    expected.gazeAt = {12.5, 7.0};
    expected.chromatic = expected.lensField = true;
    CHECK(*request == expected);
    options.gaze = "follows";
    CHECK(requestOf(options, document, Eye::left)->gaze == Gaze::follows);
    for (const char* none : {"up", "1", "1,", ",1", "1,2,3", "41,2", "-1,2", "nan,2"}) {
        options.gaze = none;
        CHECK_FALSE_MESSAGE(requestOf(options, document, Eye::left), none);
    }
    options.gaze = "ahead";
    options.attend = "right";
    CHECK(requestOf(options, document, Eye::left).error().what.find("\"left\"") != std::string::npos);
    Region twin = *document.regions[0];
    twin.id = "other";
    document.regions.emplace_back(twin);
    document.regions[0] = Box<Region>([&] {
        Region r = twin;
        r.id = "first";
        return r;
    }());
    options.attend = "left";
    CHECK(requestOf(options, document, Eye::left).error().what.find("2 regions") != std::string::npos);
    options.attend = "other";
    CHECK(requestOf(options, document, Eye::left)->attending == RegionId("other"));
}
