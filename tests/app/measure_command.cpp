// `measure`: what scripts get from the program, and what they are refused.
#include <doctest/doctest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "core/lens/shaped_wave.h"
#include "projects/wave_database.h"
#include "projects/wearer_rig.h"
#include "tests/support/run_program.h"

using namespace ilf;
using nlohmann::json;

namespace {

Ran measure(const std::string& arguments) { return readAsCalled(ILF_STUDIO_PATH, "measure " + arguments); }

}  // namespace

TEST_CASE("measure delay: of flashes after a trigger, as JSON and in words") {
    const TemporaryDirectory folder;
    const std::string file = folder / "flashes.csv";
    {
        std::ofstream out(file);
        out << "seconds,trigger,light\n";
        for (int i = 0; i < 40000; ++i) {
            const double t = i / 20000.0, since = std::fmod(t, 1.0 / 60.0);
            out << t << ',' << (since < 0.0004 ? 3.3 : 0.0) << ',' << (since > 0.0018 && since < 0.005 ? 1.0 : 0.0)
                << '\n';
        }
    }
    const Ran ran = measure("delay --shortest 1 --json " + file);
    REQUIRE_MESSAGE(ran.code == 0, ran.out);
    const json told = json::parse(ran.out);
    CHECK(std::abs(told["delay"]["median_s"].get<double>() - 0.0018) < 1e-4);
    CHECK(told["missing"] == 0);
    CHECK(told["confidence"] == "good");
    CHECK(measure("delay " + file).out.find("after its trigger") != std::string::npos);
    CHECK(measure("delay " + (folder / "none.csv")).code == 1);
    std::ofstream(folder / "still.csv") << "0,0\n";
    CHECK(measure("delay " + (folder / "still.csv")).code == 1);
}

TEST_CASE("measure rig: an emulated one ends in waves and a rig that plans; files that are there stay") {
    const TemporaryDirectory folder;
    const std::string lens = folder / "lens.ilflens", rigFile = folder / "rig.json";
    const Ran ran = measure("rig --yes --waves 12 -o " + lens + " --save-rig " + rigFile);
    REQUIRE_MESSAGE(ran.code == 0, ran.out);
    CHECK(ran.out.find("not measured") != std::string::npos);
    const auto waves = projects::openWaves(lens);
    REQUIRE_MESSAGE(waves, waves.error().what);
    CHECK(waves->lens.emulated);
    CHECK(waves->method == "photodiode");
    CHECK(waves->records.size() >= 12);
    for (const LensRecord& record : waves->records)
        CHECK(record.provenance == Provenance::simulated);
    REQUIRE(waves->delays.size() == 1);
    CHECK(std::abs(waves->delays[0].delay_s - 0.46e-3) < 50e-6);
    const auto rig = projects::readRig(rigFile);
    REQUIRE_MESSAGE(rig, rig.error().what);
    CHECK(rig->provenance == "simulated");
    REQUIRE(rig->devices);
    CHECK(rig->devices->left.powers.size() > 10);
    CHECK(std::abs(rig->projectorDelay.si() - 0.46e-3) < 50e-6);

    const auto before = std::filesystem::file_size(lens);
    const Ran again = measure("rig --yes --waves 12 -o " + lens);
    CHECK(again.code == 1);
    CHECK(again.out.find("--replace") != std::string::npos);
    CHECK(std::filesystem::file_size(lens) == before);
}

TEST_CASE("measure rig: a shaped wave is learnt on the lens as it was measured, and chosen from its file") {
    const TemporaryDirectory folder;
    const std::string lens = folder / "lens.ilflens";
    const Ran ran = measure("rig --yes --no-projector --waves 9 --shape 1.5,0 -o " + lens);
    REQUIRE_MESSAGE(ran.code == 0, ran.out);
    CHECK(ran.out.find("Learnt: a wave that holds 2 levels") != std::string::npos);
    const auto waves = projects::openWaves(lens);
    REQUIRE_MESSAGE(waves, waves.error().what);
    REQUIRE(waves->shaped.size() == 1);
    const ShapedWave& wave = waves->shaped[0];
    CHECK(wave.provenance == Provenance::simulated);
    CHECK(wave.unit == DriveUnit::ampere);
    CHECK(wave.rate == 60.0_Hz);
    REQUIRE(wave.holds.size() == 2);
    CHECK(wave.holds[0].power_D + wave.holds[1].power_D == doctest::Approx(1.5));
    // What is stored was recorded, not designed, and held within what the bench's photodiode can tell.
    CHECK(wave.largestError_D < 0.05);  // 0.015 on this bench
    CHECK(largestErrorIn(wave.holds, wave.power) == doctest::Approx(wave.largestError_D).epsilon(0.01));
    CHECK(wave.errors_D.front() >= wave.largestError_D);
    const Ran chosen = runProgram(ILF_STUDIO_PATH, "lens choose " + lens + " --low 0 --high 1.5 --mode shaped --json");
    REQUIRE_MESSAGE(chosen.code == 0, chosen.out);
    CHECK(json::parse(chosen.out)["wave"]["id"] == wave.id);
    // Levels that its current limit keeps out of reach are refused, and nothing is written.
    const std::string far = folder / "far.ilflens";
    const Ran beyond = measure("rig --yes --no-projector --waves 9 --shape -40,40 -o " + far);
    CHECK(beyond.code != 0);
    CHECK_FALSE(std::filesystem::exists(far));
}

TEST_CASE("measure rig: what is missing is said before anything moves, and nothing is written") {
    const TemporaryDirectory folder;
    const std::string lens = folder / "lens.ilflens";
    const auto refused = [&](const std::string& arguments, const char* part) {
        const Ran ran = measure("rig " + arguments + " -o " + lens + " < /dev/null");
        CAPTURE(ran.out);
        CHECK(ran.code != 0);
        CHECK(ran.out.find(part) != std::string::npos);
        CHECK_FALSE(std::filesystem::exists(lens));
    };
    refused("", "say --yes");
    refused("--rig simulated --yes", "names no devices");
    refused("--rig " + (folder / "none.json") + " --yes", "none.json");
    std::ofstream(folder / "one.csv") << "mA,D\n0,0.5\n";
    refused("--yes --known " + (folder / "one.csv"), "at least two powers");
    std::ofstream(folder / "odd.csv") << "0,0.5\n10;2\n";
    refused("--yes --known " + (folder / "odd.csv"), "line 2");
    std::ofstream(folder / "wrong.csv") << "-50,-3\n0,3\n50,3.2\n100,6.7\n";
    refused("--yes --known " + (folder / "wrong.csv"), "known powers");
}
