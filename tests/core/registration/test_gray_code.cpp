// Patterns, the decoder and its map, on pictures of a camera that is known.
#include <algorithm>
#include <cmath>
#include <set>

#include "core/registration/gray_code.h"
#include "tests/support/law.h"
#include "tests/support/synthetic_scan.h"

using namespace ilf;

namespace {

std::array<double, 2> byHomography(const std::array<double, 9>& m, double x, double y) {
    const double w = m[6] * x + m[7] * y + m[8];
    return {(m[0] * x + m[1] * y + m[2]) / w, (m[3] * x + m[4] * y + m[5]) / w};
}

/// A projector turned a little against a camera, over most of its picture.
SyntheticCamera tilted() {
    SyntheticCamera at;
    at.look = [](double x, double y) {
        return byHomography({0.46, 0.02, 4.0, -0.015, 0.45, 5.0, 1e-4, -8e-5, 1.0}, x, y);
    };
    return at;
}

Scan withPicture(Scan scan, std::size_t n, const Image<std::uint8_t>& picture) {
    scan.pictures[n] = picture;
    return scan;
}

}  // namespace

TEST_CASE("patterns: white, black, then every bit beside its inverse, as many as the raster needs") {
    const auto patterns = grayCodePatterns({1024, 768});
    CHECK(patterns.size() == 42);
    CHECK(patterns[0].kind == Pattern::Kind::white);
    CHECK(patterns[1].kind == Pattern::Kind::black);
    for (std::size_t i = 2; i < patterns.size(); i += 2) {
        CHECK(!patterns[i].inverse);
        CHECK(patterns[i + 1] == Pattern{patterns[i].kind, patterns[i].bit, true});
    }
    CHECK(grayCodePatterns({912, 1140}).size() == 2 + 2 * (10 + 11));
}

TEST_CASE("patterns: neighbouring columns differ in one bit, no two columns share a code, inverses are inverse") {
    const Size raster{100, 60};
    std::vector<int> codes(static_cast<std::size_t>(raster.width), 0);
    for (const Pattern& pattern : grayCodePatterns(raster)) {
        const auto picture = patternPicture(pattern, raster);
        const auto other = patternPicture({pattern.kind, pattern.bit, !pattern.inverse}, raster);
        if (pattern.kind != Pattern::Kind::column) continue;
        for (int x = 0; x < raster.width; ++x) {
            CHECK(picture.at(x, 0) + other.at(x, 59) == 255);
            if (!pattern.inverse)
                codes[static_cast<std::size_t>(x)] = 2 * codes[static_cast<std::size_t>(x)] + picture.at(x, 7) / 255;
        }
    }
    for (std::size_t x = 1; x < codes.size(); ++x)
        CHECK(__builtin_popcount(static_cast<unsigned>(codes[x] ^ codes[x - 1])) == 1);
    CHECK(std::set<int>(codes.begin(), codes.end()).size() == codes.size());
}

TEST_CASE("patterns: a marker lights one quarter, each of the four another") {
    const Size raster{8, 6};
    std::vector<int> lit(48, 0);
    for (int quarter = 0; quarter < 4; ++quarter) {
        const auto picture = patternPicture({Pattern::Kind::marker, quarter, false}, raster);
        int count = 0;
        for (std::size_t n = 0; n < 48; ++n) {
            lit[n] += picture.pixels()[n] / 255;
            count += picture.pixels()[n] / 255;
        }
        CHECK(count == 12);
    }
    CHECK(lit == std::vector<int>(48, 1));
}

TEST_CASE(
    "decoder: the patterns themselves, as a camera would see them pixel for pixel, decode to their pixels' centres") {
    const Size raster{96, 64};
    Scan scan{raster, grayCodePatterns(raster), {}};
    for (const Pattern& pattern : scan.patterns)
        scan.pictures.push_back(changed(patternPicture(pattern, raster), [](int v, int, int) { return v * 0.7; }));
    const auto decoded = decodedScan(scan);
    REQUIRE(decoded);
    CHECK(decoded->count[0] == 96 * 64);
    double worst = 0.0;
    for (int y = 2; y < 62; ++y) {
        for (int x = 2; x < 94; ++x) {
            worst = std::max({worst, std::abs(double(decoded->projectorOfCamera.at(x, y, 0)) - x - 0.5),
                              std::abs(double(decoded->projectorOfCamera.at(x, y, 1)) - y - 0.5)});
        }
    }
    CHECK(worst < 0.01);
}

TEST_CASE("decoder: within 0.1 px (rms) of the truth for a camera by any homography, for four fifths of what is lit") {
    law("homographies", [] {
        const auto between = [](int low, int high) { return *rc::gen::inRange(low, high); };
        SyntheticCamera at;
        at.camera = {120, 90};
        at.projector = {64, 48};
        at.samples = 3;
        const std::array<double, 9> m{1e-3 * between(350, 550), 1e-3 * between(-40, 40),  0.1 * between(0, 50),
                                      1e-3 * between(-40, 40),  1e-3 * between(350, 550), 0.1 * between(0, 50),
                                      1e-5 * between(-20, 20),  1e-5 * between(-20, 20),  1.0};
        at.look = [m](double x, double y) { return byHomography(m, x, y); };
        const auto decoded = decodedScan(scanned(at));
        RC_ASSERT(decoded.has_value());
        int lit = 0;
        for (int j = 0; j < at.camera.height; ++j) {
            for (int i = 0; i < at.camera.width; ++i) {
                const auto [x, y] = at.look(i + 0.5, j + 0.5);
                lit += x >= 0.0 && y >= 0.0 && x < 64.0 && y < 48.0;
            }
        }
        const MapError error = errorOf(*decoded, at);
        RC_ASSERT(error.decoded >= lit * 4 / 5);
        RC_ASSERT(error.rms <= 0.1);
    });
}

TEST_CASE("decoder: a camera coarser than the finest stripes still finds its place, the finest bits left out") {
    SyntheticCamera at;
    at.camera = {120, 90};
    at.projector = {512, 384};
    at.look = [](double x, double y) { return std::array{4.1 * x + 5.0, 4.1 * y + 3.0}; };
    const auto decoded = decodedScan(scanned(at));
    REQUIRE(decoded);
    const MapError error = errorOf(*decoded, at);
    CHECK(error.decoded > 120 * 90 * 8 / 10);
    CHECK(error.rms < 1.0);  // a quarter of a camera pixel
}

TEST_CASE("decoder: noise of a twentieth of the light leaves the map within 0.2 px") {
    SyntheticCamera at = tilted();
    at.light = 60.0;
    at.noise = 3.0;
    const auto decoded = decodedScan(scanned(at));
    REQUIRE(decoded);
    const MapError error = errorOf(*decoded, at);
    CHECK(error.decoded > 256 * 192 * 9 / 10);
    CHECK(error.rms < 0.2);
}

TEST_CASE("decoder: shadow is dark, what ends the sensor's range saturated, and neither has a place") {
    SyntheticCamera at = tilted();
    at.albedo = [](double x, double y) { return x < 60.0 && y < 60.0 ? 0.0 : x > 200.0 && y > 140.0 ? 3.0 : 1.0; };
    at.noise = 1.0;
    const auto decoded = decodedScan(scanned(at));
    REQUIRE(decoded);
    CHECK(decoded->state.at(30, 30) == static_cast<std::uint8_t>(PixelState::dark));
    CHECK(decoded->state.at(230, 160) == static_cast<std::uint8_t>(PixelState::saturated));
    CHECK(std::isnan(decoded->projectorOfCamera.at(30, 30, 0)));
    CHECK(decoded->confidence.at(230, 160) == 0);
    CHECK(decoded->confidence.at(120, 100) > 200);
    int total = 0;
    for (const int count : decoded->count)
        total += count;
    CHECK(total == 256 * 192);
}

TEST_CASE("decoder: two surfaces keep their own places up to the step between them") {
    SyntheticCamera at;
    at.look = [](double x, double y) { return std::array{0.45 * x + (x < 128.0 ? 0.0 : 9.0), 0.45 * y + 4.0}; };
    const auto decoded = decodedScan(scanned(at));
    REQUIRE(decoded);
    const MapError error = errorOf(*decoded, at);
    CHECK(error.decoded > 256 * 192 * 95 / 100);
    CHECK(error.rms < 0.1);
    CHECK(error.worst < 1.0);
}

TEST_CASE("decoder: refuses scans that cannot be one, in words") {
    const Scan good = scanned(tilted());
    const auto sentence = [](const Scan& scan) {
        const auto decoded = decodedScan(scan);
        return decoded ? std::string() : decoded.error().what;
    };
    CHECK(sentence({}).find("0 pictures for 0 patterns") != std::string::npos);
    CHECK(
        sentence(withPicture(good, 5,
                             good.pictures[4].empty() ? Image<std::uint8_t>()
                                                      : Image<std::uint8_t>({9, 9}, 1, std::vector<std::uint8_t>(81))))
            .find("Picture 5 of the scan has 9 x 9 pixels, the first 256 x 192") != std::string::npos);
    CHECK(sentence(withPicture(good, 3, {})).find("not a grey picture") != std::string::npos);
    Scan scan = good;
    scan.patterns[7] = scan.patterns[6];
    CHECK(sentence(scan).find("lacks column bit 2 inverted") != std::string::npos);
    scan = good;
    scan.patterns[0] = scan.patterns[1];
    CHECK(sentence(scan).find("no picture of the projector all white") != std::string::npos);
    scan = good;
    scan.projector = {64, 64};
    CHECK(sentence(scan).find("check --projector") != std::string::npos);
    scan.projector = {0, 64};
    CHECK(sentence(scan).find("cannot be scanned") != std::string::npos);
}

TEST_CASE("map: there and back is where one started, wherever light is seen") {
    const SyntheticCamera at = tilted();
    const auto decoded = decodedScan(scanned(at));
    REQUIRE(decoded);
    const auto dense = denseMap(*decoded);
    REQUIRE(dense);
    const PixelMap map{Box<DenseMap>{*dense}};
    double worst = 0.0;
    int looked = 0;
    for (int y = 1; y + 1 < at.projector.height; ++y) {
        for (int x = 1; x + 1 < at.projector.width; ++x) {
            if (!map.seen(x, y)) continue;
            const auto there = map.toCamera({x + 0.5, y + 0.5});
            if (there.x < 3.0 || there.y < 3.0 || there.x > 253.0 || there.y > 189.0) continue;
            const auto back = map.toProjector(there);
            worst = std::max(worst, std::hypot(back.x - x - 0.5, back.y - y - 0.5));
            ++looked;
        }
    }
    CHECK(looked > 8000);
    CHECK(worst < 0.05);
    const auto truth = at.look(128.0, 96.0);
    const auto nearest = dense->nearest({128.0, 96.0});
    CHECK(std::hypot(nearest.x - truth[0], nearest.y - truth[1]) < 0.1);
}

TEST_CASE("map: holes are finite, continue what lies around, and say that they are guesses") {
    SyntheticCamera at = tilted();
    at.albedo = [](double x, double y) { return std::hypot(x - 128.0, y - 96.0) < 25.0 ? 0.0 : 1.0; };
    const auto decoded = decodedScan(scanned(at));
    REQUIRE(decoded);
    const auto map = denseMap(*decoded);
    REQUIRE(map);
    CHECK(map->confidence.at(128, 96) == 0);
    const auto truth = at.look(128.5, 96.5);
    CHECK(std::abs(double(map->projectorOfCamera.at(128, 96, 0)) - truth[0]) < 0.3);
    CHECK(std::abs(double(map->projectorOfCamera.at(128, 96, 1)) - truth[1]) < 0.3);
    CHECK(map->seen.at(static_cast<int>(truth[0]), static_cast<int>(truth[1])) == 0);
    CHECK(std::ranges::all_of(map->projectorOfCamera.pixels(), [](float v) { return std::isfinite(v); }));
    CHECK(std::ranges::all_of(map->cameraOfProjector.pixels(), [](float v) { return std::isfinite(v); }));
}

TEST_CASE("map: a pinhole that was not decoded is seen all the same, a shadow is not") {
    SyntheticCamera at = tilted();
    at.albedo = [](double x, double y) {
        const bool pinhole = std::abs(x - 60.5) < 2.0 && std::abs(y - 60.5) < 2.0;
        return pinhole || (x > 150.0 && x < 190.0 && y > 50.0 && y < 120.0) ? 0.0 : 1.0;
    };
    const auto map = denseMap(*decodedScan(scanned(at)));
    REQUIRE(map);
    const auto pinhole = at.look(60.5, 60.5), shadow = at.look(170.0, 80.0);
    CHECK(map->confidence.at(60, 60) == 0);
    CHECK(map->seen.at(static_cast<int>(pinhole[0]), static_cast<int>(pinhole[1])) == 255);
    CHECK(map->seen.at(static_cast<int>(shadow[0]), static_cast<int>(shadow[1])) == 0);
}

TEST_CASE("map: refused when hardly anything was decoded") {
    SyntheticCamera at = tilted();
    at.albedo = [](double x, double y) { return x < 25.0 && y < 25.0 ? 1.0 : 0.0; };
    const auto map = denseMap(*decodedScan(scanned(at)));
    REQUIRE(!map);
    CHECK(map.error().what.find("a map needs 1000") != std::string::npos);
}
