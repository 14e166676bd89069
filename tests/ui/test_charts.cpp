// The charts' records: what the plan says, in the numbers of the paper.
#include <doctest/doctest.h>

#include "tests/ui/headless.h"
#include "ui/charts.h"

using namespace ilf;
using namespace ilf::ui;
using namespace ilf::ui::test;

TEST_CASE("sweep chart: reaches from the lowest to the highest power, and has a bar for every slot") {
    const auto planned = plan(planInput(twoRegions()));
    REQUIRE(planned);
    const SweepChart chart = sweepChart(*planned);
    CHECK(chart.time_ms.high == doctest::Approx(1000.0 / 60.0));
    REQUIRE(chart.bars.size() == 16);
    double low = 1e9, high = -1e9;
    for (const ChartPoint& point : chart.curve) {
        low = std::min(low, point.y);
        high = std::max(high, point.y);
    }
    CHECK(low == doctest::Approx(0.0).epsilon(1e-3));
    CHECK(high == doctest::Approx(planned->pS->si() + 0.2).epsilon(1e-3));
    int lit = 0;
    for (const auto& bar : chart.bars) {
        CHECK(bar.end_ms - bar.start_ms == doctest::Approx(1000.0 / 960.0));
        if (bar.kind) ++lit;
    }
    CHECK(lit >= 2);
    CHECK(lit < 16);
}

TEST_CASE("blur range chart: the driving region is marked and lies on the far border at its P_min") {
    const Document document = twoRegions();
    const auto planned = plan(planInput(document));
    REQUIRE(planned);
    const BlurRangeChart chart = blurRangeChart(*planned, document.wearer);
    REQUIRE(chart.objects.size() == 3);
    const auto& clutter = chart.objects[0];
    CHECK(clutter.name == "Clutter");
    CHECK(clutter.drives);
    CHECK(clutter.nearest_m == doctest::Approx(0.5));
    REQUIRE(clutter.pMin_D);
    CHECK(*clutter.pMin_D == doctest::Approx(*valueAt(chart.farBorder, 0.5)).epsilon(0.01));
    CHECK(*chart.pS_D == *clutter.pMin_D);
    CHECK(chart.top_D == doctest::Approx(*chart.pS_D + 0.2));
    CHECK_FALSE(chart.objects[1].drives);
}

TEST_CASE("seam chart: its worst contrast is the worse eye's") {
    SeamProfile profile;
    profile.millimetres = {-1, 0, 1};
    profile.left = {{1, 0.5f, 1}, {1, 0.98f, 1}, 0.5, 0.02};
    profile.right = {{1, 1.4f, 1}, {1, 1.05f, 1}, 0.4, 0.05};
    const SeamChart chart = seamChart(profile);
    CHECK(chart.worstBefore == 0.5);
    CHECK(chart.worstAfter == 0.05);
    CHECK(chart.light.low < 0.5);
    CHECK(chart.light.high > 1.4);
    CHECK(*valueAt(chart.leftBefore, 0.5) == doctest::Approx(0.75));
    CHECK_FALSE(valueAt(chart.leftBefore, 2.0));
}

TEST_CASE("ticks: round numbers inside the range, never more than asked for") {
    CHECK(ticks({0, 16.7}, 4) == std::vector<double>{0, 5, 10, 15});
    CHECK(ticks({-0.26, 2.84}, 4) == std::vector<double>{0, 1, 2});
    CHECK(ticks({1, 1}, 4).empty());
    for (int most = 1; most < 12; ++most)
        CHECK(ticks({-3.3, 12.9}, most).size() <= static_cast<std::size_t>(most) + 1);
}
