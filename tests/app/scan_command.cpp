// `scan` as operators call it, on devices that nobody has to own: against the emulated scene's truth, and with faults.
#include <doctest/doctest.h>

#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "projects/map_file.h"
#include "tests/support/run_program.h"

using nlohmann::json;
using namespace ilf;

namespace {

Ran scanned(const TemporaryDirectory& folder, const std::string& options) {
    return runProgram(ILF_STUDIO_PATH, "scan -o " + (folder / "map.yml.gz") + " " + options,
                      "XDG_STATE_HOME=" + folder.path());
}

/// Xvfb and umockdev's preload are what the emulated rig is made of, and a sanitizer must precede the latter.
bool emulatedRigThere() {
#if defined(__SANITIZE_THREAD__) || defined(__SANITIZE_ADDRESS__)
    MESSAGE("SKIPPED: the emulated rig's processes preload a library that a sanitizer must precede");
    return false;
#else
    if (std::system("command -v Xvfb >/dev/null 2>&1") == 0) return true;
    MESSAGE("SKIPPED: there is no Xvfb (package xvfb)");
    return false;
#endif
}

void checkMap(const TemporaryDirectory& folder, const Ran& ran) {
    REQUIRE_MESSAGE(ran.code == 0, ran.out);
    const json report = json::parse(ran.out);
    CHECK(report["provenance"] == "emulated");
    CHECK(report["against_truth"]["rms_px"] <= 0.2);
    CHECK(report["against_truth"]["beyond_2px_share"] < 0.01);
    CHECK(report["decoded_share_of_lit"] > 0.9);
    CHECK(report["check"]["columns"]["rms_px"] <= 0.5);
    CHECK(report["check"]["rows"]["rms_px"] <= 0.5);
    const auto map = projects::readMap(folder / "map.yml.gz");
    REQUIRE_MESSAGE(map, map.error().what);
    CHECK(map->facts.at("provenance") == "emulated");
    CHECK(map->map.camera() == Size{640, 512});
}

}  // namespace

TEST_CASE("scan --rig simulated: the map is where light truly lands, and the pictures are kept") {
    const TemporaryDirectory folder;
    const Ran ran = scanned(folder, "--camera emulated:binning=2 --json --keep " + (folder / "kept"));
    checkMap(folder, ran);
    CHECK(std::filesystem::exists(folder / "kept/41.png"));
    CHECK_FALSE(std::filesystem::exists(folder / "kept/42.png"));
}

TEST_CASE("scan --rig emulated: the same through unmodified drivers and emulated cables") {
    if (!emulatedRigThere()) return;
    const TemporaryDirectory folder;
    Ran ran;
    for (int tries = 0; tries < 3; ++tries) {  // it keeps real time, which a busy machine may not
        ran = scanned(folder, "--rig emulated --camera emulated:binning=2 --json");
        if (ran.code == 0) break;
        MESSAGE("tried again: ", ran.out);
    }
    checkMap(folder, ran);
}

TEST_CASE("scan: what goes wrong is said, and no map is written") {
    struct Case {
        const char* words;
        const char* said;
    };
    for (const Case& c : {Case{"wrong-screen", "does not follow"},
                          {"frozen", "frozen"},
                          {"ambient=900", "dim the room"},
                          {"dark", "dark"},
                          {"saturated", "range"},
                          {"turn=0.3,after=70", "moved"}}) {
        INFO(std::string(c.words));
        const TemporaryDirectory folder;
        const Ran ran = scanned(folder, "--camera emulated:binning=4," + std::string(c.words) + " 2>&1");
        CHECK(ran.code == 3);
        CHECK_MESSAGE(ran.out.find(c.said) != std::string::npos, ran.out);
        CHECK_FALSE(std::filesystem::exists(folder / "map.yml.gz"));
    }
    const TemporaryDirectory folder;
    const Ran unknown = scanned(folder, "--camera emulated:bord=3 2>&1");
    CHECK(unknown.code == 1);
    CHECK(unknown.out.find("\"bord=3\"") != std::string::npos);
}
