// A picture grabbed in another mode of the camera: the registration goes along, or the picture is refused in words.
#include "app/studio/grabbed_rig.h"

#include <doctest/doctest.h>

using namespace ilf;

using app::rigForGrabbed;

namespace {

Rig registeredRig() {
    Registration made = *registered({{0.8, 0.01, 20, -0.02, 0.9, 10, 0, 0, 1}});
    made.method = Registration::Method::corners;
    made.camera = {"camera 1", {1280, 1024}, 0, 0, 1, {1280, 1024}};
    Rig rig;
    rig.registration = Box(made);
    return rig;
}

CameraMode mode(int x0, int y0, int binning, Size picture, const char* device = "camera 1") {
    return {device, {1280, 1024}, x0, y0, binning, picture};
}

}  // namespace

TEST_CASE("grabbed: in the mode it was registered in, the rig stays the same box") {
    const Rig rig = registeredRig();
    const auto same = rigForGrabbed(rig, mode(0, 0, 1, {1280, 1024}), {1280, 1024});
    REQUIRE(same);
    CHECK(same->registration.same(rig.registration));
    const Rig none;
    CHECK(rigForGrabbed(none, mode(0, 0, 2, {640, 512}), {640, 512}).value() == none);
}

TEST_CASE("grabbed: light lands on the same things in a part of the sensor, binned") {
    const Rig rig = registeredRig();
    const auto fitting = rigForGrabbed(rig, mode(200, 100, 2, {0, 0}), {400, 300});
    REQUIRE(fitting);
    CHECK(fitting->registration->camera == mode(200, 100, 2, {400, 300}));
    // Pixel (10, 20) of the new picture is sensor pixel (220, 140).
    const auto now = fitting->registration->map.toProjector({10, 20});
    const auto before = rig.registration->map.toProjector({220, 140});
    CHECK(now.x == doctest::Approx(before.x));
    CHECK(now.y == doctest::Approx(before.y));
    // And back again.
    const auto back = rigForGrabbed(*fitting, mode(0, 0, 1, {1280, 1024}), {1280, 1024});
    REQUIRE(back);
    CHECK(back->registration->map.toProjector({220, 140}).x == doctest::Approx(before.x));
}

TEST_CASE("grabbed: another camera, or a size that follows from nothing, is refused with what helps") {
    const Rig rig = registeredRig();
    const auto other = rigForGrabbed(rig, mode(0, 0, 1, {1280, 1024}, "camera 2"), {1280, 1024});
    REQUIRE(!other);
    CHECK(other.error().what.find("camera 2") != std::string::npos);
    CHECK(other.error().what.find("Register again") != std::string::npos);
    CameraMode unknown;
    unknown.device = "camera 1";
    const auto size = rigForGrabbed(rig, unknown, {800, 600});
    REQUIRE(!size);
    CHECK(size.error().what.find("800 x 600") != std::string::npos);
}
