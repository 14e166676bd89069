#include "devices/simulated/lens_emulator.h"

#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "tests/support/law.h"

namespace ilf::devices {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// Between two voltages.
Harmonics sine(double low, double high) { return {{0.5 * (low + high), {0.0, -0.5 * (high - low)}}}; }

LensRecord quiet(const LensParameters& p, const Harmonics& drive, Hertz rate, double ambient_C = 30.0) {
    LensEmulator lens(p, ambient_C);
    auto record = recorded(lens, drive, rate, {.samples = 400, .periods = 6, .noise_D = 0.0});
    REQUIRE(record);
    return *std::move(record);
}

/// Of the first harmonic, against what the static table's slope makes of the drive.
std::complex<double> gain(const LensParameters& p, Hertz rate, double swing_V = 1e-3) {
    const auto record = quiet(p, sine(-swing_V, swing_V), rate);
    const double slope_D_per_V = p.amplifier_A_per_V * 68.8;
    return harmonicsOf(record.power_D, 8).c[1] / (std::complex(0.0, -swing_V) * slope_D_per_V);
}

double degrees(std::complex<double> z) { return std::arg(z) * 180.0 / std::numbers::pi; }

/// The two modes alone, in closed form.
std::complex<double> ofModes(const LensParameters& p, Hertz rate) {
    const auto one = [&](double mode_Hz, double damping) {
        const double r = rate.si() / mode_Hz;
        return 1.0 / std::complex(1.0 - r * r, 2.0 * damping * r);
    };
    return (1.0 - p.mode2Share) * one(p.mode_Hz, p.damping) +
           p.mode2Share * one(p.mode_Hz * p.mode2Ratio, p.mode2Damping);
}

double distortion(const LensRecord& record) {
    const auto h = harmonicsOf(record.power_D, 40);
    double sum = 0.0;
    for (std::size_t k = 2; k < h.c.size(); ++k)
        sum += std::norm(h.c[k]);
    return std::sqrt(sum / std::norm(h.c[1]));
}

/// The lens without what is not linear: what is left is known in closed form.
LensParameters linear(LensPreset preset) {
    auto p = lensParameters(preset);
    p.stiffnessLinear = p.stiffnessSquare = p.loop_D = p.dacStep_V = 0.0;
    p.dacRate_Hz = 48000.0;
    return p;
}

/// What the lens comes to when it is driven with a constant voltage.
double settledPower(const LensParameters& p, double volt, double ambient_C = 30.0) {
    LensEmulator lens(p, ambient_C);
    lens.play({{volt}}, 60.0_Hz);
    lens.advance(0.9_s);
    return lens.power().si();
}

}  // namespace

TEST_CASE("lens emulator: gain and phase at 60 and 120 Hz are the readings of the data sheet") {
    struct Reading {
        LensPreset preset;
        double gain60, phase60, gain120;
    };
    for (const auto& reading :
         {Reading{LensPreset::slow, 0.85, -106.0, 0.20}, Reading{LensPreset::datasheet, 1.74, -78.0, 0.36},
          Reading{LensPreset::lively, 2.2, -82.0, 0.35}}) {
        CAPTURE(word(reading.preset));
        auto p = linear(reading.preset);
        p.mode2Share = 0.0;  // the readings are of the first mode
        const auto at60 = gain(p, 60.0_Hz);
        CHECK(std::abs(at60) == doctest::Approx(reading.gain60).epsilon(0.015));
        CHECK(degrees(at60) == doctest::Approx(reading.phase60 - 1.7).epsilon(0.01));  // the amplifier's pole
        CHECK(std::abs(gain(p, 120.0_Hz)) == doctest::Approx(reading.gain120).epsilon(0.03));
    }
}

TEST_CASE("lens emulator: both modes, amplifier and hold act as their closed forms say") {
    for (const auto preset : kLensPresets) {
        CAPTURE(word(preset));
        const auto p = linear(preset);
        for (const Hertz rate : {30.0_Hz, 60.0_Hz, 120.0_Hz, 240.0_Hz}) {
            const double omega = 2.0 * std::numbers::pi * rate.si();
            // The held value lags by half a hold on average.
            const auto chain = ofModes(p, rate) / std::complex(1.0, omega * p.amplifierPole_s) *
                               std::polar(1.0, -omega * 0.5 / p.dacRate_Hz);
            CHECK(std::abs(gain(p, rate) / chain - 1.0) < 0.002);
        }
    }
}

TEST_CASE("lens emulator: waves are bent as much as each preset says") {
    struct Bent {
        LensPreset preset;
        double least, most;
    };
    for (const auto& bent : {Bent{LensPreset::clean, 0.0004, 0.007}, Bent{LensPreset::datasheet, 0.002, 0.010},
                             Bent{LensPreset::slow, 0.002, 0.012}, Bent{LensPreset::lively, 0.002, 0.012},
                             Bent{LensPreset::dirty, 0.027, 0.10}}) {
        CAPTURE(word(bent.preset));
        for (const auto& drive : {sine(0.0, 14e-3), sine(0.0, 30e-3), sine(-70e-3, 70e-3)}) {
            const double d = distortion(quiet(lensParameters(bent.preset), drive, 60.0_Hz));
            CHECK(d > bent.least);
            CHECK(d < bent.most);
        }
    }
}

TEST_CASE("lens emulator: at rest it is what the table says, cold and warm") {
    const auto p = linear(LensPreset::datasheet);
    CHECK(LensEmulator(p).power().si() == doctest::Approx(0.51));
    const double mA = 1e-3 / p.amplifier_A_per_V;  // volts that make one milliampere
    const double slope = (settledPower(p, mA) - settledPower(p, -mA)) / 2.0;
    CHECK(slope == doctest::Approx(0.070).epsilon(0.03));
    CHECK((settledPower(p, 81.0 * mA) - settledPower(p, 79.0 * mA)) / 2.0 == doctest::Approx(0.055).epsilon(0.05));
    CHECK((settledPower(p, 126.0 * mA) - settledPower(p, 124.0 * mA)) / 2.0 == doctest::Approx(0.049).epsilon(0.1));
    const auto perC = [&](double volt) { return (settledPower(p, volt, 40.0) - settledPower(p, volt, 30.0)) / 10.0; };
    CHECK(perC(0.0) == doctest::Approx(0.033).epsilon(0.05));
    CHECK(perC(-50.0 * mA) == doctest::Approx(0.041).epsilon(0.05));
    CHECK(perC(-150.0 * mA) == doctest::Approx(0.047).epsilon(0.1));
    CHECK(perC(50.0 * mA) == doctest::Approx(0.027).epsilon(0.1));
}

TEST_CASE("lens emulator: the DAC holds steps, the amplifier clips") {
    auto p = linear(LensPreset::datasheet);
    p.dacStep_V = 1e-3;
    CHECK(settledPower(p, 0.4e-3) == settledPower(p, 0.0));
    CHECK(settledPower(p, 0.6e-3) == settledPower(p, 1e-3));
    p = linear(LensPreset::datasheet);
    LensEmulator lens(p);
    lens.play({{1.0}}, 60.0_Hz);
    lens.advance(0.5_s);
    CHECK(lens.current_A() == doctest::Approx(p.clip_A));
    CHECK(lens.limits().peak == doctest::Approx(p.clip_A / p.amplifier_A_per_V));

    p.dacRate_Hz = 1000.0;  // between two values of the DAC the current only settles
    LensEmulator coarse(p);
    coarse.play(sine(-0.05, 0.05), 60.0_Hz);
    coarse.advance(1.9_ms);
    const double held = coarse.current_A();
    coarse.advance(0.09_ms);
    CHECK(std::abs(coarse.current_A() - held) < 1e-6);
    coarse.advance(0.2_ms);
    CHECK(std::abs(coarse.current_A() - held) > 1e-2);
}

TEST_CASE("lens emulator: a step four times finer changes nothing that matters") {
    for (const auto preset : kLensPresets) {
        CAPTURE(word(preset));
        const auto usual = lensParameters(preset);
        auto fine = usual;
        fine.step_s = usual.step_s / 4.0;
        LensEmulator a(usual), b(fine);
        a.play(sine(-30e-3, 30e-3), 60.0_Hz);
        b.play(sine(-30e-3, 30e-3), 60.0_Hz);
        double worst = 0.0;
        for (int i = 0; i < 1000; ++i) {
            a.advance(0.4_ms);
            b.advance(0.4_ms);
            worst = std::max(worst, std::abs((a.power() - b.power()).si()));
        }
        CHECK(worst < 3e-4);
    }
}

TEST_CASE("lens emulator: how time is cut into calls does not matter") {
    law("advance(a + b) is advance(a), advance(b)", [] {
        const auto preset = kLensPresets[*rc::gen::inRange(0, 5)];
        LensEmulator once(lensParameters(preset)), often = once;
        once.play(sine(-20e-3, 30e-3), 60.0_Hz);
        often.play(sine(-20e-3, 30e-3), 60.0_Hz);
        const int pieces = *rc::gen::inRange(1, 400);
        for (int i = 0; i < pieces; ++i)
            often.advance(Second::fromSi(0.1 / pieces));
        once.advance(0.1_s);
        RC_ASSERT(abs(once.power() - often.power()) < 1e-3_D);
    });
}

TEST_CASE("lens emulator: hold reaches its power on every preset, warm or cold") {
    for (const auto preset : kLensPresets) {
        for (const std::uint64_t seed : {0, 1, 2, 3}) {
            CAPTURE(word(preset));
            LensEmulator lens(lensParameters(preset, seed));
            lens.play(sine(-30e-3, 25e-3), 60.0_Hz);
            lens.advance(0.31_s);
            for (const double power : {0.0, 2.0, -1.5, 6.0}) {
                lens.setAmbient(power > 1.0 ? 38.0 : 22.0);
                lens.hold(Dioptre::fromSi(power));
                lens.advance(0.2_s);
                CHECK(lens.power().si() == doctest::Approx(power).epsilon(0.01).scale(1.0));
                lens.advance(Second::fromSi(600.0));  // warmer or colder by now; its driver knows
                CHECK(lens.power().si() == doctest::Approx(power).epsilon(0.01).scale(1.0));
            }
        }
    }
}

TEST_CASE("lens emulator: it warms as its coil is driven, at once or in minutes") {
    LensEmulator slowly, atOnce;
    for (auto* lens : {&slowly, &atOnce})
        lens->play(sine(-70e-3, 70e-3), 60.0_Hz);
    atOnce.warmUp();
    slowly.advance(Second::fromSi(180.0));
    // 0.168 A peak: 14 mA^2 mean, 12.5 ohm, 25 C/W
    CHECK(atOnce.temperature_C() == doctest::Approx(34.41).epsilon(0.001));
    CHECK(slowly.temperature_C() == doctest::Approx(30.0 + 4.41 * (1.0 - std::exp(-1.0))).epsilon(0.001));
    slowly.advance(Second::fromSi(3600.0));
    atOnce.advance(0.5_s);
    CHECK(slowly.temperature_C() == doctest::Approx(atOnce.temperature_C()).epsilon(1e-4));
}

TEST_CASE("lens emulator: records are the same for the same seed, and average their noise") {
    LensEmulator a, b, c;
    const auto drive = sine(0.0, 14e-3);
    const auto first = recorded(a, drive, 60.0_Hz), again = recorded(b, drive, 60.0_Hz);
    const auto other = recorded(c, drive, 60.0_Hz, {.seed = 2});
    REQUIRE((first && again && other));
    CHECK(*first == *again);
    CHECK(*first != *other);
    CHECK(first->power_D.size() == 250);
    CHECK(first->noise_D == doctest::Approx(0.02 / std::sqrt(8.0)));
    CHECK(first->provenance == Provenance::simulated);
    double sum = 0.0;
    for (std::size_t i = 0; i < 250; ++i)
        sum += std::pow(first->power_D[i] - other->power_D[i], 2);
    CHECK(std::sqrt(sum / 250.0) == doctest::Approx(first->noise_D * std::numbers::sqrt2).epsilon(0.15));

    const auto record = recorder(a);
    const auto one = record(drive, 60.0_Hz), two = record(drive, 60.0_Hz);
    REQUIRE((one && two));
    CHECK(one->power_D != two->power_D);
}

TEST_CASE("lens emulator: drives beyond its limits are refused in a sentence") {
    LensEmulator lens;
    const auto refusal = [&](const Harmonics& drive, Hertz rate) {
        const auto record = recorded(lens, drive, rate);
        return record ? std::string() : record.error().what;
    };
    const double peak = lens.limits().peak;
    CHECK(refusal(sine(-peak, peak), 60.0_Hz).empty());
    CHECK(refusal(sine(-peak, 1.01 * peak), 60.0_Hz).find("122.0 mV") != std::string::npos);
    CHECK(refusal({{0.9 * peak}}, 60.0_Hz).find("warm") != std::string::npos);
    CHECK(refusal({{kNaN}}, 60.0_Hz).find("not a number") != std::string::npos);
    CHECK(refusal(sine(0.0, 0.01), 0.0_Hz).find("Hz") != std::string::npos);
    CHECK(refusal(sine(0.0, 0.01), Hertz::fromSi(kNaN)).find("Hz") != std::string::npos);
}

TEST_CASE("lens emulator: seeds vary every preset by up to 20 percent, the same way each time") {
    for (const auto preset : kLensPresets) {
        const auto nominal = lensParameters(preset);
        for (std::uint64_t seed = 1; seed <= 20; ++seed) {
            CAPTURE(word(preset));
            CAPTURE(seed);
            const auto p = lensParameters(preset, seed);
            CHECK(p == lensParameters(preset, seed));
            CHECK(p.mode_Hz != nominal.mode_Hz);
            CHECK(std::abs(p.mode_Hz / nominal.mode_Hz - 1.0) <= 0.2);
            CHECK(std::abs(p.damping / nominal.damping - 1.0) <= 0.2);
            CHECK(p.mode_Hz / nominal.mode_Hz != p.damping / nominal.damping);
            CHECK(p.dacRate_Hz == nominal.dacRate_Hz);
            const auto e = extremes(harmonicsOf(quiet(p, sine(0.0, 20e-3), 60.0_Hz).power_D, 16));
            CHECK(e.low > -5.0);
            CHECK(e.high < 12.0);
            CHECK(e.high - e.low > 1.0);
        }
    }
}

TEST_CASE("lens emulator: it stays finite whatever it is given") {
    law("power and temperature are finite", [] {
        const auto any = [] {
            return *rc::gen::element(0.0, -1.0, 1.0, 1e-3, 60.0, -1e9, 1e9, 1e300, -1e300, 5e-324, kInfinity,
                                     -kInfinity, kNaN);
        };
        LensParameters p = lensParameters(kLensPresets[*rc::gen::inRange(0, 5)]);
        for (double* value :
             {&p.dacRate_Hz, &p.dacStep_V, &p.amplifier_A_per_V, &p.amplifierPole_s, &p.clip_A, &p.mode_Hz, &p.damping,
              &p.stiffnessLinear, &p.stiffnessSquare, &p.mode2Ratio, &p.mode2Damping, &p.mode2Share, &p.loop_D,
              &p.slip_D, &p.coil_ohm, &p.warming_C_per_W, &p.warming_s, &p.step_s}) {
            if (*rc::gen::inRange(0, 4) == 0) *value = any();
        }
        p.step_s = std::max(p.step_s, 1e-5);  // only for the test to end soon
        p.dacRate_Hz = std::min(p.dacRate_Hz, 1e5);
        LensEmulator lens(p, any());
        lens.setAmbient(any());
        for (int i = 0; i < 3; ++i) {
            if (*rc::gen::arbitrary<bool>())
                lens.play({{any(), {any(), any()}, {any(), any()}}}, Hertz::fromSi(any()));
            else
                lens.hold(Dioptre::fromSi(any()));
            if (*rc::gen::arbitrary<bool>()) lens.warmUp();
            lens.advance(*rc::gen::arbitrary<bool>() ? 5.0_ms : Second::fromSi(any()));
            RC_ASSERT(std::isfinite(lens.power().si()));
            RC_ASSERT(std::isfinite(lens.temperature_C()));
            RC_ASSERT(std::abs(lens.current_A()) <= 0.29);
        }
    });
}

}  // namespace ilf::devices
