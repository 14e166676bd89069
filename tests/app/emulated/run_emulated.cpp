// `run --rig emulated` as operators call it: unmodified programs over emulated cables, what they received beside what
// was intended, and how a show ends when something befalls it. Never on hardware.
#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/app/emulated/rig_there.h"
#include "tests/support/run_program.h"

using nlohmann::json;
using namespace ilf;

namespace {

struct RunOnRig {
    TemporaryDirectory folder;
    Ran ran;
    json report;

    /// The emulated rig keeps real time, which a busy machine may not: such a run is tried again.
    explicit RunOnRig(const std::string& options) {
        for (int tries = 0; tries < 5; ++tries) {
            run(options);
            if (ran.out.find("too busy") == std::string::npos) break;
            MESSAGE("tried again: ", ran.out);
        }
    }

private:
    void run(const std::string& options) {
        ran =
            runProgram(ILF_STUDIO_PATH,
                       "run '" + std::string(ILF_SOURCE_DIR) + "/projects/samples/four-objects.ilfd' --rig emulated " +
                           "--seconds 2 --report " + (folder / "r.json") + " " + options + " 2>&1",
                       "XDG_STATE_HOME=" + folder.path());
        std::ifstream file(folder / "r.json");
        if (file) report = json::parse(file, nullptr, false);
    }
};

}  // namespace

TEST_CASE("run --rig emulated: what the cables brought is what the plan states, pixel by pixel, and is seen") {
    if (!rigThere()) return;
    const TemporaryDirectory pictures;
    const RunOnRig run("--pictures " + pictures.path());
    REQUIRE_MESSAGE(run.ran.code == 0, run.ran.out);
    const json& report = run.report;
    CHECK(report["provenance"] == "drivers of real devices over emulated cables; never on hardware");
    REQUIRE(report["received"].size() == 6);
    for (const json& slot : report["received"]) {
        CHECK(slot["differing_pixels"] == 0);
        CHECK(slot["missing"] == false);
        CHECK(std::abs(slot["late_us"].get<double>()) < 100.0);
    }
    CHECK(report["comparison"]["as_intended"] == true);
    CHECK(report["comparison"]["extra_slots"] == 0);
    CHECK(report["quantisation"]["bits"] == 4);
    CHECK(report["quantisation"]["largest_error"] <= report["quantisation"]["step"]);
    for (const char* eye : {"left", "right"}) {
        const json& lens = report["lenses"][eye];
        CHECK(lens["off_in_slots_rms_mD"] < 150.0);
        CHECK(lens["greatest_current_mA"] > 1.0);
        CHECK(lens["greatest_current_mA"] <= 250.0);
    }
    CHECK(report["timing"]["locked"] == true);
    CHECK(report["cables"]["harmed"] == false);
    CHECK(report["cables"]["led_current_writes"] == 0);
    CHECK(report["sent_to_first_light_ms"] > 0.0);
    for (const char* name : {"perceived-received-left.png", "perceived-received-right.png", "slot-00-received.png"})
        CHECK(std::filesystem::exists(pictures / name));
    int received = 0;
    for (const json& view : report["views"]) {
        if (!view.contains("of")) continue;
        ++received;
        CHECK(view["psnr_against_intended_dB"] > 25.0);
    }
    CHECK(received == 2);
}

TEST_CASE("run --rig emulated: a mishap ends in steady white light and lenses at rest, and is told") {
    if (!rigThere()) return;
    const RunOnRig run("--mishap projector:wrong-mode");
    CHECK_MESSAGE(run.ran.code == 3, run.ran.out);
    REQUIRE_MESSAGE(run.report.contains("mishap"), run.ran.out);
    const json& mishap = run.report["mishap"];
    CHECK(mishap["fault"].get<std::string>().size() > 20);
    CHECK(mishap["ended"]["steady_white"] == true);
    CHECK(mishap["ended"]["lenses_at_rest"] == true);
    CHECK(run.report["comparison"]["differing_pixels"] == 0);  // before it
    CHECK(mishap["led_current_writes"] == 0);
}

TEST_CASE("run: mishaps and rigs that cannot be are refused in words") {
    const auto run = [](const std::string& options) {
        return runProgram(ILF_STUDIO_PATH, "run '" + std::string(ILF_SOURCE_DIR) +
                                               "/projects/samples/four-objects.ilfd' " + options + " 2>&1");
    };
    for (const char* wrong : {"--rig emulated --mishap projector", "--rig emulated --mishap projector:nack:x",
                              "--rig emulated --mishap projector:nack:-1", "--mishap projector:nack",
                              "--rig emulated --simulated-lens ideal", "--bits 9"}) {
        const Ran ran = run(wrong);
        CHECK_MESSAGE(ran.code == 2, wrong, ": ", ran.out);
        CHECK(ran.out.size() > 40);
    }
    const Ran none = run("--rig no-such-rig.json");
    CHECK(none.code == 1);
    CHECK(none.out.find("no-such-rig.json") != std::string::npos);
}
