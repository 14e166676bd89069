// A live scan on a scripted show and camera: that its pictures are proved, and that each fault is named.
#include <doctest/doctest.h>

#include <cmath>

#include "devices/scan/core_show.h"
#include "devices/scan/pair_proof.h"
#include "tests/devices/scan/scripted_rig.h"

using namespace ilf;
using namespace ilf::devices;
using ilf::test::captured;
using ilf::test::Script;
using ilf::test::ScriptedScene;

namespace {

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

/// Rms distance on the raster of decoded pixels from the scene's truth, and the share that is farther off than 2.
struct OffTruth {
    double rms = 0.0, beyond = 0.0;
    int pixels = 0;
};
OffTruth offTruth(const DecodedScan& decoded) {
    OffTruth off;
    double squares = 0.0;
    int near = 0;
    const auto& map = decoded.projectorOfCamera;
    for (int y = 0; y < map.height(); ++y) {
        for (int x = 0; x < map.width(); ++x) {
            if (!std::isfinite(map.at(x, y, 0))) continue;
            ++off.pixels;
            const auto truth = ScriptedScene::scene(false).truth(x + 0.5, y + 0.5);
            const double away = truth ? std::hypot(static_cast<double>(map.at(x, y, 0)) - truth->projector[0],
                                                   static_cast<double>(map.at(x, y, 1)) - truth->projector[1])
                                      : 1e9;
            if (away > 2.0) continue;
            squares += away * away;
            ++near;
        }
    }
    off.rms = std::sqrt(squares / std::max(near, 1));
    off.beyond = 1.0 - static_cast<double>(near) / std::max(off.pixels, 1);
    return off;
}

void checkSafe(const Script& script) {
    CHECK(script.safe);
    CHECK(script.safeLights == 1);
}

}  // namespace

TEST_CASE("a scan's pictures decode to where light truly lands, within a fifth of a pixel") {
    Script script;
    const auto scan = captured(script);
    REQUIRE_MESSAGE(scan, scan.error().what);
    CHECK(scan->scan.patterns == grayCodePatterns(ScriptedScene::kRaster));
    REQUIRE(scan->scan.pictures.size() == scan->scan.patterns.size());
    CHECK(scan->late == 0);
    CHECK(scan->repeated == 0);
    CHECK(scan->remarks.empty());
    CHECK(scan->mode.device == "scripted");
    CHECK(script.locked);
    CHECK(scan->ambient.go);
    const double sweeps = scan->exposure.si() * 60.0;
    CHECK(sweeps == doctest::Approx(std::round(sweeps)));
    const auto decoded = decodedScan(scan->scan);
    REQUIRE_MESSAGE(decoded, decoded.error().what);
    const OffTruth off = offTruth(*decoded);
    MESSAGE(off.pixels, " pixels, ", off.rms, " px rms, beyond 2 px: ", off.beyond);
    CHECK(off.pixels > 15000);
    CHECK(off.rms <= 0.2);
    CHECK(off.beyond < 0.01);
    checkSafe(script);
}

TEST_CASE("a camera that is 1 to 6 frames behind is waited for, and its pictures are the same") {
    Script plain;
    const auto straight = captured(plain);
    REQUIRE(straight);
    for (int delay = 1; delay <= 6; ++delay) {
        CAPTURE(delay);
        Script script;
        script.delay = delay;
        const auto scan = captured(script);
        REQUIRE_MESSAGE(scan, scan.error().what);
        CHECK(scan->late >= delay);
        CHECK(scan->late <= delay + 1);
        for (std::size_t i = 0; i < scan->scan.pictures.size(); ++i)
            CHECK(meanDifference(scan->scan.pictures[i], straight->scan.pictures[i]) < 4.0);
        checkSafe(script);
    }
}

TEST_CASE("how late a camera is does not depend on how soon after first light its frames came while that was found") {
    Script script;
    script.delay = 6;
    script.period = 0.008_s;  // so that some come just when black is all that they can have seen
    script.slowShowFrom = 8;
    const auto scan = captured(script);
    REQUIRE_MESSAGE(scan, scan.error().what);
    CHECK(scan->late == 6);
    CHECK(scan->repeated == 0);
    const auto decoded = decodedScan(scan->scan);
    REQUIRE(decoded);
    CHECK(offTruth(*decoded).rms <= 0.2);
}

TEST_CASE("a camera that falls behind while it scans is noticed by its pairs, and they are taken again") {
    Script script;
    script.delay = 2;
    script.delayFrom = 45;
    const auto scan = captured(script);
    REQUIRE_MESSAGE(scan, scan.error().what);
    CHECK(scan->repeated > 0);
    const auto decoded = decodedScan(scan->scan);
    REQUIRE(decoded);
    CHECK(offTruth(*decoded).rms <= 0.2);
    checkSafe(script);
}

TEST_CASE("frames that come twice are passed over") {
    Script script;
    script.repeatEvery = 3;
    const auto scan = captured(script);
    REQUIRE_MESSAGE(scan, scan.error().what);
    const auto decoded = decodedScan(scan->scan);
    REQUIRE(decoded);
    CHECK(offTruth(*decoded).rms <= 0.2);
}

TEST_CASE("each fault is named, and light ends safe") {
    struct Case {
        const char* name;
        std::function<void(Script&)> let;
        const char* said;
    };
    const Case cases[] = {
        {"far behind", [](Script& s) { s.delay = 12; }, "previous frames"},
        {"far behind later", [](Script& s) { s.delay = 12, s.delayFrom = 45; }, "previous frames again"},
        {"frozen", [](Script& s) { s.frozenFrom = 3; }, "frozen"},
        {"frozen later", [](Script& s) { s.frozenFrom = 45; }, "frozen"},
        {"bumped", [](Script& s) { s.movedFrom = 45; }, "Something moved"},
        {"another screen", [](Script& s) { s.wrongScreenFrom = 0; }, "does not follow"},
        {"unplugged", [](Script& s) { s.lostFrom = 45; }, "gives no pictures any more"},
        {"dim", [](Script& s) { s.aperture = 2e-4; }, "above black"},
        {"dark", [](Script& s) { s.aperture = 2e-6; }, "too dark"},
        {"dark and grainy", [](Script& s) { s.aperture = 2e-6, s.grain = 12.0; }, "too dark"},
        {"bright room", [](Script& s) { s.ambientLux = 900.0; }, "of the light is the projector's"},
        {"saturated", [](Script& s) { s.aperture = 200.0; }, "range"},
    };
    for (const Case& c : cases) {
        INFO(std::string(c.name));
        Script script;
        c.let(script);
        const auto scan = captured(script);
        REQUIRE_FALSE(scan.has_value());
        CHECK_MESSAGE(contains(scan.error().what, c.said), scan.error().what);
        checkSafe(script);
    }
}

TEST_CASE("too much and too little light is made up for by an exposure of other whole sweeps") {
    for (const double aperture : {0.06, 1.6}) {
        Script script;
        script.aperture = aperture;
        const auto scan = captured(script);
        REQUIRE_MESSAGE(scan, scan.error().what);
        const double sweeps = scan->exposure.si() * 60.0;
        CHECK(sweeps == doctest::Approx(std::round(sweeps)));
        CHECK((aperture > 1.0 ? sweeps < 1.5 : sweeps > 2.5));
    }
}

TEST_CASE("a camera whose exposure cannot be set goes on, and says what it may cost") {
    Script script;
    script.setsExposure = false;
    const auto scan = captured(script);
    REQUIRE_MESSAGE(scan, scan.error().what);
    REQUIRE(scan->remarks.size() == 1);
    CHECK(contains(scan->remarks.front(), "whole sweeps"));
}

TEST_CASE("a scan that is cancelled ends at once, in safe light") {
    for (const int when : {2, 35, 50}) {
        Script script;
        std::stop_source stop;
        script.onFrame = [&](int number) {
            if (number == when) stop.request_stop();
        };
        const auto scan = captured(script, {}, stop.get_token());
        REQUIRE_FALSE(scan.has_value());
        CHECK(contains(scan.error().what, "cancelled"));
        CHECK(script.frames <= when + 2);
        checkSafe(script);
    }
}

TEST_CASE("a pair is a pattern and its inverse, nothing else") {
    const auto grey = [](std::vector<std::uint8_t> codes) { return Image<std::uint8_t>({4, 1}, 1, std::move(codes)); };
    const auto white = grey({200, 200, 200, 20}), black = grey({10, 10, 10, 18});
    CHECK(pairProof(white, black, grey({200, 10, 200, 19}), grey({10, 200, 10, 19})).holds());
    CHECK(pairProof(white, black, grey({200, 10, 200, 0}), grey({10, 200, 10, 0})).lit == doctest::Approx(0.75));
    CHECK_FALSE(pairProof(white, black, grey({200, 10, 200, 0}), grey({200, 10, 10, 0})).holds());
    // Stripes too fine for the camera say nothing.
    CHECK(pairProof(white, black, grey({105, 105, 105, 0}), grey({105, 105, 105, 0})).holds());
    CHECK_FALSE(pairProof(white, white, white, black).holds());
}

TEST_CASE("a pattern's program shows it in every slot with the lens at rest, and may reach light") {
    Rig rig;
    const auto program = restingProgram(rig, 0.5_D, patternPicture({Pattern::Kind::column, 3, false}, rig.projector));
    CHECK(checked(program));
    CHECK(program.waveform.still());
    CHECK(program.waveform.low == 0.5_D);
    CHECK(program.slotRate == rig.slotRate);
    CHECK(program.imageOfSlot == std::vector<int>(16, 0));
    CHECK(checked(restingProgram(rig, 0.0_D, patternPicture({Pattern::Kind::black, 0, false}, rig.projector))));
}
