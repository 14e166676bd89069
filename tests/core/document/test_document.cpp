// What a document says about itself: who takes part, where a pixel lands, how far a surface is.
#include "core/document/document.h"

#include <cmath>

#include "scenes.h"
#include "tests/support/law.h"

namespace ilf {

namespace {

std::string names(const Document& document) {
    std::string all;
    for (const Region* region : activeRegions(document))
        all += region->name + " ";
    return all;
}

Document with(Document document, std::initializer_list<Edit> edits) {
    for (const Edit& edit : edits) {
        auto next = edited(std::move(document), edit);
        REQUIRE_MESSAGE(next.has_value(), next.error().what);
        document = *std::move(next);
    }
    return document;
}

/// A desk: 0.4 m at the bottom row's left end, 0.8 m at the top.
const PlaneDistance kDesk{{{{{0.0, 200.0}, 0.4_m}, {{320.0, 200.0}, 0.4_m}, {{160.0, 0.0}, 0.8_m}}}};

}  // namespace

TEST_CASE("document: a new one has a neutral background at 2 m and spans 60 degrees") {
    const Document document = newDocument(sceneOf({1280, 800}));
    CHECK(document.regions.empty());
    CHECK(document.background->id == kBackgroundId);
    CHECK(document.background->look == Look::neutral);
    CHECK(std::get<ConstantDistance>(document.background->distance).value == 2.0_m);
    CHECK(document.scene.scale.source == PixelScale::Source::assumed);
    CHECK(document.scene.scale.focalPixels == doctest::Approx(1108.5125168));  // 640 / tan 30 degrees
    Scene scaled = sceneOf({64, 64});
    scaled.scale = {500.0, PixelScale::Source::exif};
    CHECK(newDocument(scaled).scene.scale == scaled.scale);
}

TEST_CASE("document: field of view and focal length are each other's way back") {
    law("fieldOfView(w, focalPixels(w, d)) == d", [] {
        const int width = *rc::gen::inRange(1, 10000);
        const double degrees = *rc::gen::inRange(1, 1790) / 10.0;
        RC_ASSERT(std::abs(fieldOfView(width, focalPixels(width, degrees)) - degrees) < 1e-9);
    });
}

TEST_CASE("document: hidden regions do not take part, and solo leaves only the soloed ones") {
    const Document document = twoRegions();
    CHECK(names(document) == "Face Hands ");
    CHECK(names(with(document, {SetVisible{"a", false}})) == "Hands ");
    CHECK(names(with(document, {SetSolo{"b", true}})) == "Hands ");
    CHECK(names(with(document, {SetSolo{"b", true}, SetVisible{"b", false}})) == "Face ");
}

TEST_CASE("document: without a registration the picture is fitted into the raster, centred") {
    Document document = twoRegions();  // 320 x 200 into 1024 x 768: 3.2 times, 64 rows above and below
    const auto fitted = pixelMap(document).nearest();
    CHECK(fitted({0.0, 0.0}) == Point<ProjectorFrame>{0.0, 64.0});
    CHECK(fitted({320.0, 200.0}) == Point<ProjectorFrame>{1024.0, 704.0});
    document.rig.registration = registered(Homography<ProjectorFrame, CameraFrame>{{2, 0, 1, 0, 2, 3, 0, 0, 1}});
    CHECK(pixelMap(document).toProjector({1.0, 1.0}) == Point<ProjectorFrame>{3.0, 5.0});
}

TEST_CASE("document: the eyes' optical centres lie farther apart the nearer the surface") {
    Document document = twoRegions();
    document.scene.scale.focalPixels = 1000.0;
    // f_px / (d + d_Ee) = 1000 / 0.52 pixels a metre; 63 mm are 121.15 of them.
    CHECK(pixelsPerMetre(document, 0.5_m) == doctest::Approx(1000.0 / 0.52));
    const auto apart = [&](Metre d) {
        return opticalCentre(document, Eye::right, d).x - opticalCentre(document, Eye::left, d).x;
    };
    CHECK(apart(0.5_m) == doctest::Approx(63.0 / 0.52));
    CHECK(apart(0.25_m) > apart(0.5_m));
    const auto left = opticalCentre(document, Eye::left, 0.5_m);
    CHECK(left.x == doctest::Approx(160.0 - 31.5 / 0.52));
    CHECK(left.y == doctest::Approx(100.0));
}

TEST_CASE("distance: a constant lies within its tolerance, whatever is painted") {
    const Document document = with(twoRegions(), {SetDistance{"a", ConstantDistance{0.5_m, 0.1_m}}});
    const auto range = distanceRange(document, *findRegion(document, "a"));
    REQUIRE(range);
    CHECK(range->nearest.si() == doctest::Approx(0.4));
    CHECK(range->farthest.si() == doctest::Approx(0.6));
    CHECK(*distanceAt(document, *findRegion(document, "a"), {3.0, 3.0}) == 0.5_m);
}

TEST_CASE("distance: a plane's vergence is affine and meets its anchors") {
    law("any three anchors that are not on one line", [] {
        PlaneDistance plane;
        for (DistanceAnchor& anchor : plane.anchors) {
            anchor = {anyPoint(), Metre::fromSi(*rc::gen::inRange(20, 300) / 100.0)};
        }
        Region region;
        region.distance = plane;
        const auto vergence = affineVergence(region);
        RC_PRE(vergence.has_value());
        for (const DistanceAnchor& anchor : plane.anchors) {
            const double expected = 1.0 / anchor.distance.si();
            // The thinnest triangle let through is half a pixel high; its slopes are steep.
            RC_ASSERT(std::abs((**vergence)(anchor.at.x, anchor.at.y) - expected) < 1e-9);
        }
    });
}

TEST_CASE("distance: a plane's range is that of the pixels where the region is seen") {
    Document document =
        with(twoRegions(), {SetDistance{"b", kDesk}, FillShape{"b", Rectangle{{10.0, 20.0}, {200.0, 150.0}}}});
    const Region& desk = *findRegion(document, "b");
    const auto vergence = **affineVergence(desk);
    auto range = distanceRange(document, desk);
    REQUIRE(range);
    CHECK(range->nearest.si() == doctest::Approx(1.0 / vergence(10.5, 149.5)));
    CHECK(range->farthest.si() == doctest::Approx(1.0 / vergence(10.5, 20.5)));

    // "Face" above it hides the near half; what is hidden no longer counts.
    document = with(document, {FillShape{"a", Rectangle{{0.0, 100.0}, {320.0, 200.0}}}});
    range = distanceRange(document, *findRegion(document, "b"));
    CHECK(range->nearest.si() == doctest::Approx(1.0 / vergence(10.5, 99.5)));
    document = with(document, {SetVisible{"a", false}});
    CHECK(distanceRange(document, *findRegion(document, "b"))->nearest.si() ==
          doctest::Approx(1.0 / vergence(10.5, 149.5)));
}

TEST_CASE("distance: the extremes found tile by tile are those over every pixel") {
    law("any masks, any plane", [] {
        Document document = twoRegions();
        document = *edited(document, SetMask{"b", anyMask(), ""});
        document = *edited(document, SetMask{"a", anyMask(), ""});
        Region desk = *findRegion(document, "b");
        PlaneDistance plane;
        for (DistanceAnchor& anchor : plane.anchors) {
            anchor = {anyPoint(), Metre::fromSi(*rc::gen::inRange(50, 60) / 100.0)};
        }
        desk.distance = plane;
        const auto vergence = affineVergence(desk);
        RC_PRE(vergence.has_value());
        double low = 1e9, high = -1e9;
        const Mask& above = findRegion(document, "a")->mask;
        for (int y = 0; y < 200; ++y) {
            for (int x = 0; x < 320; ++x) {
                if (desk.mask.at(x, y) < 128 || above.at(x, y) >= 128) continue;
                low = std::min(low, (**vergence)(x + 0.5, y + 0.5));
                high = std::max(high, (**vergence)(x + 0.5, y + 0.5));
            }
        }
        const auto range = distanceRange(document, desk);
        RC_ASSERT(range.has_value() == (low <= high));
        if (!range) return;
        RC_ASSERT(std::abs((1.0 / range->farthest).si() - low) < 1e-9);
        RC_ASSERT(std::abs((1.0 / range->nearest).si() - high) < 1e-9);
    });
}

TEST_CASE("distance: a region that covers nothing has no range when its distance needs pixels") {
    const Document document = with(twoRegions(), {SetDistance{"b", kDesk}});
    CHECK_FALSE(distanceRange(document, *findRegion(document, "b")));
    CHECK(distanceRange(document, *findRegion(document, "a")));
}

TEST_CASE("distance: a depth map gives the region's own pixels, without holes and strays") {
    Document document = twoRegions();
    std::vector<std::uint16_t> raw(320 * 200, 900);
    for (int y = 0; y < 100; ++y) {
        for (int x = 0; x < 100; ++x)
            raw[static_cast<std::size_t>(y * 320 + x)] = static_cast<std::uint16_t>(500 + x);
    }
    for (int x = 0; x < 100; ++x)
        raw[static_cast<std::size_t>(50 * 320 + x)] = 0;  // a row of holes
    raw[60 * 320 + 60] = 7;                               // a stray
    raw[61 * 320 + 60] = 65535;
    Scene scene = document.scene;
    scene.depth = Box<DepthMap>(depthOf(Image<std::uint16_t>({320, 200}, 1, raw), 1.0_mm));
    document = with(document, {SetScene{scene}, SetDistance{"b", FromDepthMap{0.01_m}},
                               FillShape{"b", Rectangle{{0.0, 0.0}, {100.0, 100.0}}}});
    const Region& region = *findRegion(document, "b");
    const auto range = distanceRange(document, region);
    REQUIRE(range);
    CHECK(range->nearest.si() == doctest::Approx(0.500 - 0.01));
    CHECK(range->farthest.si() == doctest::Approx(0.599 + 0.01));
    CHECK(range->holes == doctest::Approx(0.01));
    CHECK(distanceAt(document, region, {20.9, 3.2})->si() == doctest::Approx(0.520));
    CHECK_FALSE(distanceAt(document, region, {20.0, 50.5}));
    CHECK_FALSE(distanceAt(document, region, {-0.1, 50.5}));
    CHECK_FALSE(*affineVergence(region));
    // The background is seen where "Hands" is not: all of it at 0.9 m.
    Region background = *document.background;
    background.distance = FromDepthMap{};
    CHECK(distanceRange(document, background)->nearest.si() == doctest::Approx(0.9));
}

}  // namespace ilf
