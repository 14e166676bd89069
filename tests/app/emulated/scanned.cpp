#include "tests/app/emulated/scanned.h"

#include <doctest/doctest.h>

#include <nlohmann/json.hpp>

#include "projects/map_file.h"

namespace ilf {

Ran scanned(const TemporaryDirectory& folder, const std::string& options) {
    return runProgram(ILF_STUDIO_PATH, "scan -o " + (folder / "map.yml.gz") + " " + options,
                      "XDG_STATE_HOME=" + folder.path());
}

void checkMap(const TemporaryDirectory& folder, const Ran& ran) {
    REQUIRE_MESSAGE(ran.code == 0, ran.out);
    const nlohmann::json report = nlohmann::json::parse(ran.out);
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

}  // namespace ilf
