// The reference as a tool: its noise, its seeds, its names for results, what it refuses.
#include "core/perceived/reference.h"

#include <set>

#include "core/base/parallel.h"
#include "tests/core/perceived/reference_cases.h"
#include "tests/support/law.h"

using namespace ilf;
using namespace ilf::test;

namespace {

/// A near blurred card before a focused wall, as it is planned, sweep and all.
Played swept() {
    const Mask card = maskOf(kSmall, [](int x, int y) { return std::hypot(x - 70.0, y - 60.0) < 30.0; });
    Document d = document({region("card", Look::blur, 0.35, card)}, Look::focus, 0.6);
    d.scene.scale.focalPixels = 1200.0;
    return played(d);
}
Reference referenceOf(const Played& p, const ViewRequest& request = {}) {
    return *Reference::of(p.document, p.plan, p.program, request);
}
double apart(const ReferencePixels& a, const ReferencePixels& b) { return agreement(a, b.radiance); }

}  // namespace

TEST_CASE("reference: more rays are less noise, and the floor is about what a better picture finds") {
    const Reference reference = referenceOf(swept());
    const auto pixels = somePixels({30, 20, 110, 100}, 200);
    const auto best = *reference.pixels(pixels, {16384, 9});
    double before = 0.0;
    for (const int samples : {64, 256, 1024, 4096}) {
        const auto seen = *reference.pixels(pixels, {samples, 1});
        MESSAGE(samples, " rays: floor ", seen.noiseFloor_dB, " dB, found ", apart(seen, best), " dB");
        CHECK(seen.noiseFloor_dB > before + 4.0);
        CHECK(std::abs(seen.noiseFloor_dB - apart(seen, best)) < 3.0);
        before = seen.noiseFloor_dB;
    }
    CHECK(before > 70.0);
}

TEST_CASE("reference: the same seed gives the same bits, another one other rays") {
    const Reference reference = referenceOf(swept());
    const auto pixels = somePixels({30, 20, 110, 100}, 60);
    const auto first = *reference.pixels(pixels, {100, 5});
    CHECK(first == *reference.pixels(pixels, {100, 5}));
    const auto other = *reference.pixels(pixels, {100, 6});
    CHECK(first.radiance != other.radiance);
    CHECK(apart(first, other) > 30.0);
}

TEST_CASE("reference: a pixel is the same alone, in a picture, and on one thread") {
    const Reference reference = referenceOf(swept());
    const auto pixels = somePixels({30, 20, 110, 100}, 40);
    const auto two = *reference.pixels(pixels, {64, 5});
    // Inside a parallel loop a second one runs on its caller alone.
    std::vector<ReferencePixels> one(2);
    parallelFor(2, [&](int i) { one[static_cast<std::size_t>(i)] = *reference.pixels(pixels, {64, 5}); });
    CHECK(one[0] == two);
    CHECK(one[1] == two);
    const auto picture = *reference.picture({64, 5});
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        CHECK(picture.radiance.at(pixels[i].x, pixels[i].y, 1) == static_cast<float>(two.radiance[i][1]));
    }
    CHECK(std::abs(picture.noiseFloor_dB - two.noiseFloor_dB) < 8.0);
}

TEST_CASE("reference: a still program is the plain view, without noise") {
    const Played still = played(document({region(kHere, Look::focus, 0.5, maskIn({0, 0, 6, 6}))}, Look::neutral, 2.0));
    const auto picture = *referenceOf(still).picture({2, 1});
    CHECK(picture.radiance == plainView(still.document, 1.0));
    CHECK(std::isinf(picture.noiseFloor_dB));
    CHECK(referenceOf(still).pixels(std::vector<ViewPixel>{{3, 4}}, {2, 1})->radiance[0][2] ==
          static_cast<double>(plainView(still.document, 1.0).at(3, 4, 2)));
}

TEST_CASE("reference: a view's frame is the picture's, at any scale") {
    ViewRequest half;
    half.scale = 0.5;
    const Reference reference = referenceOf(swept(), half);
    CHECK(reference.size() == Size{80, 60});
    CHECK(reference.picture({2, 1})->radiance.size() == Size{80, 60});
}

TEST_CASE("reference: its key changes with everything a view depends on, and with nothing else") {
    const Played scene = swept();
    const ReferenceRays few{64, 1};
    const auto keyOf = [&](const std::function<void(Played&, ViewRequest&)>& change) {
        Played p = scene;
        ViewRequest request;
        change(p, request);
        return referenceOf(p, request).key(few);
    };
    const std::string same = keyOf([](Played&, ViewRequest&) {});
    CHECK(same.size() == 32);
    CHECK(keyOf([](Played& p, ViewRequest&) { p.document.name = "Another"; }) == same);
    CHECK(keyOf([](Played&, ViewRequest& r) { r.rung = Rung::idle; }) == same);
    std::set<std::string> keys{same, referenceOf(scene).key({65, 1}), referenceOf(scene).key({64, 2}),
                               referenceOf(scene).key(few, std::vector<ViewPixel>{{1, 1}}),
                               referenceOf(scene).key(few, std::vector<ViewPixel>{{1, 2}})};
    const std::vector<std::function<void(Played&, ViewRequest&)>> changes{
        [](Played&, ViewRequest& r) { r.eye = Eye::right; },
        [](Played&, ViewRequest& r) { r.scale = 0.5; },
        [](Played&, ViewRequest& r) { r.attending = "card"; },
        [](Played&, ViewRequest& r) { r.gaze = Gaze::follows; },
        [](Played&, ViewRequest& r) { r.lensField = true; },
        [](Played& p, ViewRequest&) { p.plan.input.eye.pupil = 3.9_mm; },
        [](Played& p, ViewRequest&) { p.plan.input.eye.lensToPupil = 19.0_mm; },
        [](Played& p, ViewRequest&) { p.plan.waveform.power.c[1] *= 1.01; },
        [](Played& p, ViewRequest&) {
            for (Slot& slot : p.plan.slots)
                slot.start += 0.1_ms;
        },
        [](Played& p, ViewRequest&) { p.document.scene.picture = Box<Picture>(texture(kSmall, 8)); },
        [](Played& p, ViewRequest&) { p.document.scene.scale.focalPixels += 1.0; },
        [](Played& p, ViewRequest&) { p.document.wearer.axes[0].right = -30.0_mm; },
        [](Played& p, ViewRequest&) {
            Region card = *p.document.regions[0];
            card.distance = ConstantDistance{0.36_m, {}};
            p.document.regions[0] = Box<Region>(card);
        },
        [](Played& p, ViewRequest&) {
            Region card = *p.document.regions[0];
            card.mask = maskIn({10, 10, 50, 50});
            p.document.regions[0] = Box<Region>(card);
        },
        [](Played& p, ViewRequest&) { p.program.images[0] = TileGrid(p.program.projector, 200); }};
    for (const auto& change : changes)
        keys.insert(keyOf(change));
    CHECK(keys.size() == 5 + changes.size());
}

TEST_CASE("reference: refusals") {
    const Played scene = swept();
    const Reference reference = referenceOf(scene);
    CHECK_FALSE(reference.picture({1, 1}));
    CHECK_FALSE(reference.pixels(std::vector<ViewPixel>{{0, 0}}, {0, 1}));
    CHECK(reference.pixels(std::vector<ViewPixel>{{160, 0}}, {4, 1}).error().what ==
          "There is no pixel 160, 0 in a view of 160 x 120.");
    ViewRequest request;
    request.scale = 0.0;
    CHECK_FALSE(Reference::of(scene.document, scene.plan, scene.program, request));
    request = {};
    request.attending = "nobody";
    CHECK(Reference::of(scene.document, scene.plan, scene.program, request).error().fault == Fault::notFound);
    Document bare = scene.document;
    bare.scene.picture = {};
    CHECK(Reference::of(bare, scene.plan, scene.program, {}).error().fault == Fault::notFound);
    Program dark = scene.program;
    dark.images.clear();
    CHECK_FALSE(Reference::of(scene.document, scene.plan, dark, {}));
    dark = scene.program;
    dark.imageOfSlot.pop_back();
    CHECK_FALSE(Reference::of(scene.document, scene.plan, dark, {}));
}
