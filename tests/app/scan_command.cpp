// `scan` as operators call it, on devices that nobody has to own: against the emulated scene's truth, and with faults.
#include <doctest/doctest.h>

#include <filesystem>

#include "projects/map_file.h"
#include "tests/app/emulated/scanned.h"

using namespace ilf;

TEST_CASE("scan --rig simulated: the map is where light truly lands, and the pictures are kept") {
    const TemporaryDirectory folder;
    const Ran ran = scanned(folder, "--camera emulated:binning=2 --json --keep " + (folder / "kept"));
    checkMap(folder, ran);
    // Decoded again without the rig they give the same map.
    const Ran again = runProgram(ILF_STUDIO_PATH, "decode-scan " + (folder / "kept") + " -o " + (folder / "again.exr"));
    CHECK_MESSAGE(again.code == 0, again.out);
    const auto first = projects::readMap(folder / "map.yml.gz"), second = projects::readMap(folder / "again.exr");
    REQUIRE((first && second));
    const auto at = [](const auto& map) { return double(map->map.projectorOfCamera.at(320, 256, 0)); };
    CHECK(at(second) == doctest::Approx(at(first)).epsilon(1e-6));
}

TEST_CASE("scan: a folder that is there already is not written into, and is refused before anything is shown") {
    const TemporaryDirectory folder;
    const Ran ran = scanned(folder, "--camera emulated:binning=4 --keep " + folder.path() + " 2>&1");
    CHECK(ran.code == 1);
    CHECK_MESSAGE(ran.out.find("exists already") != std::string::npos, ran.out);
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
