// Compiling through a scanned map.
#include <algorithm>
#include <cstdlib>

#include "core/compile/coverage.h"
#include "core/document/edit.h"
#include "tests/core/compile/received.h"
#include "tests/support/law.h"
#include "tests/support/scanned_map.h"

namespace {

using namespace ilf;

using Map = Homography<ProjectorFrame, CameraFrame>;
constexpr Size kPicture{640, 420}, kRaster{600, 400};

Document desk() {
    Document document = flatDocument(kPicture, Look::focus, 0.5_m);
    document.rig.projector = kRaster;
    document.regions = {
        regionOf("clutter", Look::blur, 0.5_m, rasterised(Ellipse{{300, 100}, {520, 300}}, kPicture)),
        regionOf("label", Look::neutral, 0.52_m, rasterised(Rectangle{{60, 60}, {330, 180}}, kPicture)),
        regionOf("cup", Look::blur, 0.4_m, rasterised(Ellipse{{90, 220}, {240, 390}}, kPicture)),
    };
    return document;
}

TileGrid onRaster(const Mask& mask, Size projector, const PixelMap& map) {
    const CoverageSampler sampler(mask.size(), projector, map);
    TileGrid grid(projector);
    for (int row = 0; row < grid.rows(); ++row)
        for (int column = 0; column < grid.columns(); ++column)
            grid.setTile(column, row, sampler.tile(mask, column, row));
    return grid;
}

/// The largest difference where the camera's picture reaches with `margin` to spare, and the share of pixels that
/// differ by more than one code.
struct Off {
    int most = 0;
    double beyondOne = 0.0;
};
Off off(const TileGrid& a, const TileGrid& b, const Map& map, Size picture, double margin) {
    Off off;
    double compared = 0.0;
    const auto back = map.inverted();
    for (int y = 0; y < a.size().height; ++y) {
        for (int x = 0; x < a.size().width; ++x) {
            const auto c = back(Point<ProjectorFrame>{x + 0.5, y + 0.5});
            if (c.x < margin || c.y < margin || c.x > picture.width - margin || c.y > picture.height - margin) continue;
            const int difference = std::abs(a.at(x, y) - b.at(x, y));
            off.most = std::max(off.most, difference);
            off.beyondOne += difference > 1 ? 1.0 : 0.0;
            compared += 1.0;
        }
    }
    off.beyondOne /= compared;
    return off;
}

}  // namespace

TEST_CASE("dense map: one sampled from a homography covers like the homography, within one code") {
    law("the dense map of a plane is the plane", [] {
        const double k = *rc::gen::inRange(40, 190) / 100.0, tilt = *rc::gen::inRange(-10, 11) / 100.0;
        const Map map{{k, tilt, 9.3, -tilt, k * 0.95, 6.1, 1e-4 * k, -5e-5 * k, 1}};
        const Size picture{200, 150}, raster{static_cast<int>(200 * k) + 20, static_cast<int>(150 * k) + 20};
        const Mask mask = rasterised(Ellipse{{30.0 + *rc::gen::inRange(0, 40), 25}, {160, 120}}, picture);
        const PixelMap dense(Box<DenseMap>(sampledMap(map, picture, raster)));
        const Off difference =
            off(onRaster(mask, raster, PixelMap(map)), onRaster(mask, raster, dense), map, picture, 3);
        RC_LOG() << difference.most << " codes at scale " << k << '\n';
        RC_ASSERT(difference.most <= 1);
    });
}

TEST_CASE("dense map: slots compiled through one sampled from a homography differ by at most one code from its own") {
    const Map keystone{{0.9, 0.05, 8, -0.03, 0.95, 12, 1e-4, 5e-5, 1}};
    for (const Blending blending :
         {Blending::closedForm, Blending::linearPerceived, Blending::linearObject, Blending::none}) {
        CAPTURE(static_cast<int>(blending));
        Document document = desk();
        document.seam.blending = blending;
        document.rig.registration = registered(keystone);
        const Compiled plane = compiledFrom(document);
        document.rig.registration = registered(Box<DenseMap>(sampledMap(keystone, kPicture, kRaster)));
        const Compiled dense = compiledFrom(document);
        REQUIRE(plane.program.images.size() == dense.program.images.size());
        for (std::size_t i = 0; i < plane.program.images.size(); ++i) {
            const Off difference = off(plane.program.images[i], dense.program.images[i], keystone, kPicture, 40);
            CAPTURE(difference.most);
            CHECK(difference.most <= 2);
            CHECK(difference.beyondOne < 1e-4);
        }
    }
}

TEST_CASE("dense map: pixels that the camera does not see are dark in every slot, background and neutral light too") {
    const Map keystone{{0.9, 0.05, 8, -0.03, 0.95, 12, 1e-4, 5e-5, 1}};
    const DenseMap whole = sampledMap(keystone, kPicture, kRaster, 1.0);
    const PixelRect<ProjectorFrame> shadow{150, 70, 333, 215};  // on background, label and clutter
    Document document = desk();
    document.rig.registration = registered(Box<DenseMap>(whole));
    const Compiled lit = compiledFrom(document);
    const Box<DenseMap> torn(withoutSeeing(whole, shadow));
    document.rig.registration = registered(torn);
    const Compiled compiled = compiledFrom(document, &lit);
    int darkOutside = 0;
    for (std::size_t i = 0; i < compiled.program.images.size(); ++i) {
        for (int y = 0; y < kRaster.height; ++y) {
            for (int x = 0; x < kRaster.width; ++x) {
                const int v = compiled.program.images[i].at(x, y);
                const bool seen = torn->seen.at(x, y) != 0;
                if (!seen && v != 0) FAIL("light on the unseen pixel " << x << ", " << y);
                darkOutside += seen && v != lit.program.images[i].at(x, y) ? 1 : 0;
            }
        }
    }
    CHECK(darkOutside == 0);
    CHECK(lit.program.images[0].at(160, 200) == 255);  // background, before the shadow fell there

    // What needs no slots is steady white light: nobody is left in the dark.
    for (const char* id : {"clutter", "cup"})
        document = edited(document, SetLook{id, Look::focus}).value();
    CHECK(compiledFrom(document).program.images[0] == TileGrid(kRaster, 255));
}

TEST_CASE("dense map: a line thinner than a projector pixel dims every pixel it crosses") {
    std::vector<std::uint8_t> pixels(std::size_t{400} * 400, 0);
    for (std::size_t y = 0; y < 400; ++y)
        pixels[y * 400 + 201] = 255;
    const Mask line = toTiles(Image<std::uint8_t>({400, 400}, 1, pixels));
    const PixelMap map(Box<DenseMap>(sampledMap(Map{{0.25, 0, 0, 0, 0.25, 0, 0, 0, 1}}, {400, 400}, {100, 100})));
    const TileGrid grid = onRaster(line, {100, 100}, map);
    for (int y = 0; y < 100; ++y)
        CHECK(grid.at(49, y) + grid.at(50, y) + grid.at(51, y) == doctest::Approx(64).epsilon(0.05));
}

TEST_CASE("dense map: a tile's samples stay inside the pixels it says it needs") {
    // Random maps, torn everywhere: a mask that is dark where the tile claims to look gives a dark tile, whatever lies
    // elsewhere.
    law("source covers all that is read", [] {
        const Size picture{150, 130}, raster{128, 64};
        DenseMap map = sampledMap(Map{}, picture, raster);
        std::vector<float> wild(map.cameraOfProjector.pixels().begin(), map.cameraOfProjector.pixels().end());
        const int jump = *rc::gen::inRange(1, 40);
        for (std::size_t i = 0; i < wild.size(); i += static_cast<std::size_t>(*rc::gen::inRange(1, 60)))
            wild[i] += static_cast<float>(*rc::gen::inRange(-10 * jump, 10 * jump)) / 10.0F;
        map.cameraOfProjector = Image<float>(raster, 2, std::move(wild));
        const CoverageSampler sampler(picture, raster, PixelMap(Box<DenseMap>(map)));
        for (const int column : {0, 1}) {
            const auto needed = sampler.source(column, 0).clipped(picture);
            std::vector<std::uint8_t> pixels(std::size_t{150} * 130, 255);
            for (int y = needed.y0; y < needed.y1; ++y)
                std::fill_n(pixels.begin() + y * 150 + needed.x0, needed.width(), std::uint8_t{0});
            const Mask mask = toTiles(Image<std::uint8_t>(picture, 1, pixels));
            RC_ASSERT(*sampler.tile(mask, column, 0) == Tile{});
        }
    });
}

TEST_CASE("dense map: a raster or picture of another size is refused in words") {
    Document document = desk();
    const Plan plan = planned(document);
    document.rig.registration = registered(Box<DenseMap>(sampledMap(Map{}, kPicture, {512, 350})));
    CHECK(compile(document, plan).error().what.find("512 x 350") != std::string::npos);
    document.rig.registration = registered(Box<DenseMap>(sampledMap(Map{}, {320, 210}, kRaster)));
    CHECK(compile(document, plan).error().what.find("320 x 210") != std::string::npos);
}
