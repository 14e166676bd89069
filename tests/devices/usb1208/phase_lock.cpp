#include "devices/usb1208/phase_lock.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <random>
#include <string>

#include "devices/usb/usb_link.h"
#include "devices/usb1208/edge_finder.h"
#include "devices/usb1208/sweep_player.h"
#include "tests/support/law.h"

namespace ilf::devices {
namespace {

/// A projector and a DAC with clocks of their own, and the samples that are on their way between player and DAC.
struct Bench {
    double ppm = 0.0, jitter = 0.0, start = 123.4;  ///< of the projector; jitter in samples, either way
    double missing = 0.0;                           ///< share of triggers that do not come
    int buffered = 3968;                            ///< samples made before they are played
    unsigned seed = 1;

    SweepPlayer player{LensChannels{}, 800};
    PhaseLock lock{PhaseLockSetup{}};
    std::minstd_rand random{1};
    double worst = 0.0;  ///< of the true phase while judged
    double played = 0.0, next = 0.0;
    bool refused = false;
    std::string why;

    void made(double until) {
        Bytes bytes(std::size_t{4} * 480);
        while (static_cast<double>(player.frames()) < until + buffered)
            player.fill(bytes);
    }
    /// `judged`: whether the phase must hold.
    void run(int sweeps, bool judged) {
        if (next == 0.0) {
            random.seed(seed);
            next = start;
        }
        for (int i = 0; i < sweeps && !refused; ++i) {
            made(next);
            const auto truth = player.placeOf(next);
            REQUIRE(truth);
            if (judged) worst = std::max(worst, std::abs(truth->offset));
            std::uniform_real_distribution<double> even(0.0, 1.0);
            const double seen = next + jitter * (2.0 * even(random) - 1.0);
            next += 800.0 * (1.0 + ppm * 1e-6);
            if (even(random) < missing) continue;
            const auto place = player.placeOf(seen);
            const auto advice = lock.edge(seen, place->offset, place->moved);
            if (!advice) {
                refused = true;
                why = advice.error().what;
                return;
            }
            if (advice->kind == PhaseAdvice::Kind::slip) {
                REQUIRE(std::abs(advice->samples) == 1);
                player.slip(advice->samples);
            }
            if (advice->kind == PhaseAdvice::Kind::align) REQUIRE(player.shift(advice->samples));
        }
    }
};

}  // namespace

TEST_CASE("phase lock: for clocks within 100 ppm and edges within a sample the sweep stays within two samples") {
    law("locked in after two seconds, then held", [] {
        Bench bench;
        bench.ppm = *rc::gen::inRange(-100, 101);
        bench.jitter = *rc::gen::inRange(0, 11) * 0.1;
        bench.start = *rc::gen::inRange(1000, 2600) + 0.37;
        bench.seed = *rc::gen::inRange(1U, 1000U);
        bench.run(120, false);
        RC_ASSERT(bench.lock.locked());
        bench.run(300, true);
        RC_ASSERT_FALSE(bench.refused);
        RC_ASSERT(bench.worst <= 2.0);
        const auto report = bench.lock.report();
        RC_ASSERT(report.locked);
        RC_ASSERT(std::abs(report.driftPpm - bench.ppm) < 60.0);
        // 2 samples and the jitter, of 20.8 us each.
        RC_ASSERT(report.most.si() <= 3.0 / 48000.0);
        RC_ASSERT(report.rms <= report.most);
    });
}

TEST_CASE("phase lock: triggers that are missing now and then are counted and do not unlock it") {
    law("one in ten missing", [] {
        Bench bench;
        bench.ppm = *rc::gen::inRange(-100, 101);
        bench.jitter = 0.5;
        bench.missing = 0.1;
        bench.seed = *rc::gen::inRange(1U, 1000U);
        bench.run(150, false);
        bench.run(250, true);
        RC_ASSERT(bench.lock.locked());
        RC_ASSERT(bench.lock.report().missing > 0);
        RC_ASSERT(bench.worst <= 2.0);
    });
}

TEST_CASE("phase lock: a locked sweep is not slipped to and fro") {
    Bench bench;
    bench.jitter = 0.5;
    bench.run(120, false);
    const auto before = bench.lock.report().slips;
    bench.run(1800, true);
    CHECK(bench.lock.report().slips - before <= 4);
    CHECK(bench.worst <= 1.5);
}

TEST_CASE("phase lock: slips are as many as the drift needs, at most one in four sweeps") {
    Bench bench;
    bench.ppm = 100.0;
    bench.run(120, false);
    const auto before = bench.lock.report().slips;
    bench.run(1000, true);
    // 0.08 samples a sweep.
    CHECK(std::abs(static_cast<double>(bench.lock.report().slips - before) - 80.0) <= 3.0);
}

TEST_CASE("phase lock: 59.94 against 60.00 Hz is refused with words, within half a second") {
    Bench bench;
    bench.ppm = 1001.0;
    bench.jitter = 1.0;
    bench.run(30, false);
    CHECK(bench.refused);
    CHECK(bench.why.find("shows 59.9") != std::string::npos);
    CHECK(bench.why.find("Set the projector's display to exactly 60.00 Hz (not 59.94).") != std::string::npos);
}

TEST_CASE("phase lock: a clock that wanders off while locked is refused, not chased") {
    Bench bench;
    bench.ppm = 50.0;
    bench.run(200, true);
    bench.ppm = 600.0;
    bench.run(600, false);
    CHECK(bench.refused);
}

TEST_CASE("phase lock: strays are left out, and a lost trigger is told") {
    PhaseLock lock(PhaseLockSetup{});
    double at = 1000.0;
    for (int i = 0; i < 60; ++i, at += 800.0) {
        REQUIRE(lock.edge(at, 0.1, 0));
        REQUIRE(lock.edge(at + 300.0, 300.1, 0)->kind == PhaseAdvice::Kind::none);
    }
    CHECK(lock.report().edges == 60);
    CHECK(lock.report().strays == 60);
    CHECK(lock.locked());
    CHECK(lock.heard(at + 3.0 * 800.0));
    const auto lost = lock.heard(at + 7.0 * 800.0);
    CHECK(lost.error().fault == Fault::device);
    CHECK(lost.error().what.find("The projector's trigger is lost: none came for 13") == 0);
    // The output has played for long when listening begins.
    PhaseLock late(PhaseLockSetup{});
    CHECK(late.heard(500.0 * 800.0));
    CHECK(late.heard(520.0 * 800.0));
    CHECK(late.heard(530.0 * 800.0).error().what.find("No trigger comes") == 0);
}

TEST_CASE("phase lock: a stray that came first does not keep it from locking") {
    PhaseLock lock(PhaseLockSetup{});
    REQUIRE(lock.edge(500.0, 300.0, 0));
    for (int i = 0; i < 60; ++i)
        REQUIRE(lock.edge(1000.0 + 800.0 * i, 0.2, 0));
    CHECK(lock.locked());
}

TEST_CASE("edge finder: edges slowed by a filter are found to a fraction of a sample, in blocks of any size") {
    law("a ramp of three samples from 0 to 3.3 V", [] {
        const double at = *rc::gen::inRange(20'000, 60'000) * 1e-3;
        const bool rising = *rc::gen::arbitrary<bool>();
        std::vector<double> volts;
        for (int i = 0; i < 100; ++i) {
            const double up = std::clamp(1.65 + (i - at) * 1.1, 0.0, 3.3);
            volts.push_back(rising ? up : 3.3 - up);
        }
        EdgeLevels levels;
        levels.low = Volt::fromSi(0.8);
        levels.high = Volt::fromSi(2.5);
        levels.rising = rising;
        EdgeFinder finder(levels);
        const auto block = *rc::gen::inRange<std::size_t>(1, 40);
        std::vector<double> edges;
        for (std::size_t from = 0; from < volts.size(); from += block) {
            const auto some = finder.found(std::span(volts).subspan(from, std::min(block, volts.size() - from)));
            edges.insert(edges.end(), some.begin(), some.end());
        }
        RC_ASSERT(edges.size() == 1U);
        RC_ASSERT(std::abs(edges[0] - at) < 1e-6);
    });
}

TEST_CASE("edge finder: noise between the levels makes no edges, and a step is found to half a sample") {
    std::vector<double> volts{0.1, 0.5, 1.0, 1.6, 1.0, 0.4, 1.9, 0.2, 3.3, 3.2, 1.7, 1.2, 3.3, 0.3};
    EdgeFinder finder;
    const auto edges = finder.found(volts);
    REQUIRE(edges.size() == 1);
    CHECK(edges[0] > 7.0);
    CHECK(edges[0] < 8.0);
    EdgeFinder started;
    CHECK(started.found(std::vector<double>{3.3, 3.3}).empty());
}

}  // namespace ilf::devices
