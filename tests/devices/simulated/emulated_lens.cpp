#include "devices/simulated/emulated_lens.h"

#include <doctest/doctest.h>

#include "devices/link/program_update.h"
#include "devices/simulated/virtual_stage.h"
#include "tests/devices/programs.h"

namespace ilf::devices {
namespace {

constexpr std::int64_t kMs = 1'000'000;

/// A sweep whose power was recorded on a lens of this preset, as a calibration would.
Waveform recordedWave(LensPreset preset, double low_V = 0.0, double high_V = 14e-3) {
    LensEmulator lens(lensParameters(preset));
    const Harmonics drive{{0.5 * (low_V + high_V), {0.0, -0.5 * (high_V - low_V)}}};
    const auto record = recorded(lens, drive, 60.0_Hz, {.periods = 3, .noise_D = 0.0});
    REQUIRE(record);
    Waveform wave;
    wave.mode = WaveMode::continuous;
    wave.power = harmonicsOf(record->power_D, 16);
    wave.drive = drive;
    const auto ends = extremes(wave.power);
    wave.low = Dioptre::fromSi(ends.low);
    wave.high = Dioptre::fromSi(ends.high);
    wave.temperature_C = record->temperature_C;
    return wave;
}

Program programOn(LensPreset preset, std::uint32_t seed = 1) {
    auto program = test::program(seed);
    program.waveform = recordedWave(preset);
    return program;
}

/// A stage whose lens is emulated.
struct Emulated : VirtualStage {
    explicit Emulated(LensPreset preset) { port.machine = Machine(port.nowNs(), preset); }

    Result<void> played(const Program& program) {
        return load(program).and_then([&] { return swap(); });
    }
    void inject(InjectFault::Kind kind) {
        REQUIRE(std::holds_alternative<Done>(port.machine.answered(InjectFault{kind, 0}, port.nowNs())));
    }
    /// As a player would: a heartbeat each 100 ms, and safe light at the first fault. Its sentence; empty: none.
    std::string faultWithin(double seconds) {
        for (int beat = 0; beat < 10.0 * seconds; ++beat) {
            port.waitUntil(port.nowNs() + 100 * kMs);
            const auto well = heartbeat();
            if (well) continue;
            CHECK(well.error().fault == Fault::device);
            safeLight();
            CHECK(state().light == LightMode::steady);
            CHECK(state().lens == LensMode::rest);
            return well.error().what;
        }
        return {};
    }
};

bool says(const std::string& sentence, const char* word) { return sentence.find(word) != std::string::npos; }

}  // namespace

TEST_CASE("emulated lens: its words are the presets' and ideal") {
    for (const auto preset : kLensPresets)
        CHECK(simulatedLensFromWord(word(SimulatedLens(preset))) == std::optional(SimulatedLens(preset)));
    CHECK(simulatedLensFromWord("ideal") == std::optional(SimulatedLens()));
    CHECK_FALSE(simulatedLensFromWord("glass"));
}

TEST_CASE("emulated lens: switched on it rests at 0 D, on every preset") {
    for (const auto preset : kLensPresets) {
        const auto state = Machine(5 * kMs, preset).state(5 * kMs);
        CHECK(state.powerNow.si() == doctest::Approx(0.0).scale(1.0).epsilon(0.005));
        CHECK(state.lens == LensMode::rest);
        CHECK(state.lensName == "simulated lens, preset " + std::string(word(preset)));
        CHECK(state.lensTemperature_C == doctest::Approx(30.0).epsilon(0.01));
    }
    CHECK(Machine(0).state(0).lensName == "simulated lens, ideal");
}

TEST_CASE("emulated lens: a recorded wave plays as recorded, from the start of the sweep, once settled") {
    for (const auto preset : kLensPresets) {
        CAPTURE(word(preset));
        const auto wave = recordedWave(preset);
        EmulatedLens lens(preset, 0);
        lens.play(wave, 7 * kMs);
        CHECK(lens.unsettled() >= 1.0_D);
        lens.advance(407 * kMs);
        CHECK(lens.unsettled() < 0.01_D);
        CHECK(lens.offWave() < 0.01_D);
        for (int i = 0; i < 40; ++i) {
            const std::int64_t now = 407 * kMs + i * 1'700'000;
            lens.advance(now);
            const auto told = wave.powerAt(Second::fromSi(static_cast<double>(now - 7 * kMs) * 1e-9));
            CHECK(abs(lens.power() - told) < 0.02_D);
        }
    }
}

TEST_CASE("emulated lens: seen late or often, stopped or not, it is the same lens") {
    const auto wave = recordedWave(LensPreset::datasheet);
    EmulatedLens often(LensPreset::datasheet, 0), seldom = often;
    often.play(wave, 0);
    seldom.play(wave, 0);
    for (int i = 1; i <= 900; ++i)
        often.advance(i * kMs);
    seldom.advance(900 * kMs);
    CHECK(abs(often.power() - seldom.power()) < 1e-3_D);
    seldom.advance(3'600'000 * kMs + 123'456);  // an hour later
    CHECK(seldom.unsettled() < 0.01_D);
    CHECK(seldom.offWave() < 0.05_D);
}

TEST_CASE("machine: an emulated lens refuses what it has no drive for, and holds what stands still") {
    Machine machine(0, LensPreset::datasheet);
    const auto refusal = [&](const Waveform& wave) {
        const Body answer = machine.answered(SetWaveform{wave}, kMs);
        const auto* refused = std::get_if<Refused>(&answer);
        return refused != nullptr ? refused->error.what : std::string();
    };
    CHECK(
        refusal(test::program(1).waveform) ==
        "The simulated lens (datasheet) cannot sweep 0.00 to 2.27 D: the program holds no drive for it; calibrate the "
        "lens and plan again.");
    auto amperes = recordedWave(LensPreset::datasheet);
    amperes.unit = DriveUnit::ampere;
    CHECK(says(refusal(amperes), "volts"));
    auto strong = recordedWave(LensPreset::datasheet);
    strong.drive.c[1] *= 100.0;
    CHECK(says(refusal(strong), "mV"));
    CHECK(machine.lens() == LensMode::rest);
    CHECK(refusal(stillWave(0.0_D, 1.5_D, 60.0_Hz)).empty());
    const auto state = machine.state(301 * kMs);
    CHECK(state.lens == LensMode::holding);
    CHECK(state.powerNow.si() == doctest::Approx(1.5).epsilon(0.01));
    CHECK(state.lensError < 0.01_D);
}

TEST_CASE("stage: slots come on over an emulated lens once its sweeps repeat, on every preset") {
    for (const auto preset : kLensPresets) {
        CAPTURE(word(preset));
        Emulated stage(preset);
        const auto before = stage.port.nowNs();
        const auto shown = stage.played(programOn(preset));
        REQUIRE_MESSAGE(shown, (shown ? "" : shown.error().what));
        CHECK(stage.port.nowNs() - before < 300 * kMs);
        CHECK(stage.state().lensError <= kSettledLens);
        CHECK(stage.state().offWave < kOffWave);
        CHECK(stage.faultWithin(1.0).empty());
        CHECK_FALSE(says(stage.report().lensLine, "calibrate"));
        stage.safeLight();
        stage.port.waitUntil(stage.port.nowNs() + 200 * kMs);
        CHECK(abs(stage.state().powerNow) < 0.01_D);
    }
}

TEST_CASE("stage: a lens that is not the calibrated one is told of, and the show goes on") {
    Emulated stage(LensPreset::lively);
    REQUIRE(stage.played(programOn(LensPreset::slow)));
    CHECK(stage.faultWithin(0.5).empty());
    CHECK(stage.state().light == LightMode::slotted);
    CHECK(stage.report().lensName == "simulated lens, preset lively");
    CHECK(says(stage.report().lensLine, "D from its predicted wave: calibrate again"));
}

TEST_CASE("stage: a lens 10 C warmer is a fault in words, and is not played until it has cooled") {
    Emulated stage(LensPreset::datasheet);
    const auto program = programOn(LensPreset::datasheet);
    REQUIRE(stage.played(program));
    stage.inject(InjectFault::Kind::warmer);
    const auto sentence = stage.faultWithin(0.2);
    CHECK(says(sentence, "The lens is at 40.1 C, 10.0 C above what its wave was planned for"));
    CHECK(stage.heartbeat());  // in safe light warmth is no fault
    const auto swaps = stage.state().swaps;
    CHECK_FALSE(stage.played(program));
    CHECK(stage.state().swaps == swaps);
    stage.safeLight();
    stage.inject(InjectFault::Kind::none);
    REQUIRE(stage.played(program));
    CHECK(stage.faultWithin(1.0).empty());
}

TEST_CASE("stage: 100 ppm between the clocks of lens and slots are a fault after two seconds, not before") {
    Emulated stage(LensPreset::datasheet);
    REQUIRE(stage.played(programOn(LensPreset::datasheet)));
    stage.inject(InjectFault::Kind::drift);
    CHECK(stage.faultWithin(1.8).empty());
    const auto sentence = stage.faultWithin(0.5);
    CHECK(says(sentence, "have drifted 0.2"));
    CHECK(says(sentence, "one clock"));
    REQUIRE(stage.played(programOn(LensPreset::datasheet)));  // in step again, for a while
    CHECK(stage.faultWithin(1.8).empty());
}

TEST_CASE("stage: a trigger that the projector missed is a fault at the next heartbeat") {
    for (const SimulatedLens lens : {SimulatedLens(), SimulatedLens(LensPreset::datasheet)}) {
        Emulated stage(LensPreset::datasheet);
        auto program = programOn(LensPreset::datasheet);
        if (!lens.preset) {
            stage.port.machine = Machine(stage.port.nowNs());
            program = test::program(1);
        }
        REQUIRE(stage.played(program));
        stage.inject(InjectFault::Kind::dropTrigger);
        const auto sentence = stage.faultWithin(0.1);
        CHECK(says(sentence, "missed a trigger, so that its slots are 1.04 ms off"));
        REQUIRE(stage.played(program));
        CHECK(stage.faultWithin(1.0).empty());
    }
}

TEST_CASE("machine: the ideal lens has neither warmth nor clock that could fail") {
    Machine machine(0);
    for (const auto kind : {InjectFault::Kind::warmer, InjectFault::Kind::drift, InjectFault::Kind::die})
        CHECK(std::holds_alternative<Refused>(machine.answered(InjectFault{kind, 0}, 0)));
}

}  // namespace ilf::devices
