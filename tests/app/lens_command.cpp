// `lens`: what scripts get from the program, and what they are refused.
#include <doctest/doctest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "tests/support/run_program.h"

using namespace ilf;
using nlohmann::json;

namespace {

Ran lens(const std::string& arguments) { return readAsCalled(ILF_STUDIO_PATH, "lens " + arguments); }
/// Standard output alone.
Ran quietLens(const std::string& arguments) {
    return runProgram(ILF_STUDIO_PATH, "lens " + arguments + " 2>/dev/null");
}

std::string contentOf(const std::string& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace

TEST_CASE("lens: recorded, looked into, chosen from, exported and imported again") {
    const TemporaryDirectory folder;
    const std::string file = folder / "lens.ilflens";
    const Ran recorded = lens("record --preset datasheet --rate 60 --waves 40 --temperature 30 -o " + file);
    REQUIRE_MESSAGE(recorded.code == 0, recorded.out);
    CHECK(recorded.out.find("Simulated, not measured") != std::string::npos);

    const json info = json::parse(quietLens("info --json " + file).out);
    CHECK(info["lens"] == "simulated lens, preset datasheet");
    CHECK(info["simulated"] == true);
    CHECK(info["provenance"] == json::array({"simulated"}));
    CHECK(std::abs(info["temperature_C"]["at_rest"].get<double>() - 30.0) < 0.1);
    REQUIRE(info["rates"].size() == 1);
    CHECK(info["rates"][0]["rate_Hz"] == 60.0);
    CHECK(info["rates"][0]["waves"]["sine"] == 43);
    CHECK(info["rates"][0]["power_D"][0] < 0.0);
    CHECK(info["rates"][0]["power_D"][1] > 6.0);
    CHECK(info["rates"][0]["beyond_lens"] == 0);
    CHECK(info["rates"][0]["model"]["rms_fit_D"] < 0.02);
    CHECK(lens("info " + file).out.find("continuous model of degree") != std::string::npos);

    const Ran chosen = quietLens("choose " + file + " --low 0 --high 2.27 --mode continuous --json");
    REQUIRE(chosen.code == 0);
    const json choice = json::parse(chosen.out);
    CHECK(choice["provenance"] == "simulated");
    CHECK(std::abs(choice["wave"]["power_D"][0].get<double>()) < 0.05);
    CHECK(std::abs(choice["wave"]["power_D"][1].get<double>() - 2.27) < 0.05);
    CHECK(choice["wave"]["drive"]["unit"] == "V");
    const json covering = json::parse(quietLens("choose " + file + " --low 0 --high 2.27 --mode paper --json").out);
    CHECK(covering["wave"]["id"] > 0);
    CHECK(covering["wave"]["power_D"][0] <= 0.0);
    CHECK(covering["wave"]["power_D"][1] >= 2.27);

    const std::string csv = folder / "csv", back = folder / "back.ilflens";
    REQUIRE(lens("export " + file + " -o " + csv).code == 0);
    CHECK(std::filesystem::exists(csv + "/manifest.csv"));
    const Ran imported = lens("import " + csv + " -o " + back);
    REQUIRE_MESSAGE(imported.code == 0, imported.out);
    const json again = json::parse(quietLens("info --json " + back).out);
    CHECK(again["rates"][0]["waves"] == info["rates"][0]["waves"]);
    CHECK(again["provenance"] == info["provenance"]);
    CHECK(std::abs(again["rates"][0]["model"]["rms_fit_D"].get<double>() -
                   info["rates"][0]["model"]["rms_fit_D"].get<double>()) < 1e-4);
}

TEST_CASE("lens: the same seed records the same lens, another seed another one") {
    const TemporaryDirectory folder;
    const auto power = [&](const std::string& seed) {
        const std::string file = folder / ("s" + seed);
        REQUIRE(lens("record --waves 12 --seed " + seed + " -o " + file).code == 0);
        const json info = json::parse(quietLens("info --json " + file).out);
        CHECK(info["lens"] == "simulated lens, preset datasheet, seed " + seed);
        return info["rates"][0]["power_D"].dump();
    };
    const std::string first = power("5");
    CHECK(power("5") == first);
    CHECK(power("6") != first);
}

TEST_CASE("lens shape: a wave learnt on the simulated lens is kept with the file's waves, and chosen") {
    const TemporaryDirectory folder;
    const std::string file = folder / "lens.ilflens";
    REQUIRE(lens("record --waves 12 -o " + file).code == 0);
    const Ran none = lens("choose " + file + " --low 0 --high 2.2 --mode shaped");
    CHECK(none.code == 4);
    const Ran shaped = lens("shape " + file + " --levels 0,2.2 --duty 0.3 --harmonics 5 --rate 60 -o " + file);
    REQUIRE_MESSAGE(shaped.code == 0, shaped.out);
    CHECK(shaped.out.find("simulated, not measured") != std::string::npos);
    const json info = json::parse(quietLens("info --json " + file).out);
    REQUIRE(info["shaped"].size() == 1);
    CHECK(info["shaped"][0]["largest_error_D"] <= 0.05);
    CHECK(info["rates"][0]["waves"]["sine"] == 15);
    const json choice = json::parse(quietLens("choose " + file + " --low 0 --high 2.2 --mode shaped --json").out);
    CHECK(choice["wave"]["id"] == info["shaped"][0]["id"]);
    const json told = json::parse(quietLens("shape --preset slow --levels 0,1.2 --json").out);
    CHECK(told["lens"] == "simulated lens, preset slow");
    CHECK(told["provenance"] == "simulated");
    CHECK(told["holds"].size() == 2);
}

TEST_CASE("lens: what cannot be is refused in one sentence, with the right exit code, and harms no file") {
    const TemporaryDirectory folder;
    const std::string file = folder / "lens.ilflens";
    REQUIRE(lens("record --waves 12 -o " + file).code == 0);
    const auto refused = [&](const std::string& arguments, int code, const std::string& part) {
        const Ran ran = lens(arguments);
        CHECK_MESSAGE(ran.code == code, arguments, ": ", ran.out);
        CHECK_MESSAGE(ran.out.find(part) != std::string::npos, ran.out);
    };
    const std::string before = contentOf(file);
    refused("", 2, "subcommand");
    refused("record", 2, "--out");
    refused("record --waves 3 -o " + file, 2, "--waves");
    refused("record --paper --waves 12 -o " + file, 2, "excludes");
    refused("record --rate 0 -o " + file, 2, "--rate");
    refused("record --preset keen -o " + file, 1, "no lens preset \"keen\". Choose one of slow, datasheet");
    refused("choose " + file + " --low 0 --high 2 --mode sideways", 2, "--mode");
    refused("choose " + file + " --low 0 --high 9.9", 4, "the largest high power is");
    refused("choose " + file + " --low 0 --high 2 --rate 90", 4, "90 Hz");
    refused("choose " + file + " --low 3 --high 2", 4, "not lower");
    refused("info " + (folder / "nowhere"), 1, "does not exist");
    refused("import " + (folder / "nowhere") + " -o " + (folder / "x"), 1, "no folder");
    refused("shape " + file + " --levels 0 -o " + file, 1, "two levels");
    refused("shape " + file + " --levels 0,2.2 --duty 0.6 -o " + file, 1, "");
    refused("export " + file + " -o " + folder.path(), 1, "not empty");
    CHECK(contentOf(file) == before);

    std::ofstream(folder / "half", std::ios::binary) << before.substr(0, before.size() / 2);
    refused("info " + (folder / "half"), 1, "cut short");
    refused("choose " + (folder / "half") + " --low 0 --high 2", 1, "cut short");
    std::ofstream(folder / "notes.txt") << "shopping: bread";
    refused("info " + (folder / "notes.txt"), 1, "not a wave database");
    refused("record --waves 12 -o " + (folder / "notes.txt"), 1, "choose another name");
    CHECK(contentOf(folder / "notes.txt") == "shopping: bread");

    // A measured lens's file is not written over by an emulator, and cannot be shaped.
    REQUIRE(lens("export " + file + " -o " + (folder / "csv")).code == 0);
    REQUIRE(std::system(("sed -i 's/^# provenance=.*/# provenance=measured/; s/^# etl_kind=.*/# etl_kind=etl/' " +
                         (folder / "csv") + "/wave*")
                            .c_str()) == 0);
    const std::string real = folder / "real.ilflens";
    REQUIRE(lens("import " + (folder / "csv") + " -o " + real).code == 0);
    CHECK(json::parse(quietLens("info --json " + real).out)["provenance"] == json::array({"measured"}));
    refused("record --waves 12 -o " + real, 1, "choose another name");
    refused("shape " + real + " --levels 0,2.2", 1, "can only drive the simulated lens");
    // Line 30 is a sample: t_s,u,P_D.
    REQUIRE(std::system(("sed -i '30s/,[^,]*$/,nan/' " + (folder / "csv") + "/wave-000004.csv").c_str()) == 0);
    refused("import " + (folder / "csv") + " -o " + (folder / "y"), 1,
            "wave-000004.csv\", line 30: P_D is no finite number");
    CHECK(!std::filesystem::exists(folder / "y"));
}
