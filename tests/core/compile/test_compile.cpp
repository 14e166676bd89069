// Compiling as a whole: what is shared, what is skipped, what is refused.
#include "core/document/edit.h"
#include "tests/core/compile/received.h"
#include "tests/support/law.h"
#include "tests/support/scanned_map.h"

namespace {

using namespace ilf;

constexpr Size kPicture{640, 420};

/// Three regions of three looks on one slanted-looking desk, one region in front of a far background.
Document desk(Size projector, std::optional<Homography<ProjectorFrame, CameraFrame>> registration) {
    Document document = flatDocument(kPicture, Look::focus, 0.5_m);
    document.rig.projector = projector;
    if (registration) document.rig.registration = registered(*registration);
    document.regions = {
        regionOf("clutter", Look::blur, 0.5_m, rasterised(Ellipse{{300, 100}, {520, 300}}, kPicture)),
        regionOf("label", Look::neutral, 0.52_m, rasterised(Rectangle{{60, 60}, {330, 180}}, kPicture)),
        regionOf("cup", Look::blur, 0.4_m, rasterised(Ellipse{{90, 220}, {240, 390}}, kPicture)),
    };
    return document;
}

bool sameLight(const Compiled& a, const Compiled& b) {
    return a.program == b.program && contentHash(a.program) == contentHash(b.program);
}

Edit randomEdit() {
    const std::string id = *rc::gen::element<std::string>("clutter", "label", "cup");
    const auto mode = *rc::gen::element(PaintMode::add, PaintMode::erase);
    const auto within = [](int most) { return static_cast<double>(*rc::gen::inRange(-20, most + 20)); };
    switch (*rc::gen::inRange(0, 8)) {
    case 0:
        return SetLook{id, *rc::gen::element(Look::blur, Look::focus, Look::neutral)};
    case 1:
        return SetVisible{id, *rc::gen::element(true, false)};
    case 2:
        return FillShape{id, Rectangle{{within(640), within(420)}, {within(640), within(420)}}, mode, false};
    default:
        break;
    }
    const Brush brush{static_cast<double>(*rc::gen::inRange(1, 60)), *rc::gen::element(0.0, 0.5, 1.0),
                      *rc::gen::element(0.4, 1.0)};
    return Paint{id, {Dab{{within(640), within(420)}, brush}}, mode, false};
}

}  // namespace

TEST_CASE("compile: after any edits, an incremental compile is bit for bit the compile from nothing") {
    const auto blendings = {Blending::closedForm, Blending::linearPerceived, Blending::linearObject, Blending::none};
    law("incremental equals full", [&] {
        const Homography<ProjectorFrame, CameraFrame> keystone{{0.9, 0.05, 8, -0.03, 0.95, 12, 1e-4, 5e-5, 1}};
        enum Map { fitted, keystoned, scanned };
        const Map map = *rc::gen::element(fitted, keystoned, scanned);
        Document document = map == fitted ? desk({512, 350}, std::nullopt) : desk({600, 400}, keystone);
        static const Box<DenseMap> bent(sampledMap(keystone, kPicture, {600, 400}, 1.5));
        if (map == scanned) document.rig.registration = registered(bent);
        document.seam.blending = *rc::gen::elementOf(std::vector<Blending>(blendings));
        Compiled now = compiledFrom(document);
        const int edits = *rc::gen::inRange(1, 5);
        for (int i = 0; i < edits; ++i) {
            const auto next = edited(document, randomEdit());
            if (!next) continue;
            const Result<Plan> wanted = plan(planInput(*next));
            if (!wanted) continue;
            document = *next;
            now = compile(document, *wanted, &now).value();
        }
        const Compiled full = compiledFrom(document);
        RC_ASSERT(sameLight(now, full));
        RC_ASSERT(now.counters.seamTiles == full.counters.seamTiles);
        RC_ASSERT(now.counters.uniform == full.counters.uniform);
        RC_ASSERT(now.counters.computed <= full.counters.computed);
    });
}

TEST_CASE("compile: a dab computes the tiles it can reach and shares all others") {
    Document document = desk({640, 420}, std::nullopt);
    const Compiled before = compiledFrom(document);
    document = edited(document, Paint{"clutter", {Dab{{522, 200}, {8.0, 1.0, 1.0}}}, PaintMode::add, false}).value();
    const Compiled after = compiledFrom(document, &before);
    CHECK(after.counters.computed > 0);
    CHECK(after.counters.computed <= 6 * static_cast<int>(after.program.images.size()));
    CHECK(after.counters.unchanged + after.counters.computed == after.counters.tiles);
    int replaced = 0;
    for (std::size_t l = 0; l < after.program.images.size(); ++l)
        forEachChangedTile(before.program.images[l], after.program.images[l], [&](int, int) { ++replaced; });
    CHECK(replaced > 0);
    CHECK(replaced <= after.counters.computed);

    document = edited(document, RenameRegion{"clutter", "Clutter"}).value();
    const Compiled renamed = compiledFrom(document, &after);
    CHECK(renamed.counters.computed == 0);
    CHECK(sameLight(renamed, after));
}

TEST_CASE("compile: with nothing to blur there is one even picture, no dark slot and no seam") {
    Document document = desk({640, 420}, std::nullopt);
    for (const char* id : {"clutter", "cup"})
        document = edited(document, SetLook{id, Look::focus}).value();
    const Compiled compiled = compiledFrom(document);
    CHECK(!compiled.plan.sweeps());
    CHECK(compiled.program.waveform.still());
    REQUIRE(compiled.program.images.size() == 1);
    CHECK(compiled.program.images[0] == TileGrid({640, 420}, 255));
    CHECK(compiled.program.imageOfSlot == std::vector<int>(16, 0));
    CHECK(compiled.counters.seamTiles == 0);
    CHECK(compiled.counters.computed == 0);
    CHECK(compiled.counters.uniform == compiled.counters.tiles);
}

TEST_CASE("compile: over a sweep focused, blurred and neutral regions get equal light") {
    // A rig whose sine holds the two levels for different numbers of slots, so that weights matter.
    Document document = desk({640, 420}, std::nullopt);
    document.rig.slotRate = document.rig.fastest = 2880.0_Hz;
    const Compiled compiled = compiledFrom(document);
    const auto overSweep = [&](int x, int y) {
        double sum = 0.0;
        for (const int image : compiled.program.imageOfSlot)
            sum += image == Program::kDark ? 0.0 : compiled.program.images[static_cast<std::size_t>(image)].at(x, y);
        return sum / (255.0 * static_cast<double>(compiled.program.imageOfSlot.size()));
    };
    const double wanted = compiled.plan.light;
    CHECK(overSweep(600, 30) == doctest::Approx(wanted).epsilon(0.004));   // background, focus
    CHECK(overSweep(420, 200) == doctest::Approx(wanted).epsilon(0.004));  // clutter, blur
    CHECK(overSweep(160, 120) == doctest::Approx(wanted).epsilon(0.004));  // label, neutral
    // Neutral light is even: no lit slot differs from another by more than a step of rounding.
    int least = 255, most = 0;
    for (const int image : compiled.program.imageOfSlot) {
        if (image == Program::kDark) continue;
        const int v = compiled.program.images[static_cast<std::size_t>(image)].at(160, 120);
        least = std::min(least, v), most = std::max(most, v);
    }
    CHECK(most - least <= 1);
}

TEST_CASE("compile: the topmost visible region wins; beside the picture lies background") {
    Document document = desk({1000, 420}, std::nullopt);  // the picture leaves 180 columns at each side
    document.seam.blending = Blending::none;
    const int left = 180;
    Compiled compiled = compiledFrom(document);
    CHECK(compiled.program.images[0].at(5, 200) == 255);
    CHECK(compiled.program.images[1].at(left + 320, 170) == 255);  // clutter over label
    document = edited(document, MoveRegion{"label", 0}).value();
    compiled = compiledFrom(document, &compiled);
    CHECK(compiled.program.images[1].at(left + 320, 170) < 200);  // now label over clutter
}

TEST_CASE("compile: a soft brush shares light by coverage") {
    Document document = flatDocument(kPicture, Look::focus, 0.5_m);
    document.rig.projector = kPicture;
    document.seam.blending = Blending::none;
    document.regions = {regionOf("veil", Look::blur, 0.5_m, Mask(kPicture, 128))};
    const Compiled compiled = compiledFrom(document);
    CHECK(compiled.program.images[1].at(300, 200) == doctest::Approx(128).epsilon(0.01));
    CHECK(compiled.program.images[0].at(300, 200) == doctest::Approx(127).epsilon(0.01));
}

TEST_CASE("compile: what cannot be compiled is refused in words") {
    Document document = desk({640, 420}, std::nullopt);
    const Plan plan = planned(document);
    document.rig.registration = registered(Homography<ProjectorFrame, CameraFrame>{{1, 1, 0, 1, 1, 0, 0, 0, 1}});
    CHECK(compile(document, plan).error().what.find("registration") != std::string::npos);
    document.rig.registration = {};
    document.rig.projector = {0, 0};
    CHECK(compile(document, plan).error().fault == Fault::outOfRange);
}
