// Every fault a scan can have, made in pictures of a camera that is known, is named for what it is.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>

#include "core/registration/scan_diagnosis.h"
#include "tests/support/synthetic_scan.h"

using namespace ilf;

namespace {

using enum ScanFault;
using Weight = ScanFinding::Weight;

/// A wall with dark squares on it, and a box before the wall.
SyntheticCamera room() {
    SyntheticCamera at;
    at.camera = {320, 240};
    at.projector = {256, 192};
    at.samples = 3;
    at.look = [](double x, double y) {
        return std::array{0.75 * x + 4.0 + (x > 180.0 && y > 120.0 ? 12.0 : 0.0) + 1e-4 * x * y, 0.76 * y + 5.0};
    };
    at.albedo = [](double x, double y) {
        const bool black = (static_cast<int>(x / 24.0) + static_cast<int>(y / 24.0)) % 2 == 0;
        return x > 20.0 && y > 20.0 && x < 170.0 && y < 220.0 && black ? 0.3 : 0.9;
    };
    at.noise = 1.0;
    return at;
}

ScanDiagnosis diagnosed(const Scan& scan) {
    const auto decoded = decodedScan(scan);
    REQUIRE(decoded);
    return scanDiagnosis(scan, *decoded);
}

const ScanFinding* find(const ScanDiagnosis& diagnosis, ScanFault fault) {
    const auto at = std::ranges::find(diagnosis.findings, fault, &ScanFinding::fault);
    return at == diagnosis.findings.end() ? nullptr : &*at;
}

/// What the operator reads first.
std::string first(const ScanDiagnosis& diagnosis) {
    return diagnosis.findings.empty() ? "" : word(diagnosis.findings.front().fault);
}

const Scan& goodScan() {
    static const Scan scan = scanned(room());
    return scan;
}

}  // namespace

TEST_CASE("diagnosis: a good scan has no cause, and says how good its light is") {
    const ScanDiagnosis diagnosis = diagnosed(goodScan());
    CHECK_MESSAGE(diagnosis.findings.empty(), first(diagnosis));
    CHECK(diagnosis.usable());
    CHECK(diagnosis.decodedShare > 0.95);
    CHECK(diagnosis.projectorShare > 0.8);
    CHECK(diagnosis.medianContrast > 100.0);
}

TEST_CASE("diagnosis: frames that come 1, 2 or 3 patterns late") {
    for (std::size_t lag = 1; lag <= 3; ++lag) {
        CAPTURE(lag);
        Scan scan = goodScan();
        for (std::size_t i = 0; i < scan.pictures.size(); ++i)
            scan.pictures[i] = goodScan().pictures[i < lag ? 0 : i - lag];  // white before the scan
        const ScanDiagnosis diagnosis = diagnosed(scan);
        CHECK(first(diagnosis) == "previous-frame");
        CHECK(!diagnosis.usable());
        CHECK(diagnosis.findings.front().what.find(
                  lag == 1 ? "the pattern before" : std::to_string(lag) + " patterns before") != std::string::npos);
    }
}

TEST_CASE("diagnosis: single frames that come twice") {
    Scan scan = goodScan();
    scan.pictures[9] = scan.pictures[8];
    const ScanDiagnosis diagnosis = diagnosed(scan);
    CHECK(first(diagnosis) == "previous-frame");
    CHECK(diagnosis.findings.front().what.find("pictures 8 and 9") != std::string::npos);
}

TEST_CASE("diagnosis: patterns in another order") {
    Scan scan = goodScan();
    std::rotate(scan.pictures.begin(), scan.pictures.begin() + 2, scan.pictures.end());  // white and black last
    const ScanDiagnosis diagnosis = diagnosed(scan);
    CHECK(first(diagnosis) == "other-order");
    CHECK(diagnosis.findings.front().what.find("white and black last") != std::string::npos);
    scan = goodScan();
    for (std::size_t i = 2; i < scan.pictures.size(); i += 2)
        std::swap(scan.pictures[i], scan.pictures[i + 1]);
    CHECK(first(diagnosed(scan)) == "other-order");
}

TEST_CASE("diagnosis: patterns on another screen, whatever else flickers") {
    SyntheticCamera at = room();
    at.light = 0.0;
    at.ambient = 90.0;
    at.noise = 2.0;
    CHECK(first(diagnosed(scanned(at))) == "wrong-screen");
    int n = 0;
    Scan flickering = scanned(at);
    for (auto& picture : flickering.pictures) {
        ++n;
        picture = changed(picture, [n](int v, int, int) { return v + 8.0 * std::sin(2.1 * n); });
    }
    CHECK(first(diagnosed(flickering)) == "wrong-screen");
}

TEST_CASE("diagnosis: no light at all, and too little") {
    SyntheticCamera at = room();
    at.light = 0.0;
    at.ambient = 3.0;
    CHECK(first(diagnosed(scanned(at))) == "too-dark");
    at.light = 9.0;
    CHECK(first(diagnosed(scanned(at))) == "too-dark");
}

TEST_CASE("diagnosis: more light than the sensor can tell, and where") {
    SyntheticCamera at = room();
    at.light = 700.0;
    const ScanDiagnosis all = diagnosed(scanned(at));
    CHECK(first(all) == "saturated");
    CHECK(!all.usable());
    at = room();
    const auto before = at.albedo;
    at.albedo = [before](double x, double y) { return x > 240.0 && y > 180.0 ? 4.0 : before(x, y); };
    const ScanDiagnosis corner = diagnosed(scanned(at));
    const ScanFinding* found = find(corner, saturated);
    REQUIRE(found != nullptr);
    CHECK(corner.usable());
    CHECK(found->area.x0 >= 235);
    CHECK(found->area.y0 >= 175);
}

TEST_CASE("diagnosis: a room brighter than the projector") {
    SyntheticCamera at = room();
    at.light = 40.0;
    at.ambient = 170.0;
    const ScanDiagnosis diagnosis = diagnosed(scanned(at));
    CHECK(first(diagnosis) == "ambient-light");
    at.ambient = 300.0;
    CHECK(first(diagnosed(scanned(at))) == "ambient-light");
}

TEST_CASE("diagnosis: a camera that moved, by how much and when") {
    SyntheticCamera at = room();
    Scan scan = goodScan();
    SyntheticCamera moved = at;
    moved.look = [at](double x, double y) { return at.look(x + 3.0, y - 1.0); };
    moved.albedo = [at](double x, double y) { return at.albedo(x + 3.0, y - 1.0); };
    const Scan after = scanned(moved);
    for (std::size_t i = 20; i < scan.pictures.size(); ++i)
        scan.pictures[i] = after.pictures[i];
    const ScanDiagnosis diagnosis = diagnosed(scan);
    const ScanFinding* found = find(diagnosis, ScanFault::moved);
    REQUIRE(found != nullptr);
    CHECK(found->weight == Weight::failure);
    CHECK(found->what.find("first near picture 20") != std::string::npos);
    CHECK(first(diagnosis) == "moved");
}

TEST_CASE("diagnosis: a hand that passed through a part of the picture") {
    Scan scan = goodScan();
    for (std::size_t i = 10; i < 18; ++i) {
        scan.pictures[i] = changed(scan.pictures[i], [](int v, int x, int y) {
            return x > 100 && x < 180 && y > 60 && y < 140 ? 60.0 : double(v);
        });
    }
    const ScanDiagnosis diagnosis = diagnosed(scan);
    const ScanFinding* found = find(diagnosis, moved);
    REQUIRE(found != nullptr);
    CHECK(found->area.x0 >= 80);
    CHECK(found->area.x1 <= 200);
    CHECK(found->what.find("in a part of the picture") != std::string::npos);
}

TEST_CASE("diagnosis: gloss shows two places of the raster at once") {
    SyntheticCamera at = room();
    at.second = 0.95;
    at.light = 80.0;
    const ScanDiagnosis diagnosis = diagnosed(scanned(at));
    const ScanFinding* found = find(diagnosis, glossy);
    REQUIRE_MESSAGE(found != nullptr, first(diagnosis));
    CHECK(found->what.find("gloss") != std::string::npos);
}

TEST_CASE("diagnosis: a plane is no fault, but noted for who wants to calibrate") {
    SyntheticCamera at = room();
    at.look = [](double x, double y) { return std::array{0.75 * x + 4.0, 0.76 * y + 5.0}; };
    const ScanDiagnosis diagnosis = diagnosed(scanned(at));
    CHECK(first(diagnosis) == "flat");
    CHECK(diagnosis.findings.front().weight == Weight::note);
    CHECK(diagnosis.usable());
}

TEST_CASE("diagnosis: light on a small part of the picture only") {
    SyntheticCamera at = room();
    at.look = [](double x, double y) { return std::array{5.0 * (x - 140.0), 5.0 * (y - 100.0)}; };
    const ScanDiagnosis diagnosis = diagnosed(scanned(at));
    CHECK(first(diagnosis) == "few-pixels");
    CHECK(!diagnosis.usable());
}

TEST_CASE("diagnosis: every cause has its own word") {
    std::set<std::string> words;
    for (int fault = 0; fault <= static_cast<int>(fewPixels); ++fault)
        words.insert(word(static_cast<ScanFault>(fault)));
    CHECK(words.size() == 10);
    CHECK(!words.contains(""));
}

TEST_CASE("quality map: each pixel has the colour of its state, and the legend has them all") {
    SyntheticCamera at = room();
    at.albedo = [](double x, double y) { return x < 80.0 ? 0.0 : x > 240.0 ? 4.0 : y > 0.0 ? 0.9 : 0.0; };
    const auto decoded = decodedScan(scanned(at));
    REQUIRE(decoded);
    const auto map = qualityMap(*decoded);
    REQUIRE(map.size() == at.camera);
    REQUIRE(map.channels() == 3);
    const auto colour = [&](int x, int y) { return std::array{map.at(x, y, 0), map.at(x, y, 1), map.at(x, y, 2)}; };
    const auto means = [&](const std::array<std::uint8_t, 3>& rgb) {
        for (const QualityColour& entry : qualityLegend()) {
            if (entry.rgb == rgb) return entry.words;
        }
        return std::string("between");
    };
    CHECK(means(colour(40, 100)).starts_with("black"));
    CHECK(means(colour(280, 100)).starts_with("yellow"));
    CHECK(colour(160, 100)[1] > colour(160, 100)[0]);
}
