// Edges that move, against the table of the reference (scheduling 5).
#include "core/perceived/seam_motion.h"

#include "tests/core/perceived/seam_scene.h"
#include "tests/support/law.h"

using namespace ilf;
using namespace ilf::test;

namespace {

/// One slot at each end of the sweep, as in the table.
EdgeLight ends(double rate_Hz) {
    const Second period = Second::fromSi(1.0 / rate_Hz);
    return {period, {{0.25 * period, 1.0, false}, {0.75 * period, 1.0, true}}};
}

struct Row {
    const char* what;
    double rate_Hz, feather_mm, speedError;
    MaskTiming timing;
    Watching watching;
    double percent[6];  // at 10, 50, 100, 250, 500, 1000 mm/s
};

}  // namespace

TEST_CASE("seam motion: edges leave what the reference's table says") {
    using enum MaskTiming;
    using enum Watching;
    for (const Row& row : {Row{"held, pursuit", 60, 10, 0, perPeriod, pursuit, {0.8, 4.1, 8.3, 21, 42, 81}},
                           Row{"held, still", 60, 10, 0, perPeriod, still, {0.8, 4.2, 8.4, 17, 22, 24}},
                           Row{"own time, pursuit", 60, 10, 0, perSlot, pursuit, {0, 0, 0, 0, 0, 0}},
                           Row{"own time, still", 60, 10, 0, perSlot, still, {0, 0.03, 0.1, 0.9, 3.4, 16}},
                           Row{"20 mm, still", 60, 20, 0, perSlot, still, {0, 0.01, 0.05, 0.4, 1.7, 4.3}},
                           Row{"120 Hz, still", 120, 10, 0, perSlot, still, {0, 0, 0, 0.05, 0.3, 1.5}},
                           Row{"10 % off, pursuit", 60, 10, 0.1, perSlot, pursuit, {0.05, 0.4, 0.8, 2.1, 4.1, 8.3}}}) {
        for (std::size_t i = 0; i < 6; ++i) {
            const double speeds_mm_s[] = {10, 50, 100, 250, 500, 1000};
            CAPTURE(row.what);
            CAPTURE(speeds_mm_s[i]);
            const MovingEdge edge{Metre::fromSi(1e-3 * row.feather_mm), 2.0_mm, 1e-3 * speeds_mm_s[i], row.speedError};
            const double percent = 100.0 * movingSeam(ends(row.rate_Hz), edge, row.timing, row.watching);
            // The table is rounded, and takes even light's own ripple off in another way: a quarter of a percent.
            CHECK(std::abs(percent - row.percent[i]) < 0.25 + 0.05 * row.percent[i]);
        }
    }
}

TEST_CASE("seam motion: masks of each slot's own moment leave nothing to an eye that follows, whatever the slots") {
    law("pursuit of per-slot masks shows nothing; of held ones at most v |t_a - t_b| / W", [] {
        const double speed = 1e-3 * *rc::gen::inRange(1, 2000);
        const auto at = [] { return Second::fromSi(1e-6 * *rc::gen::inRange(0, 16666)); };
        const EdgeLight light{Second::fromSi(1.0 / 60.0), {{at(), 0.5, false}, {at(), 0.5, false}, {at(), 1.0, true}}};
        const MovingEdge edge{10.0_mm, 2.0_mm, speed, 0.0};
        RC_ASSERT(movingSeam(light, edge, MaskTiming::perSlot, Watching::pursuit) < 1e-12);
        double apart = 0.0;
        for (const auto& a : light.pulses)
            apart = std::max(apart, std::abs((a.at - light.pulses[2].at).si()));
        RC_ASSERT(movingSeam(light, edge, MaskTiming::perPeriod, Watching::pursuit) <= speed * apart / 0.01 + 1e-9);
    });
}

TEST_CASE(
    "seam motion: the speed that shows is where 1 % is passed, and a feather of 2 v T keeps below a few percent") {
    const MovingEdge edge{10.0_mm, 2.0_mm, 0.0, 0.0};
    const auto held = speedThatShows(ends(60), edge, MaskTiming::perPeriod, Watching::pursuit);
    REQUIRE(held);
    CHECK(*held == doctest::Approx(0.01 * 0.010 * 2.0 * 60.0).epsilon(0.02));  // 1 % W / (T / 2)
    const auto own = speedThatShows(ends(60), edge, MaskTiming::perSlot, Watching::still);
    REQUIRE(own);
    CHECK(*own > 0.25);
    CHECK(*own < 0.5);
    MovingEdge at = edge;
    at.speed_m_s = *own;
    CHECK(movingSeam(ends(60), at, MaskTiming::perSlot, Watching::still) == doctest::Approx(0.01).epsilon(0.05));
    CHECK_FALSE(speedThatShows(ends(60), edge, MaskTiming::perSlot, Watching::pursuit));

    CHECK(featherForSpeed(0.25, Second::fromSi(1.0 / 60.0)).in(1.0_mm) == doctest::Approx(8.333).epsilon(1e-3));
    for (const double speed : {0.1, 0.3, 1.0}) {
        const Second period = Second::fromSi(1.0 / 60.0);
        const MovingEdge wide{std::max(10.0_mm, featherForSpeed(speed, period)), 2.0_mm, speed, 0.0};
        CHECK(movingSeam(ends(60), wide, MaskTiming::perSlot, Watching::still) < 0.03);
    }
}

TEST_CASE("seam motion: a plan's own slots are taken, each layer's light adding up to one") {
    const Compiled compiled = seamCompiled({});
    const EdgeLight light = edgeLight(compiled.plan, 1, 0);
    CHECK(light.period.si() == doctest::Approx(1.0 / 60.0));
    double sums[2] = {0.0, 0.0};
    for (const auto& pulse : light.pulses)
        sums[pulse.displaced ? 1 : 0] += pulse.weight;
    CHECK(sums[0] == doctest::Approx(1.0));
    CHECK(sums[1] == doctest::Approx(1.0));
    const MovingEdge slow{10.0_mm, 2.0_mm, 0.1, 0.0};
    CHECK(movingSeam(light, slow, MaskTiming::perSlot, Watching::still) <
          0.2 * movingSeam(light, slow, MaskTiming::perPeriod, Watching::still));
}
