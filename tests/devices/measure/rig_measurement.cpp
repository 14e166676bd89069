// Measuring a rig step by step: the wizard's states, and the steps on an emulated bench.
#include "devices/measure/rig_measurement.h"

#include <doctest/doctest.h>

#include <chrono>
#include <cmath>
#include <string>

#include "core/lens/shaped_wave.h"
#include "devices/emulated_bench/emulated_bench.h"

using namespace ilf;
using namespace ilf::devices;

namespace {

RigMeasurementSetup setupFor(const EmulatedBench& bench, Eye eye) {
    RigMeasurementSetup setup;
    setup.eye = eye;
    setup.periods = 4;
    setup.steps = 3;
    setup.waves = 9;
    setup.provenance = Provenance::simulated;
    for (const double current_A : {-0.05, 0.0, 0.05, 0.1})
        setup.known.push_back(
            {Ampere::fromSi(current_A), Dioptre::fromSi(bench.truthAtRest(eye == Eye::left ? 0 : 1, current_A))});
    return setup;
}

/// What an operator does before a step.
void connect(EmulatedBench& bench, MeasureStep step, Eye eye) {
    const bool projector = step == MeasureStep::projector;
    bench.ai0 = projector ? Heard::trigger : eye == Eye::left ? Heard::left : Heard::right;
    bench.lensInBeam = eye == Eye::left ? 0 : 1;
    bench.photodiode.lit = step != MeasureStep::dark;
    bench.projectorLight = nullptr;
    if (projector)
        bench.projectorLight = [](double since_s) { return since_s >= 0.73e-3 && since_s < 3.4e-3 ? 1.5 : 0.0; };
}

bool still(EmulatedBench& bench) {
    const auto before = bench.currents();
    bench.pass(std::chrono::milliseconds(40));
    return before == bench.currents();
}

}  // namespace

TEST_CASE("wizard: steps are passed only when they were good; retry, back and cancel go where they say") {
    MeasureWizard wizard({MeasureStep::dark, MeasureStep::light});
    using State = MeasureWizard::State;
    CHECK_FALSE(wizard.measured({true, "", ""}));
    CHECK_FALSE(wizard.next());
    CHECK_FALSE(wizard.retry());
    CHECK_FALSE(wizard.back());
    REQUIRE(wizard.connected());
    CHECK_FALSE(wizard.connected());
    REQUIRE(wizard.measured({false, "0 V", "light"}));
    CHECK_FALSE(wizard.next());
    REQUIRE(wizard.retry());
    CHECK(wizard.outcomes().empty());
    REQUIRE(wizard.connected());
    REQUIRE(wizard.measured({true, "1 V", ""}));
    REQUIRE(wizard.next());
    CHECK(*wizard.step() == MeasureStep::light);
    REQUIRE(wizard.back());
    CHECK(*wizard.step() == MeasureStep::dark);
    CHECK(wizard.outcomes().empty());
    for (int i = 0; i < 2; ++i) {
        REQUIRE(wizard.connected());
        REQUIRE(wizard.measured({true, "", ""}));
        REQUIRE(wizard.next());
    }
    CHECK(wizard.state() == State::done);
    CHECK_FALSE(wizard.step());
    CHECK_FALSE(wizard.cancel());
    MeasureWizard other({MeasureStep::dark});
    REQUIRE(other.cancel());
    CHECK(other.state() == State::ended);
    CHECK_FALSE(other.connected());
}

TEST_CASE("every step of either eye is good on a bench that is wired as it asks, and lenses rest between steps") {
    for (const Eye eye : {Eye::left, Eye::right}) {
        CAPTURE(eye == Eye::left);
        EmulatedBench bench;
        RigMeasurement measurement(bench.link(), setupFor(bench, eye), bench.clock());
        for (const MeasureStep step : {MeasureStep::projector, MeasureStep::dark, MeasureStep::light,
                                       MeasureStep::powers, MeasureStep::waves, MeasureStep::drift}) {
            CAPTURE(wordsOf(step, eye).title);
            connect(bench, step, eye);
            const StepOutcome outcome = measurement.perform(step);
            CHECK_MESSAGE(outcome.good, outcome.advice);
            CHECK_FALSE(outcome.measured.empty());
            CHECK(still(bench));
        }
        const MeasuredRig& measured = measurement.measured();
        REQUIRE(measured.delay);
        CHECK(std::abs(measured.delay->mean.si() - 0.73e-3) < 8e-6);
        CHECK(measured.delay->delay.deviation < 0.05_ms);
        for (const StaticPower& one : measured.sweep->powers)
            CHECK(std::abs(one.power.si() - bench.truthAtRest(eye == Eye::left ? 0 : 1, one.current.si())) < 0.03);
        CHECK(measured.waves.size() >= 9);
        CHECK(std::abs(measured.drift_D) < 0.05);
    }
}

TEST_CASE("each step says in one sentence what is wrong, and is good once that is put right") {
    EmulatedBench bench;
    RigMeasurement measurement(bench.link(), setupFor(bench, Eye::left), bench.clock());
    const auto refused = [&](MeasureStep step, const std::string& part) {
        const StepOutcome outcome = measurement.perform(step);
        CAPTURE(outcome.advice);
        CHECK_FALSE(outcome.good);
        CHECK(outcome.advice.find(part) != std::string::npos);
        CHECK(still(bench));
    };
    connect(bench, MeasureStep::projector, Eye::left);
    bench.projectorLight = [](double) { return 1.0; };
    refused(MeasureStep::projector, "No edges");
    bench.projectorLight = nullptr;
    bench.photodiode.lit = false;
    refused(MeasureStep::projector, "No edges");
    refused(MeasureStep::powers, "does not follow the current");
    connect(bench, MeasureStep::light, Eye::left);
    refused(MeasureStep::dark, "bright for the dark");
    connect(bench, MeasureStep::dark, Eye::left);
    CHECK(measurement.perform(MeasureStep::dark).good);
    refused(MeasureStep::light, "no light");
    refused(MeasureStep::waves, "measured first");
    connect(bench, MeasureStep::light, Eye::left);
    bench.lensInBeam = 1;
    refused(MeasureStep::light, "does not move");
    bench.lensInBeam = 0;
    CHECK(measurement.perform(MeasureStep::light).good);
    bench.unplugged = true;
    refused(MeasureStep::powers, "gone");
    bench.unplugged = false;
    CHECK(measurement.perform(MeasureStep::powers).good);
    bench.photodiode.full_V *= 1.1;  // somebody touched the laser
    refused(MeasureStep::drift, "changed meanwhile");
}

TEST_CASE("a stop ends a step at once with the lenses at rest") {
    EmulatedBench bench;
    auto setup = setupFor(bench, Eye::left);
    int asked = 0;
    setup.stop = [&asked] { return ++asked > 30; };
    RigMeasurement measurement(bench.link(), setup, bench.clock());
    connect(bench, MeasureStep::dark, Eye::left);
    static_cast<void>(measurement.perform(MeasureStep::dark));
    connect(bench, MeasureStep::light, Eye::left);
    const StepOutcome outcome = measurement.perform(MeasureStep::powers);
    CHECK_FALSE(outcome.good);
    CHECK(outcome.advice.find("stopped") != std::string::npos);
    CHECK(still(bench));
}

TEST_CASE("a shaped wave is learnt through the same recorder") {
    EmulatedBench bench;
    RigMeasurement measurement(bench.link(), setupFor(bench, Eye::left), bench.clock());
    for (const MeasureStep step : {MeasureStep::dark, MeasureStep::light, MeasureStep::powers}) {
        connect(bench, step, Eye::left);
        REQUIRE(measurement.perform(step).good);
    }
    const auto learning =
        measurement.withRecorder([&](const RecordLens& record, const DriveLimits& limits) -> Result<void> {
            const double levels[] = {0.0, 1.5};
            const auto wave = learnt(record, 60.0_Hz, holdsFor(levels, 0.25, 1.0 / 32.0), 5, limits);
            if (!wave) return tl::unexpected(wave.error());
            CHECK(wave->unit == DriveUnit::ampere);
            CHECK(wave->largestError_D < 0.15);
            return {};
        });
    CHECK_MESSAGE(learning, learning.error().what);
    CHECK(still(bench));
}
