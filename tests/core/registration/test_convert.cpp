// A registration when the camera's mode changes, and as it ages.
#include <cmath>

#include "core/registration/convert.h"
#include "tests/support/law.h"
#include "tests/support/scanned_map.h"

namespace {

using namespace ilf;

const Homography<ProjectorFrame, CameraFrame> kPlane{{0.8, 0.03, 5, -0.02, 0.85, 3, 2e-5, -1e-5, 1}};
constexpr Size kRaster{120, 90};

Registration scanned(const CameraMode& mode) {
    Registration made = *registered(Box<DenseMap>(sampledMap(kPlane, mode.picture, kRaster)));
    made.camera = mode;
    return made;
}

CameraMode mode(int x0, int y0, int binning, Size picture) {
    return {"Camera 1", {320, 240}, x0, y0, binning, picture};
}

}  // namespace

TEST_CASE("convert: another part or binning of the same sensor puts every sensor point where it was on the raster") {
    law("a sensor point keeps its place", [] {
        const CameraMode before = mode(16, 8, 2, {140, 110});
        const int binning = *rc::gen::element(1, 2, 4);
        CameraMode now = mode(16 + 4 * *rc::gen::inRange(0, 20), 8 + 4 * *rc::gen::inRange(0, 15), binning, {});
        now.picture = {(16 + 280 - now.x0) / binning, (8 + 220 - now.y0) / binning};
        Registration plane = *registered(kPlane);
        plane.camera = before;
        for (const Registration& made : {plane, scanned(before)}) {
            const auto converted = convertedTo(made, now);
            RC_ASSERT(converted.has_value());
            RC_ASSERT(converted->camera == now);
            const double x = *rc::gen::inRange(now.x0 + 8, now.x0 + binning * now.picture.width - 8);
            const double y = *rc::gen::inRange(now.y0 + 8, now.y0 + binning * now.picture.height - 8);
            const auto in = [&](const CameraMode& m) {
                return Point<CameraFrame>{(x - m.x0) / m.binning, (y - m.y0) / m.binning};
            };
            const auto was = made.map.toProjector(in(before)), is = converted->map.toProjector(in(now));
            RC_ASSERT(std::hypot(was.x - is.x, was.y - is.y) < 0.01);
            const auto back = converted->map.toCamera(is);
            RC_ASSERT(std::hypot(back.x - in(now).x, back.y - in(now).y) < 0.02);
        }
    });
}

TEST_CASE("convert: raster pixels whose light lies beside the new picture are not seen any more") {
    const Registration made = scanned(mode(0, 0, 1, {320, 240}));
    const auto converted = convertedTo(made, mode(100, 60, 1, {64, 48})).value();
    const auto inside = made.map.toProjector({132, 84}), outside = made.map.toProjector({20, 20});
    CHECK(converted.map.seen(static_cast<int>(inside.x), static_cast<int>(inside.y)));
    CHECK(made.map.seen(static_cast<int>(outside.x), static_cast<int>(outside.y)));
    CHECK_FALSE(converted.map.seen(static_cast<int>(outside.x), static_cast<int>(outside.y)));
}

TEST_CASE("convert: a guess among binned pixels makes a guess of the whole") {
    Registration made = scanned(mode(0, 0, 1, {320, 240}));
    DenseMap map = *made.map.dense();
    std::vector<std::uint8_t> sure(map.confidence.pixels().begin(), map.confidence.pixels().end());
    sure[11 * 320 + 20] = 0;
    map.confidence = Image<std::uint8_t>({320, 240}, 1, std::move(sure));
    made.map = PixelMap(Box<DenseMap>(map));
    const auto converted = convertedTo(made, mode(0, 0, 2, {160, 120})).value();
    CHECK(converted.map.dense()->confidence.at(10, 5) == 0);
    CHECK(converted.map.dense()->confidence.at(11, 5) == 255);
    CHECK(converted.map.dense()->confidence.at(10, 6) == 255);
}

TEST_CASE("convert: the same mode, and a registration of no mode in particular, stay as they are") {
    const Registration made = scanned(mode(0, 0, 2, {160, 120}));
    CHECK(convertedTo(made, made.camera).value() == made);
    CHECK(convertedTo(*registered(kPlane), mode(0, 0, 1, {320, 240})).value() == *registered(kPlane));
}

TEST_CASE("convert: what cannot be predicted is refused in words") {
    const Registration made = scanned(mode(40, 40, 1, {160, 120}));
    const auto says = [&](const CameraMode& now, const std::string& words) {
        const auto converted = convertedTo(made, now);
        REQUIRE_FALSE(converted);
        CAPTURE(converted.error().what);
        CHECK(converted.error().what.find(words) != std::string::npos);
    };
    CameraMode other = made.camera;
    other.device = "Camera 2";
    says(other, "Camera 2");
    other = made.camera;
    other.sensor = {640, 480};
    says(other, "640 x 480");
    other = {"Camera 1", {}, 0, 0, 1, {80, 60}};
    says(other, "not known");
    says(mode(0, 0, 1, {320, 240}), "more of the sensor than was scanned");
    says(mode(300, 0, 1, {160, 120}), "does not fit");
    Registration plane = *registered(kPlane);
    plane.camera = made.camera;
    CHECK(convertedTo(plane, mode(0, 0, 1, {320, 240})));  // a homography goes on
}

TEST_CASE("convert: a registration says how old and how good it is") {
    Registration made = scanned(mode(0, 0, 1, {320, 240}));
    made.taken = "2026-03-01T12:00:00Z";
    made.rms_px = 0.214;
    made.worst_px = 12.4;
    made.points = 801234;
    made.provenance = "emulated";
    const auto later = [&](std::chrono::minutes by) { return *momentOf(made.taken) + by; };
    using namespace std::chrono_literals;
    CHECK(agedText(made, later(0min)) == "just now");
    CHECK(agedText(made, later(35min)) == "35 minutes ago");
    CHECK(agedText(made, later(5h)) == "5 hours ago");
    CHECK(agedText(made, later(24h * 3 + 2h)) == "3 days ago");
    CHECK(agedText(made, later(24h * 200)) == "6 months ago");
    CHECK(agedText(made, later(-10min)) == "in the future");
    CHECK(caption(made, later(72h)) ==
          "Scanned 3 days ago with Camera 1: 0.21 px rms, 12 px at worst, 801234 points (emulated)");
    made.taken = "yesterday";
    CHECK(agedText(made, {}) == "at an unknown time");
    CHECK(caption(*registered(kPlane), {}) == "Typed in");
    CHECK_FALSE(momentOf("2026-02-30T00:00:00Z"));
}
