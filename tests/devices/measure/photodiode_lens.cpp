// A lens measured before an emulated photodiode, against what the lens truly does; and every way it may go wrong.
#include "devices/measure/photodiode_lens.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>

#include "core/lens/continuous_model.h"
#include "devices/emulated_bench/emulated_bench.h"

using namespace ilf;
using namespace ilf::devices;

namespace {

/// A bench with everything opened on it, as a measurement has.
struct Measured {
    EmulatedBench bench;
    LensBenchSetup setup;
    std::shared_ptr<UsbLink> link = bench.link();
    std::unique_ptr<LensOutput> output;
    std::unique_ptr<AnalogInput> input;
    std::unique_ptr<LensBench> lens;

    explicit Measured(LensPreset preset = LensPreset::datasheet, int periods = 24) : bench(preset) {
        setup.periods = periods;
        opened();
    }
    void opened() {
        setup.channels.left.rest = setup.channels.right.rest = Ampere::fromSi(-0.006);
        output = LensOutput::open(link, {setup.channels, 4}, bench.clock()).value();
        input = AnalogInput::start(link, Hearing::triggerAndAI1, bench.clock()).value();
        bench.largest_A = 0.0;  // opening closes an emulated relay with one output still at 0 V
        lens = std::make_unique<LensBench>(*output, *input, setup, bench.clock());
    }
    StaticSweepSetup sweepSetup(int eye = 0) {
        StaticSweepSetup sweep;
        sweep.dark_V = bench.photodiode.dark_V;
        // As a lensmeter tells them: hundredths of a dioptre.
        for (const double current_A : {-0.06, -0.03, 0.0, 0.04, 0.08, 0.11})
            sweep.known.push_back({Ampere::fromSi(current_A),
                                   Dioptre::fromSi(0.01 * std::round(100.0 * bench.truthAtRest(eye, current_A)))});
        return sweep;
    }
    bool atRest() {
        const auto now = bench.currents();
        return std::abs(now[0] + 0.006) < 2e-4 && std::abs(now[1] + 0.006) < 2e-4;
    }
};

double rms(const std::vector<double>& a, const std::vector<double>& b) {
    double sum = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i)
        sum += (a[i] - b[i]) * (a[i] - b[i]);
    return std::sqrt(sum / static_cast<double>(a.size()));
}

Harmonics sine(double offset, double amplitude) { return {{offset, std::complex<double>(0.0, -amplitude)}}; }

}  // namespace

TEST_CASE("static powers and waves come out as the lens has them") {
    for (const LensPreset preset : {LensPreset::clean, LensPreset::datasheet}) {
        CAPTURE(std::string(word(preset)));
        Measured m(preset);
        const auto sweep = staticSweep(*m.lens, m.sweepSetup());
        REQUIRE_MESSAGE(sweep, sweep.error().what);
        double worst = 0.0;
        for (const StaticPower& one : sweep->powers)
            worst = std::max(worst, std::abs(one.power.si() - m.bench.truthAtRest(0, one.current.si())));
        // Lensmeter to 5 mD, light's noise, the scale's bend and half of a hysteresis that the steps before left.
        CHECK(worst < 0.02);
        CHECK(sweep->hysteresis_D < (preset == LensPreset::clean ? 0.02 : 0.15));
        CHECK(sweep->noise_D < 0.005);
        CHECK(sweep->leastSlope_D_per_A > 10.0);
        CHECK(sweep->powers.size() >= 15);

        WaveRecording waves{sweep->scale, limitsOf(*sweep, m.lens->amplifier(), -10.0_D, 10.0_D),
                            [&] { return m.bench.lenses[0].temperature_C(); }, Provenance::simulated, 250};
        const auto record = photodiodeRecorder(*m.lens, waves);
        for (const Harmonics& drive : {sine(0.01, 0.03), sine(0.03, 0.05),
                                       Harmonics{{{0.02, 0}, {0.01, -0.02}, {-0.008, 0.004}, {0.0, 0.003}}}}) {
            const auto wave = record(drive, 60.0_Hz);
            REQUIRE_MESSAGE(wave, wave.error().what);
            const auto truth = m.bench.truth(0, drive, 60.0_Hz, 250);
            CHECK(wave->noise_D < 0.01);
            // An input hears an output's steps at one phase of them: the place in the sweep is known to half a sample
            // (10 us), which is 0.008 D rms of the widest of these waves.
            CHECK(rms(wave->power_D, truth) < 0.025);
            CHECK(wave->temperature_C > 29.9);
            CHECK(wave->provenance == Provenance::simulated);
        }
        m.output->safe();
        CHECK(m.atRest());
    }
}

TEST_CASE("a survey recorded before the photodiode serves a model, at rates of odd sweeps too") {
    for (const double rate_Hz : {60.0, 48000.0 / 801.0}) {
        CAPTURE(rate_Hz);
        Measured m(LensPreset::datasheet, 8);
        StaticSweepSetup setup = m.sweepSetup();
        setup.steps = 3;
        const auto sweep = staticSweep(*m.lens, setup);
        REQUIRE_MESSAGE(sweep, sweep.error().what);
        const DriveLimits limits = limitsOf(*sweep, m.lens->amplifier(), -10.0_D, 10.0_D);
        WaveRecording waves{sweep->scale, limits, [&] { return m.bench.lenses[0].temperature_C(); },
                            Provenance::measured, 250};
        const auto records =
            recordedWaves(photodiodeRecorder(*m.lens, waves), *sweep, limits, Hertz::fromSi(rate_Hz), 15);
        REQUIRE_MESSAGE(records, records.error().what);
        CHECK(records->size() >= 15);
        const auto model = fitted(*records);
        REQUIRE_MESSAGE(model, model.error().what);
        CHECK(model->rmsFit_D < 0.05);
        const auto shown = model->power(0.02, 0.025);
        const auto truth = m.bench.truth(0, sine(0.02, 0.025), Hertz::fromSi(rate_Hz), 250);
        CHECK(rms(samplesOf(shown, 250), truth) < 0.06);
        CHECK(m.bench.largest_A < 0.115);
    }
}

TEST_CASE("what is wrong on the bench is refused in one sentence, and the lenses rest") {
    const auto why = [](Measured& m) {
        StaticSweepSetup setup = m.sweepSetup();
        setup.known = {setup.known[1], setup.known[2], setup.known[4]};
        setup.steps = 3;
        auto sweep = staticSweep(*m.lens, setup);
        if (!sweep) return sweep.error().what;
        WaveRecording waves{
            sweep->scale, limitsOf(*sweep, m.lens->amplifier(), -10.0_D, 10.0_D), {}, Provenance::measured, 250};
        const auto record = photodiodeRecorder(*m.lens, waves)(sine(0.02, 0.03), 60.0_Hz);
        return record ? std::string("measured") : record.error().what;
    };
    const auto says = [&](const std::function<void(Measured&)>& breaks, const char* part) {
        Measured m(LensPreset::datasheet, 6);
        breaks(m);
        const std::string said = why(m);
        CAPTURE(said);
        CHECK(said.find(part) != std::string::npos);
        CHECK(said.find('\n') == std::string::npos);
        m.output->safe();
        CHECK((m.bench.unplugged || m.atRest()));
    };
    says([](Measured&) {}, "measured");
    says([](Measured& m) { m.bench.photodiode.lit = false; }, "does not follow the current");
    says([](Measured& m) { m.bench.lensPlugged[0] = false; }, "does not follow the current");
    says([](Measured& m) { m.bench.lensInBeam = 1; }, "does not follow the current");
    says([](Measured& m) { m.bench.ai1 = Heard::nothing; }, "does not follow the current");
    says([](Measured& m) { m.bench.photodiode.full_V = 120.0; }, "more than the input can hear");
    says([](Measured& m) { m.bench.ai0 = Heard::nothing; }, "AI0 does not hear");
    says([](Measured& m) { m.bench.ai0 = Heard::trigger; }, "AI0 does not hear");
    says([](Measured& m) { m.bench.ai0 = Heard::right; }, "AI0 does not hear");
    says([](Measured& m) { m.bench.failsAt = m.bench.calls + 40, m.bench.goesAway = true; }, "gone");
}

TEST_CASE("a known power that is mistyped is told by how far it is off") {
    Measured m(LensPreset::datasheet, 6);
    StaticSweepSetup setup = m.sweepSetup();
    setup.steps = 3;
    setup.known[2].power += 0.8_D;
    const auto sweep = staticSweep(*m.lens, setup);
    REQUIRE_FALSE(sweep);
    CHECK(sweep.error().what.find("Check the known powers") != std::string::npos);
    setup.known = {setup.known.front()};
    CHECK(staticSweep(*m.lens, setup).error().what.find("at least two currents") != std::string::npos);
}

TEST_CASE("whichever call fails, the sweep ends with the lenses at rest") {
    int calls = 0;
    {
        Measured m(LensPreset::datasheet, 2);
        const int before = m.bench.calls;
        REQUIRE(m.lens->held(Ampere::fromSi(0.03)));
        REQUIRE(m.lens->repeated(sine(0.02, 0.03), 60.0_Hz));
        calls = m.bench.calls - before;
    }
    for (int n = 1; n <= calls; n += n < 12 ? 1 : 9) {
        CAPTURE(n);
        Measured m(LensPreset::datasheet, 2);
        m.bench.failsAt = m.bench.calls + n;
        const auto held = m.lens->held(Ampere::fromSi(0.03));
        const auto wave = held ? m.lens->repeated(sine(0.02, 0.03), 60.0_Hz) : Result<PeriodVolts>(PeriodVolts{});
        CHECK_FALSE((held && wave));
        m.bench.pass(std::chrono::milliseconds(200));
        CHECK(m.atRest());
    }
}
