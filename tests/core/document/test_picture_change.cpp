// Another picture of the same camera: what is painted stays on its things, as far as it can be told where they are.
#include "core/document/picture_change.h"

#include <cmath>

#include "core/document/history.h"
#include "tests/core/document/scenes.h"
#include "tests/support/law.h"

namespace ilf {
namespace {

constexpr Size kSensor{320, 240};

CameraMode modeOf(int x0, int y0, int binning, Size picture) { return {"camera 1", kSensor, x0, y0, binning, picture}; }
CameraMode whole(int binning = 1) { return modeOf(0, 0, binning, {320 / binning, 240 / binning}); }

Scene sceneIn(const CameraMode& mode) {
    Scene scene = sceneOf(mode.picture);
    scene.source = mode.device;
    scene.camera = mode;
    scene.scale = {300.0 / mode.binning, PixelScale::Source::typed};
    return scene;
}

Point<CameraFrame> in(const CameraMode& mode, double x, double y) {
    return {(x - mode.x0) / mode.binning, (y - mode.y0) / mode.binning};
}
/// A rectangle of the sensor's, in a picture.
Rectangle rectangleIn(const CameraMode& mode, double x0, double y0, double x1, double y1) {
    return {in(mode, x0, y0), in(mode, x1, y1)};
}

Document painted(const CameraMode& mode, const Shape& shape) {
    Document document = newDocument(sceneIn(mode));
    document = *edited(document, AddRegion{regionOf("a", "Face", Look::blur, 0.5_m), 0});
    return *edited(document, FillShape{"a", shape});
}

/// Area and middle of the coverage, on the sensor.
struct Lies {
    double area = 0.0, x = 0.0, y = 0.0;
};
Lies lies(const Mask& mask, const CameraMode& mode) {
    Lies sum;
    for (int y = 0; y < mask.size().height; ++y) {
        for (int x = 0; x < mask.size().width; ++x) {
            const double v = mask.at(x, y);
            sum.area += v;
            sum.x += v * (mode.x0 + (x + 0.5) * mode.binning);
            sum.y += v * (mode.y0 + (y + 0.5) * mode.binning);
        }
    }
    return {sum.area * mode.binning * mode.binning / 255.0, sum.x / sum.area, sum.y / sum.area};
}

Document grabbedIn(const Document& document, const CameraMode& mode) {
    Scene next = sceneOf(mode.picture);
    next.source = mode.device;
    next.camera = mode;
    const auto after = edited(document, SetScene{carriedOver(document, next)});
    REQUIRE_MESSAGE(after.has_value(), (after ? std::string() : after.error().what));
    return *after;
}

std::string refusal(const Document& document, Scene next) {
    const auto after = edited(document, SetScene{std::move(next)});
    return after ? "" : after.error().what;
}

}  // namespace

TEST_CASE("picture change: in another part or binning of the sensor, paint lies on the same thing, and back again") {
    law("area and middle of the paint stay on the sensor", [] {
        const auto anyMode = [] {
            const int binning = *rc::gen::element(1, 2, 4);
            // Both show the middle of the sensor, where the paint is.
            const int x0 = *rc::gen::inRange(0, 20) * 4, y0 = *rc::gen::inRange(0, 15) * 4;
            return modeOf(x0, y0, binning,
                          {(*rc::gen::inRange(240, 320) / 4 * 4 - x0) / binning,
                           (*rc::gen::inRange(180, 240) / 4 * 4 - y0) / binning});
        };
        const CameraMode first = anyMode(), second = anyMode();
        const double x = *rc::gen::inRange(100, 150), y = *rc::gen::inRange(80, 110);
        const double width = *rc::gen::inRange(20, 70), height = *rc::gen::inRange(20, 50);
        const Shape shape = *rc::gen::arbitrary<bool>()
                                ? Shape(rectangleIn(first, x, y, x + width, y + height))
                                : Shape(Ellipse{in(first, x, y), in(first, x + width, y + height)});
        const Document before = painted(first, shape);
        const Document after = grabbedIn(before, second);
        const Lies was = lies(before.regions[0]->mask, first), is = lies(after.regions[0]->mask, second);
        RC_ASSERT(after.regions[0]->mask.size() == second.picture);
        RC_ASSERT(std::abs(is.area - was.area) < 0.01 * was.area);
        RC_ASSERT(std::hypot(is.x - was.x, is.y - was.y) < 0.05 * std::max(first.binning, second.binning));
        const Lies back = lies(grabbedIn(after, first).regions[0]->mask, first);
        RC_ASSERT(std::abs(back.area - was.area) < 0.01 * was.area);
        RC_ASSERT(std::hypot(back.x - was.x, back.y - was.y) < 0.05 * std::max(first.binning, second.binning));
    });
    law("a part of the sensor that shows all of it gives the very paint back", [] {
        const Document before = painted(whole(), Ellipse{{90.0 + *rc::gen::inRange(0, 30), 70.3}, {211.4, 160.0}});
        const CameraMode part = modeOf(*rc::gen::inRange(0, 80), *rc::gen::inRange(0, 60), 1, {220, 160});
        RC_ASSERT(grabbedIn(grabbedIn(before, part), whole()).regions[0]->mask == before.regions[0]->mask);
    });
}

TEST_CASE("picture change: points of planes, outlines and flat things that are followed go along; undo takes it back") {
    Document document = painted(whole(), rectangleIn(whole(), 100, 80, 180, 160));
    const PlaneDistance plane{{{{{110, 90}, 1.0_m}, {{170, 95}, 0.8_m}, {{140, 150}, 1.2_m}}}};
    document = *edited(document, SetDistance{"a", plane});
    document = *edited(document, SetFollow{"a", Follow{PlanarTarget{{100, 80, 180, 160}}}});
    document = *edited(document, SetOutline{"a", Outline{{{100, 80}, {180, 80}, {140, 160}}}});
    const CameraMode part = modeOf(40, 20, 2, {120, 100});
    History history(document);
    history.preview(grabbedIn(document, part));
    history.commit("Grab");
    const Document after = history.current();
    const Region& region = *after.regions[0];
    CHECK(std::get<PlanarTarget>(region.follow->target).patch == PixelRect<CameraFrame>{30, 30, 70, 70});
    CHECK(region.outline->vertices[1] == Point<CameraFrame>{70, 30});
    CHECK(region.mask == rasterised(*region.outline, part.picture));
    CHECK(std::get<PlaneDistance>(region.distance).anchors[2].at == Point<CameraFrame>{50, 65});
    for (const auto& [x, y] : {std::pair{120.0, 90.0}, {150.0, 110.0}}) {
        const auto was = distanceAt(document, *document.regions[0], {x, y}),
                   is = distanceAt(after, region, in(part, x, y));
        REQUIRE((was && is));
        CHECK(is->si() == doctest::Approx(was->si()));
    }
    CHECK(after.scene.scale == PixelScale{150.0, PixelScale::Source::typed});
    // The camera's axis stays in the middle of the sensor.
    CHECK(cameraAxis(after) == in(part, 160, 120));
    history.undo();
    CHECK(history.current() == document);
    // What the part does not show cannot be followed.
    CHECK(refusal(document, sceneIn(modeOf(200, 0, 1, {100, 100}))) ==
          "What \"Face\" follows is not in this picture, or too small in it: let it follow nothing first, or take a "
          "picture that shows it.");
}

TEST_CASE("picture change: depth goes along with its camera, and nothing floats between near and far") {
    Document document = painted(whole(), rectangleIn(whole(), 100, 80, 180, 160));
    std::vector<float> metres, sigma;
    for (int y = 0; y < 240; ++y) {
        for (int x = 0; x < 320; ++x) {
            const bool far = x >= 151;
            metres.push_back(y == 30 ? 0.0F : far ? 2.0F : 0.5F + 0.0002F * static_cast<float>(x));
            sigma.push_back(far ? 0.01F : 0.001F);
        }
    }
    MeasuredDepth measured{{kSensor, 1, metres}, {kSensor, 1, sigma}, plainPinhole(kSensor, 300.0), 0.0_m, "scan", ""};
    measured.camera.distortion = {0.1, 0, 0, 0, 0};
    document = *edited(document, SetMeasuredDepth{Box(measured)});
    document = *edited(document, SetDistance{"a", FromDepthMap{}});
    for (const CameraMode& mode : {modeOf(40, 20, 2, {120, 100}), modeOf(41, 21, 1, {200, 180}), whole(4)}) {
        const Document after = grabbedIn(document, mode);
        REQUIRE(after.scene.measured);
        const MeasuredDepth& now = *after.scene.measured;
        CHECK(now.camera.fx == doctest::Approx(300.0 / mode.binning));
        CHECK(now.camera.cx == doctest::Approx((160.0 - mode.x0) / mode.binning));
        CHECK(now.camera.distortion == measured.camera.distortion);
        int holes = 0;
        for (int v = 0; v < mode.picture.height; ++v) {
            for (int u = 0; u < mode.picture.width; ++u) {
                const double x = mode.x0 + (u + 0.5) * mode.binning;
                const double is = now.metres.at(u, v), near = 0.5 + 0.0002 * (x - 0.5);
                if (is == 0.0) {
                    ++holes;
                } else {
                    CHECK(std::min(std::abs(is - near), std::abs(is - 2.0)) < 0.0005);
                    CHECK(now.sigma.at(u, v) == doctest::Approx(is > 1.0 ? 0.01 : 0.001));
                }
            }
        }
        CHECK(holes <= mode.picture.width);
        // And the distances of the region with it.
        const auto was = distanceAt(document, *document.regions[0], {130, 120}),
                   is = distanceAt(after, *after.regions[0], in(mode, 130, 120));
        REQUIRE((was && is));
        CHECK(is->si() == doctest::Approx(was->si()).epsilon(0.002));
    }
    // Growing again: still one of both surfaces.
    const Document back = grabbedIn(grabbedIn(document, whole(4)), whole());
    for (const float is : back.scene.measured->metres.pixels())
        CHECK((is == 0.0F || is < 0.55F || is > 1.95F));
}

TEST_CASE("picture change: what nobody can tell is refused in words, and nothing where nothing is painted") {
    const Document document = painted(whole(), rectangleIn(whole(), 100, 80, 180, 160));
    const auto says = [&](const Scene& next, const std::string& words) {
        const std::string said = refusal(document, next);
        CAPTURE(said);
        CHECK(said.find("The regions cannot go along to this picture: ") == 0);
        CHECK(said.find(words) != std::string::npos);
        CHECK(said.find("begin a new project") != std::string::npos);
        const Document bare = newDocument(document.scene);
        CHECK(refusal(bare, next).empty());
    };
    CameraMode unknown;
    unknown.device = "camera 1";
    unknown.picture = {160, 100};
    says(sceneIn(unknown), "how they are cut out of the sensor is not known");
    CameraMode other = whole(2);
    other.device = "camera 2";
    says(sceneIn(other), "\"camera 2\"");
    says(sceneIn(modeOf(200, 0, 2, {160, 120})), "does not fit on the sensor");
    Document ofFile = document;
    ofFile.scene.camera = {};
    ofFile.scene.source = "desk.png";
    CHECK(refusal(ofFile, sceneIn(whole(2))).find("(\"desk.png\") has 320 x 240 pixels") != std::string::npos);
    // A picture of no camera is stretched, one of the same size lies where the old one did.
    Scene file = sceneOf({160, 60});
    const auto stretched = edited(document, SetScene{file});
    REQUIRE(stretched);
    CHECK(stretched->regions[0]->mask == rasterised(Rectangle{{50, 20}, {90, 40}}, {160, 60}));
    other = whole();
    other.device = "camera 2";
    CHECK(edited(document, SetScene{sceneIn(other)})->regions[0].same(document.regions[0]));
}

TEST_CASE(
    "picture change: a scene from before modes were kept is of its registration's mode, if that is of its camera") {
    Document document = painted(whole(), rectangleIn(whole(), 100, 80, 180, 160));
    document.scene.camera = {};
    Registration made = *registered({});
    made.camera = whole();
    document.rig.registration = Box(made);
    CHECK(pictureMode(document) == whole());
    CHECK(lies(grabbedIn(document, whole(2)).regions[0]->mask, whole(2)).x == doctest::Approx(140.0));
    document.scene.source = "desk.png";
    CHECK(pictureMode(document) == CameraMode{});
    document.scene.camera = whole(2);  // of a picture that is no longer there
    CHECK(pictureMode(document) == CameraMode{});
}

}  // namespace ilf
