// `decode-scan` as operators call it: the real program, its files, words and exit codes.
#include <doctest/doctest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "projects/map_file.h"
#include "projects/scan_folder.h"
#include "tests/projects/folder.h"
#include "tests/support/run_program.h"
#include "tests/support/synthetic_scan.h"

using namespace ilf;

namespace {

Ran decodeScan(const std::string& arguments) { return readAsCalled(ILF_STUDIO_PATH, "decode-scan " + arguments); }
std::string inQuotes(const std::filesystem::path& path) { return "'" + path.string() + "'"; }
bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

SyntheticCamera desk() {
    SyntheticCamera at;
    at.look = [](double x, double y) { return std::array{0.46 * x + 0.02 * y + 3.0, 0.47 * y + 2.0}; };
    at.noise = 1.0;
    return at;
}

}  // namespace

TEST_CASE("decode-scan: a folder becomes a map of either kind, and a quality picture") {
    const Folder folder;
    REQUIRE(projects::writeScan(folder / "scan", scanned(desk())));
    for (const char* name : {"map.yml", "map.exr"}) {
        const Ran ran = decodeScan(inQuotes(folder / "scan") + " -o " + inQuotes(folder / name) + " --quality " +
                                   inQuotes(folder / "quality.png"));
        CHECK_MESSAGE(ran.code == 0, ran.out);
        CHECK(contains(ran.out, "Written, read back and checked"));
        const auto map = projects::readMap(folder / name);
        REQUIRE(map);
        const auto truth = desk().look(128.5, 96.5);
        CHECK(std::abs(double(map->map.projectorOfCamera.at(128, 96, 0)) - truth[0]) < 0.2);
        CHECK(map->facts.at("method") == "scan");
    }
    CHECK(std::filesystem::exists(folder / "quality.png"));
}

TEST_CASE("decode-scan: --json says the same for programs") {
    const Folder folder;
    REQUIRE(projects::writeScan(folder / "scan", scanned(desk())));
    const Ran ran = decodeScan(inQuotes(folder / "scan") + " -o " + inQuotes(folder / "map.yml") + " --json");
    REQUIRE_MESSAGE(ran.code == 0, ran.out);
    const auto json = nlohmann::json::parse(ran.out);
    CHECK(json["ok"] == true);
    CHECK(json["camera"] == nlohmann::json({256, 192}));
    CHECK(json["projector"] == nlohmann::json({128, 96}));
    CHECK(json["pixels"]["decoded"] > 40000);
    CHECK(json["check_columns"]["rms_px"] < 0.2);
    CHECK(json["findings"][0]["cause"] == "flat");
}

TEST_CASE("decode-scan: a bad scan names its cause, shows where, writes no map and exits with 1") {
    const Folder folder;
    Scan scan = scanned(desk());
    for (std::size_t i = scan.pictures.size() - 1; i > 0; --i)
        scan.pictures[i] = scan.pictures[i - 1];
    REQUIRE(projects::writeScan(folder / "scan", scan));
    const Ran ran = decodeScan(inQuotes(folder / "scan") + " -o " + inQuotes(folder / "map.yml") + " --quality " +
                               inQuotes(folder / "quality.png"));
    CHECK(ran.code == 1);
    CHECK(contains(ran.out, "failure: Each picture shows the pattern before its own"));
    CHECK(!std::filesystem::exists(folder / "map.yml"));
    CHECK(std::filesystem::exists(folder / "quality.png"));
}

TEST_CASE("decode-scan: usage is refused with 2, a missing folder and a disk that cannot be written with 1") {
    const Folder folder;
    REQUIRE(projects::writeScan(folder / "scan", scanned(desk())));
    const std::string scan = inQuotes(folder / "scan");
    CHECK(decodeScan(scan).code == 2);
    CHECK(decodeScan(scan + " -o " + inQuotes(folder / "map.png")).code == 2);
    CHECK(decodeScan(scan + " -o " + inQuotes(folder / "map.yml") + " --projector wide").code == 2);
    const Ran gone = decodeScan(inQuotes(folder / "gone") + " -o " + inQuotes(folder / "map.yml"));
    CHECK(gone.code == 1);
    CHECK(contains(gone.out, "is not a folder"));
    CHECK(decodeScan(scan + " -o " + inQuotes(folder / "no" / "folder" / "map.yml")).code == 1);
}
