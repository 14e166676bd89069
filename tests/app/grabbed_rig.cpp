// A picture grabbed in another mode of the camera: registration and paint go along, or the picture is refused in words.
#include "app/studio/grabbed_rig.h"

#include <cmath>

#include "app/studio/editor.h"
#include "tests/core/document/scenes.h"
#include "tests/support/law.h"

using namespace ilf;

using app::grabbed;
using app::rigForGrabbed;

namespace {

Rig registeredRig() {
    Registration made = *registered({{0.8, 0.01, 20, -0.02, 0.9, 10, 0, 0, 1}});
    made.method = Registration::Method::corners;
    made.camera = {"camera 1", {1280, 1024}, 0, 0, 1, {1280, 1024}};
    Rig rig;
    rig.registration = Box(made);
    ProcamCalibration calibration;
    calibration.camera = {{1280, 1024}, 1000.0, 1010.0, 650.0, 500.0, {0.1, 0, 0, 0, 0}};
    calibration.projector = plainPinhole(rig.projector, 900.0);
    rig.calibration = Box(calibration);
    return rig;
}

CameraMode mode(int x0, int y0, int binning, Size picture, const char* device = "camera 1") {
    return {device, {1280, 1024}, x0, y0, binning, picture};
}

Scene pictureIn(const CameraMode& mode) {
    Scene scene = sceneOf(mode.picture);
    scene.source = mode.device;
    scene.camera = mode;
    return scene;
}

/// Painted in the whole picture of the sensor, which the rig is registered with.
Document paintedDocument() {
    Document document = newDocument(pictureIn(mode(0, 0, 1, {1280, 1024})));
    document.rig = registeredRig();
    document = *edited(document, AddRegion{regionOf("a", "Face", Look::blur, 0.5_m), 0});
    return *edited(document, FillShape{"a", Rectangle{{400, 300}, {600, 500}}});
}

Document after(Document document, const app::Grab& grab) {
    for (const Edit& edit : grab.edits)
        document = *edited(document, edit);
    return document;
}

}  // namespace

TEST_CASE("grabbed: in the mode it was registered in, the rig stays the same box") {
    const Rig rig = registeredRig();
    const auto same = rigForGrabbed(rig, mode(0, 0, 1, {1280, 1024}));
    REQUIRE(same);
    CHECK(same->registration.same(rig.registration));
    CHECK(same->calibration.same(rig.calibration));
    const Rig none;
    CHECK(rigForGrabbed(none, mode(0, 0, 2, {640, 512})).value() == none);
}

TEST_CASE("grabbed: light lands on the same things in a part of the sensor, binned") {
    const Rig rig = registeredRig();
    const auto fitting = rigForGrabbed(rig, mode(200, 100, 2, {400, 300}));
    REQUIRE(fitting);
    CHECK(fitting->registration->camera == mode(200, 100, 2, {400, 300}));
    // Pixel (10, 20) of the new picture is sensor pixel (220, 140).
    const auto now = fitting->registration->map.toProjector({10, 20});
    const auto before = rig.registration->map.toProjector({220, 140});
    CHECK(now.x == doctest::Approx(before.x));
    CHECK(now.y == doctest::Approx(before.y));
    // The calibrated camera sees the same ray there.
    const auto ray = fitting->calibration->camera.slopesOf(10, 20), was = rig.calibration->camera.slopesOf(220, 140);
    CHECK(ray[0] == doctest::Approx(was[0]));
    CHECK(ray[1] == doctest::Approx(was[1]));
    CHECK(fitting->calibration->camera.size == Size{400, 300});
    // And back again.
    const auto back = rigForGrabbed(*fitting, mode(0, 0, 1, {1280, 1024}));
    REQUIRE(back);
    CHECK(back->registration->map.toProjector({220, 140}).x == doctest::Approx(before.x));
    CHECK(back->calibration->camera.cx == doctest::Approx(650.0));
}

TEST_CASE("grabbed: what is painted gets its light from the same projector pixels, whatever the camera's mode") {
    const Document before = paintedDocument();
    const auto light = [](const Document& document) {
        const Mask& mask = document.regions[0]->mask;
        PixelRect<CameraFrame> box;
        for (int y = 0; y < mask.size().height; ++y) {
            for (int x = 0; x < mask.size().width; ++x) {
                if (mask.at(x, y) > 0) box = box.united({x, y, x + 1, y + 1});
            }
        }
        const auto a = pixelMap(document).toProjector({1.0 * box.x0, 1.0 * box.y0});
        const auto b = pixelMap(document).toProjector({1.0 * box.x1, 1.0 * box.y1});
        return std::array{a.x, a.y, b.x, b.y};
    };
    const auto was = light(before);
    law("light stays on the thing", [&] {
        const int binning = *rc::gen::element(1, 2, 4);
        const int x0 = *rc::gen::inRange(0, 90) * 4, y0 = *rc::gen::inRange(0, 70) * 4;
        const CameraMode part = mode(x0, y0, binning, {640 / binning, 512 / binning});
        const auto grab = grabbed(before, pictureIn(part));
        RC_ASSERT(grab.has_value());
        const auto is = light(after(before, *grab));
        for (std::size_t i = 0; i < is.size(); ++i)
            RC_ASSERT(std::abs(is[i] - was[i]) < 0.01);
    });
}

TEST_CASE("grabbed: one gesture, which undo takes back; what the picture does not show is named") {
    app::Editor editor(paintedDocument());
    const Document before = editor.document();
    const auto grab = grabbed(before, pictureIn(mode(200, 100, 2, {400, 300})));
    REQUIRE(grab);
    REQUIRE(grab->edits.size() == 2);
    CHECK(grab->note.find("went along") != std::string::npos);
    CHECK(grab->note.find("shows nothing") == std::string::npos);
    for (const Edit& edit : grab->edits)
        REQUIRE(editor.handle({ui::EditRequest::When::preview, edit}));
    editor.commitGesture("Grab");
    CHECK(editor.document().regions[0]->mask == rasterised(Rectangle{{100, 100}, {200, 200}}, {400, 300}));
    editor.undo();
    CHECK(editor.document() == before);
    const auto aside = grabbed(before, pictureIn(mode(700, 100, 1, {400, 300})));
    REQUIRE(aside);
    CHECK(aside->note.find("The picture shows nothing of \"Face\": undo brings the paint back.") != std::string::npos);
    // The same mode again: nothing to say.
    const auto again = grabbed(before, pictureIn(mode(0, 0, 1, {1280, 1024})));
    REQUIRE(again);
    CHECK(again->edits.size() == 1);
    CHECK(again->note.empty());
    CHECK(after(before, *again).regions[0].same(before.regions[0]));
}

TEST_CASE("grabbed: another camera, or a size that follows from nothing, is refused with what helps") {
    const Rig rig = registeredRig();
    const auto other = rigForGrabbed(rig, mode(0, 0, 1, {1280, 1024}, "camera 2"));
    REQUIRE(!other);
    CHECK(other.error().what.find("camera 2") != std::string::npos);
    CHECK(other.error().what.find("Register again") != std::string::npos);
    CameraMode unknown;
    unknown.device = "camera 1";
    unknown.picture = {800, 600};
    const auto size = rigForGrabbed(rig, unknown);
    REQUIRE(!size);
    CHECK(size.error().what.find("800 x 600") != std::string::npos);
    // Without a registration it is the paint that cannot go along.
    Document document = paintedDocument();
    document.rig = {};
    const auto paint = grabbed(document, pictureIn(unknown));
    REQUIRE(!paint);
    CHECK(paint.error().what.find("The regions cannot go along to this picture") != std::string::npos);
    // A video's or file's picture is of no camera: the rig stays as it is.
    document = paintedDocument();
    const auto file = grabbed(document, sceneOf({1280, 1024}));
    REQUIRE(file);
    CHECK(file->edits.size() == 1);
}
