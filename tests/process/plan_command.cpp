#include <doctest/doctest.h>

#include <nlohmann/json.hpp>

#include "tests/support/run_program.h"

using ilf::runProgram;
using nlohmann::json;

namespace {

constexpr const char* kFourObjects =
    "plan --object A,0.25,blur --object B,0.5,focus --object C,0.5,blur --object D,1.3,blur --json";

}  // namespace

TEST_CASE("plan: the paper's second condition is driven by A at 0.25 m") {
    const auto ran = runProgram(ILF_STUDIO_PATH, kFourObjects);
    REQUIRE(ran.code == 0);
    const json plan = json::parse(ran.out);
    CHECK(std::abs(plan["P_s_D"].get<double>() - 4.07261643584172) < 1e-12);
    CHECK(plan["driving_region"] == "A");
    CHECK(plan["alpha_D"] == 0.2);
    CHECK(plan["sweep_D"][0] == 0.0);
    CHECK(std::abs(plan["sweep_D"][1].get<double>() - 4.27261643584172) < 1e-12);
    CHECK(std::abs(plan["K_f_D"].get<double>() - 0.07261643584172196) < 1e-15);
    CHECK(plan["slots"].size() == 16);
    for (const auto& region : plan["regions"]) {
        for (const char* key : {"name", "look", "distance_m", "P_min_D", "level_D", "blur_diameter_um",
                                "blur_diameter_attending_um", "scale", "problem"}) {
            CHECK_MESSAGE(region.contains(key), key);
        }
    }
}

TEST_CASE("plan: the paper's first condition blurs B alone") {
    const auto ran = runProgram(ILF_STUDIO_PATH, "plan --object A,0.25,focus --object B,0.5,blur --object C,0.5,focus "
                                                 "--object D,1.3,focus --json");
    REQUIRE(ran.code == 0);
    CHECK(std::abs(json::parse(ran.out)["P_s_D"].get<double>() - 2.07261643584172) < 1e-12);
}

TEST_CASE("plan: usage is refused with exit code 2 and a sentence") {
    for (const char* wrong : {"plan", "plan --object A,0.25", "plan --object A,zero,blur", "plan --object A,-1,blur",
                              "plan --object A,0.25,fuzzy", "plan --object A,0.25,blur --coc much",
                              "plan --object A,1,blur --object A,2,blur"}) {
        const auto ran = runProgram(ILF_STUDIO_PATH, std::string(wrong) + " 2>&1");
        CHECK_MESSAGE(ran.code == 2, wrong);
        CHECK_MESSAGE(ran.out.size() > 20, ran.out);
    }
}

TEST_CASE("plan: a project that is not there fails with exit code 1 and its name") {
    const auto ran = runProgram(ILF_STUDIO_PATH, "plan /nowhere/scene.ilfd 2>&1");
    CHECK(ran.code == 1);
    CHECK(ran.out.find("/nowhere/scene.ilfd") != std::string::npos);
}

TEST_CASE("the command line lists its bindings, version and help without a display") {
    const auto bindings = runProgram(ILF_STUDIO_PATH, "--list-bindings", "-u DISPLAY");
    CHECK(bindings.code == 0);
    CHECK(bindings.out.find("F12") != std::string::npos);
    CHECK(runProgram(ILF_STUDIO_PATH, "--version").out.starts_with("illuminatedfocus "));
    const auto help = runProgram(ILF_STUDIO_PATH, "--help");
    CHECK(help.code == 0);
    for (const char* word : {"plan", "render", "validate", "run", "Exit codes"}) {
        CHECK_MESSAGE(help.out.find(word) != std::string::npos, word);
    }
    CHECK(runProgram(ILF_STUDIO_PATH, "--no-such-option 2>/dev/null").code == 2);
}
