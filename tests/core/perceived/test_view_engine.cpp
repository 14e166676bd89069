// The fast view: bit for bit the same after any edits, on any number of threads; what it skips; what it costs to
// cancel.
#include "core/perceived/view_engine.h"

#include <cmath>

#include "tests/core/perceived/small_scene.h"
#include "tests/support/law.h"
#include "tests/support/scanned_map.h"

using namespace ilf;
using namespace ilf::test;

namespace {

constexpr Size kWide{300, 170};  // five tiles across, six down, none of them whole at the edges

Mask disc(double x, double y, double radius) {
    return maskOf(kWide, [=](int i, int j) { return std::hypot(i + 0.5 - x, j + 0.5 - y) < radius; });
}

/// Near and far objects, focused and blurred, on a desk that may slope away.
Document desk(bool sloped) {
    Document d =
        document({region("near", Look::blur, 0.3, disc(90, 90, 40)), region("cup", Look::focus, 0.5, disc(150, 60, 35)),
                  region("far", Look::blur, 1.2, disc(220, 110, 30))},
                 Look::neutral, 2.0, kWide);
    d.scene.scale.focalPixels = 500.0;
    if (sloped) {
        Region plane = *d.background;
        plane.distance = PlaneDistance{{{{{0.0, 0.0}, 1.6_m}, {{300.0, 0.0}, 1.6_m}, {{150.0, 170.0}, 0.6_m}}}};
        d.background = Box<Region>(plane);
    }
    return d;
}

PerceivedView look(ViewEngine& engine, const Played& p, const ViewRequest& request = {}) {
    return *engine.see(p.document, p.plan, p.program, request);
}
PerceivedView afresh(const Played& p, const ViewRequest& request = {}, int threads = 2) {
    ViewEngine engine(threads);
    return look(engine, p, request);
}
bool identical(const PerceivedView& a, const PerceivedView& b) { return a.tiles == b.tiles && a.size == b.size; }

/// Paints a dab of any strength on one region's mask; 0 erases.
void dab(Document& d, std::size_t region, int x, int y, int radius, int value) {
    Region changed = *d.regions[region];
    const Mask before = changed.mask;
    for (int row = 0; row < before.rows(); ++row) {
        for (int column = 0; column < before.columns(); ++column) {
            Tile tile = *before.tile(column, row);
            for (int j = 0; j < kTile; ++j) {
                for (int i = 0; i < kTile; ++i) {
                    if (std::hypot(column * kTile + i - x, row * kTile + j - y) < radius)
                        tile.at(i, j) = static_cast<std::uint8_t>(value);
                }
            }
            changed.mask.setTile(column, row, boxed(tile));
        }
    }
    // Tiles that are the same stay the same boxes, as an edit leaves them.
    for (int row = 0; row < before.rows(); ++row) {
        for (int column = 0; column < before.columns(); ++column) {
            if (before.tile(column, row) == changed.mask.tile(column, row))
                changed.mask.setTile(column, row, before.tile(column, row));
        }
    }
    d.regions[region] = Box<Region>(changed);
}

/// The program of an edited scene, sharing the tiles of the one before.
Played next(const Played& before, const Document& document) {
    Played now = played(document);
    for (std::size_t i = 0; i < std::min(now.program.images.size(), before.program.images.size()); ++i) {
        LightImage& image = now.program.images[i];
        const LightImage& old = before.program.images[i];
        for (int row = 0; row < image.rows(); ++row) {
            for (int column = 0; column < image.columns(); ++column) {
                if (image.tile(column, row) == old.tile(column, row)) image.setTile(column, row, old.tile(column, row));
            }
        }
    }
    return now;
}

}  // namespace

TEST_CASE("view engine: after random edits the view is bit for bit that of a fresh engine, on one thread or two") {
    law("identical after edits", [&] {
        const bool sloped = *rc::gen::arbitrary<bool>();
        ViewEngine one(1), two(2);
        ViewRequest request;
        request.rung = *rc::gen::element(Rung::dragging, Rung::rest, Rung::idle);
        request.scale = *rc::gen::element(1.0, 1.0, 0.67);
        request.lensField = *rc::gen::arbitrary<bool>();
        request.chromatic = *rc::gen::inRange(0, 4) == 0;
        request.gaze = *rc::gen::element(Gaze::ahead, Gaze::fixed, Gaze::follows);
        request.gazeAt = {1.0 * *rc::gen::inRange(0, 300), 1.0 * *rc::gen::inRange(0, 170)};
        Document first = desk(sloped);
        first.rig.primaries = std::array<Metre, 3>{623e-9_m, 530e-9_m, 460e-9_m};
        if (*rc::gen::inRange(0, 4) == 0) first.rig.room.ambient_lx = 20.0;
        const Homography<ProjectorFrame, CameraFrame> tilted{{0.96, 0.02, 4, -0.03, 0.98, 6, 1e-5, -3e-5, 1}};
        static const Box<DenseMap> bent(sampledMap(tilted, kWide, kWide, 2.0));
        if (*rc::gen::inRange(0, 3) == 0) first.rig.registration = registered(bent);
        Played now = played(first);
        look(one, now, request);
        look(two, now, request);
        const int edits = *rc::gen::inRange(1, 4);
        for (int i = 0; i < edits; ++i) {
            Document d = now.document;
            const auto region = static_cast<std::size_t>(*rc::gen::inRange(0, 3));
            switch (*rc::gen::inRange(0, 7)) {
            case 0: {
                Region changed = *d.regions[region];
                changed.distance = ConstantDistance{Metre::fromSi(0.3 + 0.1 * *rc::gen::inRange(0, 12)), {}};
                d.regions[region] = Box<Region>(changed);
                break;
            }
            case 1: {
                Region changed = *d.regions[region];
                changed.look = *rc::gen::element(Look::focus, Look::blur, Look::neutral);
                d.regions[region] = Box<Region>(changed);
                break;
            }
            case 2:
                request.eye = request.eye == Eye::left ? Eye::right : Eye::left;
                break;
            default:
                dab(d, region, *rc::gen::inRange(0, 300), *rc::gen::inRange(0, 170), *rc::gen::inRange(3, 30),
                    *rc::gen::arbitrary<bool>());
            }
            if (!plan(planInput(d))) continue;
            now = next(now, d);
            if (*rc::gen::arbitrary<bool>()) {
                int tilesLeft = *rc::gen::inRange(0, 3);
                const auto cut =
                    *one.see(now.document, now.plan, now.program, request, [&] { return tilesLeft-- <= 0; });
                const ViewCounters& c = cut.counters;
                RC_ASSERT(c.computed + c.unchanged + c.plain + c.left == c.tiles);
            }
            const auto a = look(one, now, request), b = look(two, now, request), fresh = afresh(now, request);
            RC_ASSERT(identical(a, fresh));
            RC_ASSERT(identical(b, fresh));
            const ViewCounters& c = a.counters;
            RC_ASSERT(c.computed + c.unchanged + c.plain + c.left == c.tiles);
        }
    });
}

TEST_CASE("view engine: light through a scanned map that says what a homography says is the same light") {
    Document d = desk(false);
    d.rig.registration = registered(Homography<ProjectorFrame, CameraFrame>{});
    const PerceivedView plane = afresh(played(d));
    d.rig.registration = registered(Box<DenseMap>(sampledMap({}, kWide, kWide)));
    CHECK(identical(plane, afresh(played(d))));
}

TEST_CASE("view engine: nothing changed, nothing worked out") {
    ViewEngine engine;
    const Played scene = played(desk(false));
    const PerceivedView first = look(engine, scene), second = look(engine, scene);
    CHECK(first.counters.computed == first.counters.tiles);
    CHECK(second.counters.computed == 0);
    CHECK(second.counters.unchanged == second.counters.tiles);
    for (std::size_t i = 0; i < first.tiles.size(); ++i)
        CHECK(first.tiles[i].same(second.tiles[i]));
}

TEST_CASE("view engine: a dab of light costs the tiles it can reach, and leaves the others shared") {
    ViewEngine engine(1);
    Played scene = played(desk(false));
    const PerceivedView before = look(engine, scene);
    LightImage& image = scene.program.images.back();
    Tile tile = *image.tile(1, 1);
    for (int y = 10; y < 16; ++y)
        tile.at(30, y) = static_cast<std::uint8_t>(tile.at(30, y) ^ 0x55);
    image.setTile(1, 1, boxed(tile));
    const PerceivedView after = look(engine, scene);
    CHECK(after.counters.computed > 0);
    CHECK(after.counters.computed <= 9);
    int shared = 0;
    for (std::size_t i = 0; i < before.tiles.size(); ++i)
        shared += before.tiles[i].same(after.tiles[i]) ? 1 : 0;
    CHECK(shared == after.counters.unchanged);
    CHECK(identical(after, afresh(scene)));
}

TEST_CASE("view engine: a still program is the picture, tile by tile") {
    const Played still =
        played(document({region("near", Look::focus, 0.5, disc(90, 90, 40))}, Look::neutral, 2.0, kWide));
    const PerceivedView seen = afresh(still);
    CHECK(seen.counters.plain == seen.counters.tiles);
    CHECK(seen.radiance() == plainView(still.document, 1.0));
}

TEST_CASE("view engine: cancelled, it gives what it has and goes on from there") {
    ViewEngine engine(1);
    const Played scene = played(desk(false));
    const auto cut = engine.see(scene.document, scene.plan, scene.program, {}, [] { return true; });
    REQUIRE(cut);
    CHECK_FALSE(cut->complete);
    CHECK(cut->counters.computed == 0);
    const PerceivedView whole = look(engine, scene);
    CHECK(whole.complete);
    CHECK(identical(whole, afresh(scene)));
}

TEST_CASE("view engine: a refusal leaves it as it was") {
    ViewEngine engine;
    const Played scene = played(desk(false));
    const PerceivedView before = look(engine, scene);
    ViewRequest nobody;
    nobody.attending = "nobody";
    const auto refused = engine.see(scene.document, scene.plan, scene.program, nobody);
    REQUIRE_FALSE(refused);
    CHECK(refused.error().fault == Fault::notFound);
    const PerceivedView after = look(engine, scene);
    CHECK(after.counters.computed == 0);
    CHECK(identical(before, after));
}

TEST_CASE("view engine: every option gives the same view whatever was seen before") {
    const Played scene = [] {
        Document d = desk(true);
        d.rig.primaries = std::array<Metre, 3>{623e-9_m, 530e-9_m, 460e-9_m};
        d.rig.room.ambient_lx = 30.0;
        return played(d);
    }();
    std::vector<ViewRequest> requests(7);
    requests[1].scale = 0.5;
    requests[2].chromatic = true;
    requests[3].lensField = true;
    requests[4].gaze = Gaze::follows;
    requests[5].gaze = Gaze::fixed;
    requests[5].gazeAt = {40.0, 30.0};
    requests[6].attending = "near";
    ViewEngine engine;
    for (const ViewRequest& request : requests) {
        const PerceivedView seen = look(engine, scene, request);
        CHECK(identical(seen, afresh(scene, request, 1)));
        if (!(request == ViewRequest{}) && request.scale == 1.0) CHECK_FALSE(identical(seen, afresh(scene)));
    }
}

TEST_CASE("view engine: a surface that covers half is seen as half, however evenly it does") {
    // The whole near surface covers half of what lies behind; one pixel in seven a little more breaks the evenness.
    const auto covered = [](bool even) {
        Document d = document({region("veil", Look::focus, 0.5, maskOf(kWide, [](int, int) { return true; }))},
                              Look::blur, 1.0, kWide);
        Region veil = *d.regions[0];
        for (int row = 0; row < veil.mask.rows(); ++row) {
            for (int column = 0; column < veil.mask.columns(); ++column) {
                Tile tile;
                for (int i = 0; i < kTile * kTile; ++i)
                    tile.v[static_cast<std::size_t>(i)] = !even && i % 7 == 0 ? 129 : 128;
                veil.mask.setTile(column, row, boxed(tile));
            }
        }
        d.regions[0] = Box<Region>(veil);
        return afresh(played(d)).radiance();
    };
    CHECK(psnr(covered(true), covered(false)) > 45.0);
}

TEST_CASE("view engine: a program with fewer images than the plan has levels is refused") {
    Played scene = played(desk(false));
    scene.program.images.resize(1);
    for (int& image : scene.program.imageOfSlot)
        image = std::min(image, 0);
    CHECK_FALSE(ViewEngine().see(scene.document, scene.plan, scene.program, {}));
}

TEST_CASE("view engine: a finer rung is nearer to the finest") {
    const Played scene = played(desk(false));
    const auto at = [&](Rung rung) {
        ViewRequest request;
        request.rung = rung;
        return afresh(scene, request).radiance();
    };
    const Radiance finest = at(Rung::idle);
    CHECK(psnr(at(Rung::dragging), finest) > 38.0);
    CHECK(psnr(at(Rung::rest), finest) > psnr(at(Rung::dragging), finest));
}

TEST_CASE("view engine: an eye turned to a point outside the picture is refused, and the view before stays good") {
    const Played p = played(desk(false));
    ViewEngine engine(1);
    const PerceivedView before = look(engine, p);
    ViewRequest request;
    request.gaze = Gaze::fixed;
    for (const Point<CameraFrame> at : {Point<CameraFrame>{-1.0, 5.0}, {5.0, 1e9}, {std::nan(""), 5.0}}) {
        request.gazeAt = at;
        const auto seen = engine.see(p.document, p.plan, p.program, request);
        REQUIRE_FALSE(seen);
        CHECK(seen.error().what == "The eye cannot be turned to a point outside the picture.");
    }
    CHECK(identical(look(engine, p), before));
    request.gazeAt = {20.0, 20.0};
    CHECK(engine.see(p.document, p.plan, p.program, request));
}

TEST_CASE("view engine: whether light is even beside it changes no bit of a tile") {
    constexpr Size kLarge{640, 360};
    Document d = document({region("near", Look::blur, 0.3,
                                  maskOf(kLarge, [](int i, int j) { return std::hypot(i - 520.0, j - 60.0) < 40.0; }))},
                          Look::neutral, 2.0, kLarge);
    d.scene.scale.focalPixels = 900.0;
    const auto lit = [&](const Played& p, int value, bool hole) {
        Program program = p.program;
        for (LightImage& image : program.images) {
            for (int row = 0; row < image.rows(); ++row) {
                for (int column = 0; column < image.columns(); ++column) {
                    Tile tile;
                    for (int y = 0; y < kTile; ++y) {
                        for (int x = 0; x < kTile; ++x) {
                            const double away = std::hypot(column * kTile + x - 224.0, row * kTile + y - 144.0);
                            tile.at(x, y) = static_cast<std::uint8_t>(hole && away < 5.0 ? 7 : value);
                        }
                    }
                    image.setTile(column, row, boxed(tile));
                }
            }
        }
        return program;
    };
    const Played p = played(d);
    for (const Rung rung : {Rung::dragging, Rung::rest, Rung::idle}) {
        for (const int value : {128, 255}) {
            ViewRequest request;
            request.rung = rung;
            const Program even = lit(p, value, false), holed = lit(p, value, true);
            ViewEngine engine(2), fresh(1), freshHoled(1);
            REQUIRE(engine.see(p.document, p.plan, even, request));
            CHECK(identical(*engine.see(p.document, p.plan, holed, request),
                            *freshHoled.see(p.document, p.plan, holed, request)));
            CHECK(identical(*engine.see(p.document, p.plan, even, request),
                            *fresh.see(p.document, p.plan, even, request)));
        }
    }
}
