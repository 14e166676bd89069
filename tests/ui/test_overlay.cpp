// The overlay: hue and pattern by look, and only the tiles an edit can reach.
#include <doctest/doctest.h>

#include <algorithm>

#include "tests/support/law.h"
#include "tests/ui/headless.h"
#include "ui/overlay.h"

using namespace ilf;
using namespace ilf::ui;
using namespace ilf::ui::test;

namespace {

struct Pixel {
    int r, g, b, a;
};
Pixel pixel(const Document& document, const RegionId& selected, int x, int y) {
    const OverlayTile tile = overlayTile(document, selected, x / kTile, y / kTile);
    const auto i = static_cast<std::size_t>(((y % kTile) * kTile + x % kTile) * 4);
    return {tile[i], tile[i + 1], tile[i + 2], tile[i + 3]};
}
/// Share of marked pixels inside a rectangle.
double inked(const Document& document, const RegionId& selected, PixelRect<CameraFrame> rect) {
    int marked = 0;
    for (int y = rect.y0; y < rect.y1; ++y) {
        for (int x = rect.x0; x < rect.x1; ++x)
            marked += pixel(document, selected, x, y).a > 60 ? 1 : 0;
    }
    return static_cast<double>(marked) / (rect.width() * rect.height());
}

}  // namespace

TEST_CASE("overlay: blur is hatched, focus is not, and nothing covers nothing") {
    const Document document = twoRegions();
    CHECK(inked(document, "", {210, 80, 270, 140}) > 0.08);  // inside Clutter
    CHECK(inked(document, "", {210, 80, 270, 140}) < 0.3);   // never a solid flood
    CHECK(inked(document, "", {50, 80, 110, 140}) == 0.0);   // inside Face
    CHECK(inked(document, "", {135, 80, 185, 140}) == 0.0);  // between them
    CHECK(inked(document, "", {32, 60, 33, 180}) > 0.2);     // Face's dotted edge
    CHECK(inked(document, "", {32, 60, 33, 180}) < 0.9);
    CHECK(inked(document, "", {192, 60, 193, 180}) == 1.0);  // Clutter's solid edge
}

TEST_CASE("overlay: hue tells the look and the selected region is brighter") {
    Document document = twoRegions();
    const Pixel blur = pixel(document, "", 192, 100);
    CHECK(blur.r > blur.b);
    CHECK(pixel(document, "Clutter", 192, 100).a > blur.a);
    document = *edited(document, SetLook{"Clutter", Look::neutral});
    const Pixel neutral = pixel(document, "", 192, 100);
    CHECK(std::abs(neutral.r - neutral.b) < 40);
    document = *edited(document, SetVisible{"Clutter", false});
    CHECK(pixel(document, "", 192, 100).a == 0);
}

TEST_CASE("overlay: a tile that is not listed as different has not changed") {
    const Document before = twoRegions({400, 300});
    law("for dabs, looks, visibility, order and selection", [&] {
        Document after = before;
        RegionId selected = "Face";
        switch (*rc::gen::inRange(0, 5)) {
        case 0:
            after = *edited(after, Paint{"Clutter",
                                         {Dab{{*rc::gen::inRange(0, 400) * 1.0, *rc::gen::inRange(0, 300) * 1.0},
                                              {*rc::gen::inRange(1, 60) * 1.0, 0.8, 1.0}}}});
            break;
        case 1:
            after = *edited(after, SetLook{"Face", Look::blur});
            break;
        case 2:
            after = *edited(after, SetVisible{"Clutter", false});
            break;
        case 3:
            after = *edited(after, MoveRegion{"Face", 0});
            break;
        default:
            selected = "Clutter";
            break;
        }
        const auto differ = overlayTilesThatDiffer({before, "Face"}, {after, selected});
        for (int row = 0; row < 5; ++row) {
            for (int column = 0; column < 7; ++column) {
                if (std::find(differ.begin(), differ.end(), std::pair{column, row}) != differ.end()) continue;
                RC_ASSERT(overlayTile(before, "Face", column, row) == overlayTile(after, selected, column, row));
            }
        }
    });
}

TEST_CASE("overlay: a dab lists the tiles around it and no others") {
    const Document before = twoRegions({1024, 768});
    const Document after = *edited(before, Paint{"Clutter", {Dab{{100, 100}, {10, 1, 1}}}});
    const auto differ = overlayTilesThatDiffer({before, ""}, {after, ""});
    CHECK(differ.size() <= 16);
    CHECK(overlayTilesThatDiffer({before, ""}, {before, ""}).empty());
}
