// Prediction: exact for constant motion, quiet for what stands still, bounded in any case.
#include "core/track/predict.h"

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include <cmath>
#include <random>

#include "tests/support/law.h"

namespace ilf {

namespace {

Quad squareAt(double x, double y) { return {{{x, y}, {x + 50, y}, {x + 50, y + 50}, {x, y + 50}}}; }

Second ms(double t) { return Second::fromSi(t / 1e3); }

}  // namespace

TEST_CASE("constant motion is predicted exactly, from three sightings on, at any frame times") {
    law("exact", [] {
        const double vx = *rc::gen::inRange(-3000, 3000) / 1e3, vy = *rc::gen::inRange(-3000, 3000) / 1e3;  // px/ms
        const int count = *rc::gen::inRange(3, 15);
        double t = 5e3;
        CornerTrack track;
        const auto at = [&](double when) { return squareAt(200 + vx * (when - 5e3), 300 + vy * (when - 5e3)); };
        for (int i = 0; i < count; ++i) {
            t += *rc::gen::inRange(8, 40);
            track = tracked(track, ms(t), at(t));
        }
        const double ahead = *rc::gen::inRange(0, 101);
        // Rounding: 1e-16 of some thousand pixels and of 6 s at 4 px/ms, magnified by 100 ms over 2 frames of 8 ms.
        RC_ASSERT(farthestCorner(predicted(track, ms(t + ahead)), at(t + ahead)) < 1e-8);
    });
}

TEST_CASE("what stands still scatters no more when predicted 60 ms ahead than when seen") {
    std::mt19937 random(7);
    std::normal_distribution<double> noise(0.0, 0.3);
    CornerTrack track;
    double seenSquares = 0.0, saidSquares = 0.0;
    for (int i = 0; i < 3000; ++i) {
        // Noise of each corner, and of the whole: both occur.
        const double x = noise(random), y = noise(random);
        Quad q = squareAt(200 + x, 300 + y);
        for (auto& p : q)
            p.x += 0.3 * noise(random);
        track = tracked(track, ms(33.3 * (i + 1)), q);
        const Quad said = predicted(track, ms(33.3 * (i + 1) + 60));
        seenSquares += std::pow(q[0].x - 200, 2) + std::pow(q[0].y - 300, 2);
        saidSquares += std::pow(said[0].x - 200, 2) + std::pow(said[0].y - 300, 2);
    }
    MESSAGE("rms seen ", std::sqrt(seenSquares / 3000), " px, predicted ", std::sqrt(saidSquares / 3000), " px");
    // A mean of eight has an eighth of the squares; where chance passes for a motion (once in a thousand) or cuts off
    // old sightings there are fewer to average: three at least.
    CHECK(saidSquares < 0.2 * seenSquares);
}

TEST_CASE("in steady motion with noise, prediction beats what was last seen by far") {
    std::mt19937 random(3);
    std::normal_distribution<double> noise(0.0, 0.1);
    CornerTrack track;
    double still = 0.0, said = 0.0;
    for (int i = 0; i < 300; ++i) {
        const double t = 33.3 * i, x = 0.4 * t;  // 0.4 m/s at a pixel a millimetre
        const Quad q = squareAt(x + noise(random), noise(random));
        track = tracked(track, ms(t), q);
        if (i < 3) continue;
        const Quad truth = squareAt(x + 0.4 * 63, 0);
        still = std::max(still, farthestCorner(q, truth));
        said = std::max(said, farthestCorner(predicted(track, ms(t + 63)), truth));
    }
    MESSAGE("worst lag at 0.4 px/ms and 63 ms: ", still, " px seen, ", said, " px predicted");
    // Still, it is 0.4 x 63 = 25 px off. A line through n sightings T apart is known D after their middle to
    // noise x sqrt(1 / n + D^2 / sum t^2): of four, the fewest here, D = 113 ms and 0.16 px; of eight 0.09. The worst
    // of 300 is within 4.5 deviations.
    CHECK(still > 25.0);
    CHECK(said < 4.5 * 0.16);
}

TEST_CASE("a stop is noticed: the overshoot is gone after three sightings") {
    CornerTrack track;
    for (int i = 0; i < 8; ++i)
        track = tracked(track, ms(33.3 * i), squareAt(10.0 * i, 0));
    const Quad end = squareAt(70, 0);
    for (int i = 8; i < 12; ++i)
        track = tracked(track, ms(33.3 * i), end);
    // Exactly: what was seen on the way is no part of the line any more.
    CHECK(farthestCorner(predicted(track, ms(33.3 * 11 + 60)), end) < 1e-9);
}

TEST_CASE("nothing is predicted farther ahead than the limit") {
    CornerTrack track;
    for (int i = 0; i < 5; ++i)
        track = tracked(track, ms(20.0 * i), squareAt(4.0 * i, 0));
    const Quad far = predicted(track, 60.0_s);
    CHECK(farthestCorner(far, squareAt(16 + 0.2 * 100, 0)) < 1e-8);  // rounding, as above
}

TEST_CASE("times that do not grow begin anew, and a gap forgets") {
    CornerTrack track;
    for (int i = 0; i < 5; ++i)
        track = tracked(track, ms(20.0 * i), squareAt(4.0 * i, 0));
    CHECK(tracked(track, ms(80), squareAt(0, 0)).seen.size() == 1);
    CHECK(tracked(track, ms(1000), squareAt(0, 0)).seen.size() == 1);
}

TEST_CASE("the mean light of a sweep weighs its lit slots") {
    Plan plan;
    for (int i = 0; i < 4; ++i) {
        Slot slot;
        slot.index = i;
        slot.start = ms(4.0 * i);
        slot.duration = ms(4.0);
        if (i == 3) slot.lit = {{0, 1.0}};
        plan.slots.push_back(slot);
    }
    CHECK(meanLight(plan).si() == doctest::Approx(0.014));
    CHECK(photonTimes(plan, 1.0_s)[3].si() == doctest::Approx(1.014));
    plan.slots[0].lit = {{0, 1.0}};
    CHECK(meanLight(plan).si() == doctest::Approx(0.008));
}

}  // namespace ilf
