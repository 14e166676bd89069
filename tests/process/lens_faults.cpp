// The real output core on an emulated lens: what befalls the lens ends in steady light and a sentence.
#include "devices/simulated/lens_emulator.h"
#include "tests/process/output_core.h"

using namespace ilf;
using namespace ilf::test;
using devices::InjectFault;
using devices::LightMode;
using devices::Status;

namespace {

Program recordedProgram() {
    devices::LensEmulator lens;
    const Harmonics drive{{7e-3, {0.0, -7e-3}}};
    const auto record = recorded(lens, drive, 60.0_Hz, {.noise_D = 0.0});
    REQUIRE(record);
    auto p = program(1);
    p.waveform.mode = WaveMode::continuous;
    p.waveform.drive = drive;
    p.waveform.power = harmonicsOf(record->power_D, 16);
    p.waveform.low = Dioptre::fromSi(extremes(p.waveform.power).low);
    p.waveform.high = Dioptre::fromSi(extremes(p.waveform.power).high);
    return p;
}

void inject(const OutputCore& core, InjectFault::Kind kind) {
    auto client = core.devicesClient();
    REQUIRE(devices::ask<devices::Done>(client, InjectFault{kind, 0}).has_value());
}

}  // namespace

TEST_CASE("an emulated lens plays what was recorded on it; warmth, drift and a lost trigger are faults in words") {
    const OutputCore core("datasheet");
    auto link = core.connected();
    const auto program = recordedProgram();
    struct Case {
        InjectFault::Kind kind;
        const char* word;
    };
    std::uint64_t revision = 0;
    for (const auto& [kind, word] :
         {Case{InjectFault::Kind::warmer, "above what its wave was planned for"},
          Case{InjectFault::Kind::drift, "one clock"}, Case{InjectFault::Kind::dropTrigger, "missed a trigger"}}) {
        CAPTURE(word);
        OutputCore::take(link, program, ++revision);
        const auto playing = core.deviceState();
        CHECK(playing.light == LightMode::slotted);
        CHECK(playing.lensName == "simulated lens, preset datasheet");
        CHECK(playing.lensError < 0.05_D);
        CHECK(playing.offWave < 0.05_D);
        const auto faults = link.status().faults;
        inject(core, kind);
        CHECK(OutputCore::until(link, seconds(5), [&](const Status& s) { return s.faults == faults + 1; }));
        CHECK(link.status().fault.find(word) != std::string::npos);
        CHECK(core.devicesBecome(seconds(1), safe));
        CHECK(link.status().hold != 0);
        inject(core, InjectFault::Kind::none);
    }
    checkOrderKept(core.deviceState());
}

TEST_CASE("a program without a drive is refused by an emulated lens in words, and the light stays steady") {
    const OutputCore core("lively");
    auto link = core.connected();
    REQUIRE(link.send(program(1), 1, devices::Why::take).has_value());
    CHECK(OutputCore::until(link, seconds(5), [](const Status& s) { return !s.fault.empty(); }));
    CHECK(link.status().fault.find("calibrate the lens and plan again") != std::string::npos);
    CHECK(safe(core.deviceState()));
}
