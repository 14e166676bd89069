#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <limits>
#include <numbers>

#include "core/lens/shaped_wave.h"
#include "tests/core/lens/second_order_lens.h"
#include "tests/support/law.h"

using namespace ilf;

namespace {

constexpr std::array kTwo{0.0, 2.2};

std::vector<Hold> twoHolds(double duty) { return holdsFor(kTwo, duty, 0.1); }

double peakOfSamples(const Harmonics& f) {
    double peak = 0.0;
    for (const double value : samplesOf(f, 2000))
        peak = std::max(peak, std::abs(value));
    return peak;
}

/// Any lens like the presets, without bend.
SecondOrderLens anyLens() {
    SecondOrderLens lens;
    lens.rest_D = *rc::gen::inRange(-100, 100) * 0.01;
    lens.static_D = *rc::gen::inRange(100, 200);
    lens.resonance_Hz = *rc::gen::inRange(40, 90);
    lens.damping = *rc::gen::inRange(15, 70) * 0.01;
    return lens;
}

}  // namespace

TEST_CASE("shaped: two levels are held half a sweep apart") {
    const auto holds = twoHolds(0.3);
    REQUIRE(holds.size() == 2);
    CHECK(holds[0].centre == doctest::Approx(0.1));
    CHECK(holds[0].power_D == 0.0);
    CHECK(holds[1].centre == doctest::Approx(0.6));
    CHECK(holds[1].power_D == 2.2);
    CHECK(holds[1].length == doctest::Approx(0.3));
}

TEST_CASE("shaped: every level is held once and equally long, in any number of them") {
    law("1 to 6 levels, any duty that fits", [] {
        const int count = *rc::gen::inRange(1, 7);
        std::vector<double> levels{0.0};
        for (int i = 1; i < count; ++i)
            levels.push_back(levels.back() + 0.1 * *rc::gen::inRange(1, 20));
        const double duty = 0.01 * *rc::gen::inRange(1, 95 / count), lowAt = 0.01 * *rc::gen::inRange(-200, 200);
        const auto holds = holdsFor(levels, duty, lowAt);
        RC_ASSERT(holds.size() == levels.size());
        RC_ASSERT(checkedHolds(holds).has_value());
        for (const double level : levels)
            RC_ASSERT(std::ranges::count(holds, level, &Hold::power_D) == 1);
        for (const Hold& hold : holds) {
            RC_ASSERT(hold.length == duty);
            RC_ASSERT(hold.centre >= 0.0 && hold.centre < 1.0);
            const double away = hold.centre - lowAt;
            if (hold.power_D == 0.0) RC_ASSERT(std::abs(away - std::round(away)) < 1e-9);
        }
    });
}

TEST_CASE("shaped: four levels are climbed by one and descended by the other") {
    const std::array levels{0.0, 1.0, 2.0, 3.0};
    const auto holds = holdsFor(levels, 0.1, 0.05);
    REQUIRE(holds.size() == 4);
    const std::array<double, 4> order{0.0, 1.0, 3.0, 2.0};
    for (std::size_t i = 0; i < 4; ++i)
        CHECK(holds[i].power_D == order[i]);
    // Steps of 1, 2, 1 and 2 D share 60 % of the sweep as the roots of their heights.
    const double one = 0.6 / (2.0 + 2.0 * std::numbers::sqrt2);
    CHECK(holds[1].centre - holds[0].centre == doctest::Approx(0.1 + one));
    CHECK(holds[2].centre - holds[1].centre == doctest::Approx(0.1 + one * std::numbers::sqrt2));
}

TEST_CASE("shaped: holds that cannot be are refused with their reason") {
    CHECK(checkedHolds({}).error().what == "A shaped wave needs at least one level to hold.");
    CHECK(checkedHolds(twoHolds(0.6)).error().what ==
          "Holds of 120 % of the sweep together leave no time to move between them; shorten them.");
    const std::array overlapping{Hold{0.9, 0.3, 0.0}, Hold{0.1, 0.3, 2.0}};
    CHECK(checkedHolds(overlapping).error().what ==
          "Two holds overlap at 95 % of the sweep; the lens has one power at a time.");
    const std::array never{Hold{0.5, 0.0, 1.0}};
    CHECK(checkedHolds(never).error().what == "A hold needs a finite power and time, and a length above 0.");
    const std::array nan{Hold{0.5, 0.1, std::numeric_limits<double>::quiet_NaN()}};
    CHECK(!checkedHolds(nan));
    CHECK(!checkedHolds(std::array{Hold{0.5, std::numeric_limits<double>::quiet_NaN(), 1.0}}));
    // Next to each other is not over each other.
    CHECK(checkedHolds(std::array{Hold{0.25, 0.25, 0.0}, Hold{0.5, 0.25, 1.0}}));
}

TEST_CASE("shaped: a lens without bend is identified to within the noise of its records") {
    law("gains of 5 harmonics, rest and static gain", [] {
        SecondOrderLens lens = anyLens();
        lens.noise_D = 0.007;
        const Hertz rate = Hertz::fromSi(*rc::gen::inRange(50, 91));
        const auto found = identified(lens.recorder(), rate, 1.1, 2.2, 5, usualLimits());
        RC_ASSERT(found.has_value());
        RC_ASSERT(found->rate == rate);
        // Mean and each harmonic of a record are known to 0.007 D sqrt(2 / 250) = 0.6 mD; the weakest drive is 2 mV.
        const double off = 5.0 * 0.0007 / 0.002;
        RC_ASSERT(std::abs(found->gain[0].real() - lens.static_D) < off);
        for (int k = 1; k <= 5; ++k)
            RC_ASSERT(std::abs(found->gain[static_cast<std::size_t>(k)] - lens.gain(k, rate)) < off);
        RC_ASSERT(std::abs(found->bias_D - lens.rest_D) < 0.02);
    });
}

TEST_CASE("shaped: a sine holds two levels as well as a sine can") {
    // a cos(t) within +-e of half the swing for |t| <= pi duty: e = swing/2 tan^2(pi duty / 2).
    const SecondOrderLens lens;
    const double tangent = std::tan(0.5 * std::numbers::pi * 0.096);
    const auto sine = designed(lens.response(60.0_Hz, 1), twoHolds(0.096), 1, usualLimits());
    REQUIRE(sine);
    CHECK(sine->largestError_D == doctest::Approx(1.1 * tangent * tangent).epsilon(1e-3));
}

TEST_CASE("shaped: five harmonics hold 2.2 D for 30 % within 0.02 D where a sine is 0.28 D off") {
    const SecondOrderLens lens;
    const auto sine = designed(lens.response(60.0_Hz, 5), twoHolds(0.3), 1, usualLimits());
    const auto five = designed(lens.response(60.0_Hz, 5), twoHolds(0.3), 5, usualLimits());
    REQUIRE(sine);
    REQUIRE(five);
    CHECK(sine->largestError_D == doctest::Approx(0.2856).epsilon(1e-3));
    CHECK(five->largestError_D < 0.02);
}

TEST_CASE("shaped: a design keeps to its limits and does what it predicts") {
    law("any lens, any limits", [] {
        const SecondOrderLens lens = anyLens();
        DriveLimits limits = usualLimits();
        limits.peak *= 0.01 * *rc::gen::inRange(30, 100);
        limits.rms = limits.peak * 0.01 * *rc::gen::inRange(20, 100);
        const auto holds = twoHolds(0.01 * *rc::gen::inRange(5, 42));
        const int harmonics = *rc::gen::inRange(1, 7);
        const auto design = designed(lens.response(60.0_Hz, harmonics), holds, harmonics, limits);
        if (!design) return;  // refused: the limits keep the levels out of reach
        RC_ASSERT(design->drive.c.size() == static_cast<std::size_t>(harmonics) + 1);
        RC_ASSERT(peakOfSamples(design->drive) <= limits.peak);
        RC_ASSERT(design->drive.rms() <= limits.rms);
        for (int i = 0; i < 100; ++i) {
            const double x = i / 100.0;
            RC_ASSERT(std::abs(design->power.at(x) - lens.power(design->drive, 60.0_Hz, x)) < 1e-9);
        }
        RC_ASSERT(std::abs(largestErrorIn(holds, design->power) - design->largestError_D) < 1e-12);
    });
}

TEST_CASE("shaped: more drive, more harmonics or shorter holds never make a design worse") {
    law("any lens", [] {
        // 2 mD is what the design gives away for a cooler coil.
        constexpr double kGivenAway = 2.1e-3;
        const SecondOrderLens lens = anyLens();
        DriveLimits limits = usualLimits();
        limits.peak *= 0.5;
        limits.rms *= 0.5;
        const LensResponse response = lens.response(60.0_Hz, 5);
        const auto base = designed(response, twoHolds(0.3), 4, limits);
        RC_PRE(base.has_value());
        const auto stronger = designed(response, twoHolds(0.3), 4, usualLimits());
        const auto richer = designed(response, twoHolds(0.3), 5, limits);
        const auto shorter = designed(response, twoHolds(0.27), 4, limits);
        for (const auto& other : {stronger, richer, shorter}) {
            RC_ASSERT(other.has_value());
            RC_ASSERT(other->largestError_D <= base->largestError_D + kGivenAway);
        }
    });
}

TEST_CASE("shaped: levels that the drive cannot reach are refused, with what would help") {
    const SecondOrderLens lens;
    DriveLimits weak = usualLimits();
    weak.peak = 0.004;
    const auto refused = designed(lens.response(60.0_Hz, 5), twoHolds(0.3), 5, weak);
    REQUIRE(!refused);
    CHECK(refused.error().what.starts_with("The lens cannot hold 0 to 2.2 D at 60 Hz within its drive limits (0.004 V "
                                           "peak): it would be "));
    CHECK(refused.error().what.ends_with("a slower sweep, shorter holds or a smaller range would help."));
    DriveLimits none;
    CHECK(designed(lens.response(60.0_Hz, 5), twoHolds(0.3), 5, none).error().what ==
          "The lens has no drive limits above 0; nothing can be played on it.");
}

TEST_CASE("shaped: the lens stays within its own limits of power between the holds too") {
    const SecondOrderLens lens;
    DriveLimits tight = usualLimits();
    tight.lensMin = Dioptre::fromSi(-0.1);
    tight.lensMax = Dioptre::fromSi(2.3);
    const auto design = designed(lens.response(60.0_Hz, 5), twoHolds(0.2), 5, tight);
    REQUIRE(design);
    const Extremes ends = extremes(design->power);
    CHECK(ends.low > -0.101);
    CHECK(ends.high < 2.301);
    tight.lensMin = Dioptre::fromSi(1.0);
    CHECK(designed(lens.response(60.0_Hz, 5), twoHolds(0.2), 5, tight).error().what ==
          "Undriven, the lens lies at 0.5 D, outside its own limits; check the lens or its limits.");
}

TEST_CASE("shaped: what a bent lens does wrong is learnt, and the best record is kept") {
    law("bends of up to 5 % a dioptre, with noise", [] {
        SecondOrderLens lens = anyLens();
        lens.bend = 0.01 * *rc::gen::inRange(-5, 6);
        lens.noise_D = 0.007;
        const auto holds = twoHolds(0.3);
        const auto wave = learnt(lens.recorder(), 60.0_Hz, holds, 5, usualLimits());
        RC_ASSERT(wave.has_value());
        RC_ASSERT(!wave->errors_D.empty() && wave->errors_D.size() <= 5);
        RC_ASSERT(wave->largestError_D == *std::ranges::min_element(wave->errors_D));
        for (std::size_t i = 1; i + 1 < wave->errors_D.size(); ++i)
            RC_ASSERT(wave->errors_D[i] < wave->errors_D[i - 1]);
        RC_ASSERT(wave->largestError_D == largestErrorIn(holds, wave->power));
        RC_ASSERT(wave->holds == holds);
        RC_ASSERT(wave->temperature_C == 31.0);
        // On the lens itself, noise apart.
        double truly = 0.0;
        for (const Hold& hold : holds)
            for (int i = -50; i <= 50; ++i) {
                const double x = hold.centre + 0.01 * i * 0.5 * hold.length;
                truly = std::max(truly, std::abs(lens.power(wave->drive, 60.0_Hz, x) - hold.power_D));
            }
        // The bend takes up to a quarter of the slope, so it asks for as much more drive.
        DriveLimits less = usualLimits();
        less.peak *= 0.75;
        less.rms *= 0.75;
        const auto possible = designed(lens.response(60.0_Hz, 5), holds, 5, less);
        RC_ASSERT(truly < possible->largestError_D + 0.03);
    });
}

TEST_CASE("shaped: a camera's four levels are learnt like two") {
    SecondOrderLens lens;
    lens.bend = 0.02;
    lens.noise_D = 0.007;
    const std::array levels{0.0, 0.77, 2.0, 4.0};
    const auto wave = learnt(lens.recorder(), 60.0_Hz, holdsFor(levels, 0.12, 0.0), 8, usualLimits());
    REQUIRE(wave);
    CHECK(wave->largestError_D < 0.06);
    const auto five = learnt(lens.recorder(), 60.0_Hz, holdsFor(levels, 0.12, 0.0), 5, usualLimits());
    REQUIRE(five);
    CHECK(five->largestError_D < 0.1);
}

TEST_CASE("shaped: one level is held by standing still") {
    SecondOrderLens lens;
    lens.noise_D = 0.007;
    const std::array one{1.5};
    const auto wave = learnt(lens.recorder(), 60.0_Hz, holdsFor(one, 0.5, 0.0), 3, usualLimits());
    REQUIRE(wave);
    CHECK(wave->largestError_D < 0.01);
}

TEST_CASE("shaped: learning stops at the first record that is worse, and keeps the one before") {
    // A lens that drifts away by 20 mD with every record after the fourth.
    SecondOrderLens lens;
    int plays = 0;
    const RecordLens drifting = [&](const Harmonics& drive, Hertz rate) -> Result<LensRecord> {
        SecondOrderLens now = lens;
        if (++plays > 4) now.rest_D += 0.05 * (plays - 4) * (plays - 4);
        return now.recorded(drive, rate, 1);
    };
    const auto wave = learnt(drifting, 60.0_Hz, twoHolds(0.3), 5, usualLimits(), 10);
    REQUIRE(wave);
    REQUIRE(wave->errors_D.size() == 2);
    CHECK(wave->errors_D[1] > wave->errors_D[0]);
    CHECK(wave->largestError_D == wave->errors_D[0]);
    CHECK(plays == 5);
}

TEST_CASE("shaped: no drive beyond the limits is ever played") {
    law("any lens, weak limits", [] {
        const SecondOrderLens lens = anyLens();
        DriveLimits limits = usualLimits();
        limits.peak *= 0.01 * *rc::gen::inRange(10, 100);
        limits.rms = limits.peak * 0.01 * *rc::gen::inRange(20, 90);
        bool beyond = false;
        const RecordLens watching = [&](const Harmonics& drive, Hertz rate) -> Result<LensRecord> {
            beyond =
                beyond || peakOfSamples(drive) > limits.peak * (1.0 + 1e-9) || drive.rms() > limits.rms * (1.0 + 1e-9);
            return lens.recorded(drive, rate, 1);
        };
        (void)learnt(watching, 60.0_Hz, twoHolds(0.3), 5, limits);
        RC_ASSERT(!beyond);
    });
}

TEST_CASE("shaped: a record that cannot be used stops learning with its reason") {
    const SecondOrderLens lens;
    const auto learntFrom = [&](const RecordLens& record) {
        const auto wave = learnt(record, 60.0_Hz, twoHolds(0.3), 5, usualLimits());
        return wave ? std::string("learnt") : wave.error().what;
    };
    CHECK(learntFrom([&](const Harmonics& drive, Hertz rate) -> Result<LensRecord> {
              LensRecord record = lens.recorded(drive, rate, 1);
              record.power_D[17] = std::numeric_limits<double>::quiet_NaN();
              return record;
          }) == "A record of the lens holds samples that are no numbers; check the photodiode and record again.");
    CHECK(learntFrom([&](const Harmonics& drive, Hertz rate) -> Result<LensRecord> {
              LensRecord record = lens.recorded(drive, rate, 1);
              record.power_D.resize(20);
              return record;
          }) == "A record of the lens has 20 samples; 5 harmonics need at least 24.");
    CHECK(learntFrom([&](const Harmonics&, Hertz) -> Result<LensRecord> {
              return fail(Fault::device, "the lens is unplugged");
          }) == "the lens is unplugged");
    CHECK(learntFrom([&](const Harmonics&, Hertz rate) -> Result<LensRecord> { return lens.recorded({}, rate, 1); }) ==
          "The lens did not move when it was driven; check its cable and amplifier.");
    // Whichever record fails, the fault is said.
    for (int failing = 1;; ++failing) {
        int plays = 0;
        const std::string said = learntFrom([&](const Harmonics& drive, Hertz rate) -> Result<LensRecord> {
            if (++plays == failing) return fail(Fault::device, "the lens is unplugged");
            return lens.recorded(drive, rate, 1);
        });
        if (plays < failing) break;
        CHECK(said == "the lens is unplugged");
    }
}
