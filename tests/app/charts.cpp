// Charts: round ticks, and files that are what their names say.
#include <doctest/doctest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "app/exit_code.h"
#include "app/headless/optics_command.h"
#include "app/plots/draw.h"
#include "app/plots/optics_charts.h"
#include "projects/pictures.h"
#include "tests/projects/folder.h"

using namespace ilf;
using namespace ilf::app;

namespace {

/// Share of pixels of about that colour.
double share(const Picture& picture, int red, int green, int blue) {
    int count = 0;
    for (int y = 0; y < picture.height(); ++y) {
        for (int x = 0; x < picture.width(); ++x) {
            const auto near = [&](int channel, int want) {
                return std::abs(picture.at(x, y, channel) / 257 - want) < 12;
            };
            count += near(0, red) && near(1, green) && near(2, blue) ? 1 : 0;
        }
    }
    return static_cast<double>(count) / (picture.width() * picture.height());
}

}  // namespace

TEST_CASE("charts: ticks are round numbers inside the range") {
    CHECK(ticks(0.0, 5.0, 6) == std::vector<double>{0, 1, 2, 3, 4, 5});
    CHECK(tickWords(ticks(0.0, 5.0, 6)).back() == "5");
    CHECK(tickWords(ticks(1.0, 1.12, 6)).front() == "1.00");
    CHECK(tickWords(ticks(-0.3, 0.3, 6))[3] == "0.0");
    for (const auto& [low, high] : {std::pair(-3.7, 12.2), std::pair(1e-6, 3e-6), std::pair(180.0, 2500.0)}) {
        const auto made = ticks(low, high, 7);
        REQUIRE(made.size() >= 2);
        CHECK(made.size() <= 12);
        CHECK(made.front() >= low - 1e-12);
        CHECK(made.back() <= high * (1.0 + 1e-12));
    }
    const ChartAxis around = axisOver("x", 0.13, 0.93);
    CHECK(around.low <= 0.13);
    CHECK(around.high >= 0.93);
    const ChartAxis nothing = axisOver("x", HUGE_VAL, -HUGE_VAL);
    CHECK(nothing.low < nothing.high);
    CHECK(std::isfinite(nothing.low));
}

TEST_CASE("charts: every optics chart has axes, units and points within them") {
    for (const char* name : {"far-border", "near-border", "blur", "scale"}) {
        const auto chart = opticsChart(name);
        REQUIRE(chart);
        CHECK(chart->curves.size() >= 4);
        for (const ChartAxis& axis : {chart->x, chart->y})
            CHECK(axis.low < axis.high);
        int inside = 0;
        for (const Curve& curve : chart->curves) {
            for (const ChartPoint& p : curve.points)
                inside += p.y >= chart->y.low && p.y <= chart->y.high ? 1 : 0;
        }
        CHECK(inside > 400);
    }
    CHECK_FALSE(opticsChart("pupil"));
    // Known values of the reference tables, read off the curves' own points.
    const auto far = opticsChart("far-border");
    const ChartPoint& last = far->curves.front().points.back();
    CHECK(last.x == 2500.0);
    CHECK(last.y == doctest::Approx(0.472616435841722).epsilon(1e-12));
    CHECK(opticsChart("scale")->curves.at(1).points.back().y == doctest::Approx(0.52 / 0.47).epsilon(1e-12));
}

TEST_CASE("charts: a PNG shows the curve in its colour and an SVG is one") {
    const Folder folder;
    const Chart chart{"Title",
                      "note",
                      {"x [m]", 0.0, 1.0},
                      {"y [D]", 0.0, 1.0},
                      {{"rising", Mark::line, 0, {{0.0, 0.0}, {1.0, 1.0}}}}};
    Chart empty = chart;
    empty.curves.front().points.clear();
    REQUIRE(writeChart(folder.path() / "a.png", chart));
    REQUIRE(writeChart(folder.path() / "b.png", empty));
    const auto drawn = projects::readPicture(folder.path() / "a.png"),
               bare = projects::readPicture(folder.path() / "b.png");
    REQUIRE(drawn);
    REQUIRE(bare);
    CHECK(drawn->picture.size() == Size{1800, 1120});
    const double line = share(drawn->picture, 0, 115, 179), swatch = share(bare->picture, 0, 115, 179);
    CHECK(line > swatch + 0.001);
    CHECK(share(bare->picture, 255, 255, 255) > 0.9);
    REQUIRE(writeChart(folder.path() / "c.svg", chart));
    CHECK(contentOf(folder.path() / "c.svg").find("<svg") != std::string::npos);
}

TEST_CASE("charts: refusals leave no file") {
    const Folder folder;
    const Chart chart = *opticsChart("blur");
    CHECK(writeChart(folder.path() / "a.jpg", chart).error().what.find(".png") != std::string::npos);
    CHECK_FALSE(writeChart(folder.path() / "missing" / "a.png", chart));
    CHECK(std::filesystem::is_empty(folder.path()));
    CHECK(opticsPlotCommand({"pupil", (folder.path() / "a.png").string()}) == kFailed);
    CHECK(opticsPlotCommand({"blur", (folder.path() / "a.gif").string()}) == kFailed);
    REQUIRE(opticsPlotCommand({"blur", (folder.path() / "a.svg").string()}) == kDone);
    CHECK(std::filesystem::file_size(folder.path() / "a.svg") > 5000);
}
