// Regions that follow something: labels, clicks, handles and strokes belong to the thing where it is shown.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "tests/ui/headless.h"
#include "ui/canvas.h"

using namespace ilf;
using namespace ilf::ui;
using namespace ilf::ui::test;
using When = EditRequest::When;

namespace {

/// A desk on which "Face" is shown where `motion` took it.
struct Following {
    Desk desk;
    Motion motion;
    Document shown;

    explicit Following(const Motion& by, Document document = followingFace()) : desk(std::move(document)), motion(by) {
        desk.dress = [this](View& view) {
            const std::vector<RegionMotion> motions{{"Face", motion, 0.0}};
            shown = moved(view.document, motions);
            view.follow.shown = &shown;
            view.follow.motions = motions;
        };
        desk.state.selected = "Face";
        desk.settle();
    }

    /// "Face" covers 32..128 x 48..192.
    static Document followingFace() { return *edited(twoRegions(), SetFollow{"Face", Follow{StreamTarget{}}}); }
    const Region& face() const { return *findRegion(desk.document(), "Face"); }
    /// Where a point of the thing, as it was painted, is seen in the window.
    Point<WidgetFrame> seen(double x, double y) const {
        const auto to = motion(Point<CameraFrame>{x, y});
        return desk.at(to.x, to.y);
    }
    /// What the badges are drawn and clicked by.
    Point<WidgetFrame> badge() {
        View view{desk.document()};
        desk.dress(view);
        Requests requests;
        const Panel panel{view, desk.state, desk.input, requests, desk.areas()};
        for (const Badge& one : badges(panel, viewportOf(panel))) {
            if (one.region->id == "Face") return one.at;
        }
        return {};
    }
};

const Motion kAside{{1, 0, 60, 0, 1, 20, 0, 0, 1}};
/// Turned by a quarter about (80, 120), larger by half, and 50 px to the right.
const Motion kTurned{{0, -1.5, 80 + 180 + 50, 1.5, 0, 120 - 120, 0, 0, 1}};

}  // namespace

TEST_CASE("following canvas: label and clicks are where the thing is shown, not where it was painted") {
    Following f(kAside);
    f.desk.key(keys::letter('V'));
    const auto box = f.face().mask.coveredPixels();
    const auto middle = f.seen(0.5 * (box.x0 + box.x1), 0.5 * (box.y0 + box.y1));
    CHECK(f.badge().x == doctest::Approx(middle.x));
    CHECK(f.badge().y == doctest::Approx(middle.y));
    f.desk.state.selected.clear();
    f.desk.click(f.desk.at(40, 60));  // the paint is no longer seen here
    CHECK(f.desk.state.selected == kBackgroundId);
    f.desk.click(f.seen(40, 60));
    CHECK(f.desk.state.selected == "Face");
    // The label is taken hold of there as well; the distance that is dragged is the painted region's own.
    const auto at = f.badge();
    const Requests asked = f.desk.drag({at, {at.x, at.y - 20}, {at.x, at.y - 40}});
    REQUIRE(lastEdit<SetDistance>(asked, When::preview) != nullptr);
    CHECK(lastEdit<SetDistance>(asked, When::preview)->region == "Face");
    CHECK(std::get<ConstantDistance>(f.face().distance).value > 1.2_m);
}

TEST_CASE("following canvas: strokes and erasers land on the thing as it is shown, as large as the ring there") {
    for (const Motion& motion : {kAside, kTurned}) {
        Following f(motion);
        f.desk.state.eraser.radius = 9;
        f.desk.key(keys::letter('E'));
        const Requests asked = f.desk.drag({f.seen(60, 100), f.seen(80, 110), f.seen(110, 130)});
        const auto* paint = lastEdit<Paint>(asked, When::preview);
        REQUIRE(paint != nullptr);
        CHECK(paint->dabs.back().brush.radius == doctest::Approx(9 * scaleAt(motion.inverted(), {0, 0})));
        CHECK(f.desk.history.undoLabel() == "Erase");
        for (const auto& [x, y] : {std::pair{60, 100}, {70, 105}, {95, 120}, {110, 130}})
            CHECK(f.face().mask.at(x, y) < 30);
        CHECK(f.face().mask.at(60, 140) == 255);
        // Shift goes on from where it ended.
        ImGui::GetIO().KeyShift = true;
        f.desk.click(f.seen(110, 160));
        ImGui::GetIO().KeyShift = false;
        CHECK(f.face().mask.at(110, 145) < 30);
    }
}

TEST_CASE("following canvas: a brush held still on a thing that moves leaves one stroke on the thing") {
    Following f(Motion{});
    f.desk.state.eraser.radius = 5;
    f.desk.key(keys::letter('E'));
    const auto at = f.desk.at(110, 110);
    f.desk.move(at);
    f.desk.frame();
    ImGui::GetIO().MouseDown[0] = true;
    f.desk.frame();
    for (int i = 1; i <= 6; ++i) {
        f.motion.m[2] = 10.0 * i;
        f.desk.move({at.x + i % 2, at.y});  // a hand is never quite still
        f.desk.frame();
    }
    ImGui::GetIO().MouseDown[0] = false;
    f.desk.frame();
    for (int x = 50; x <= 110; x += 5)
        CHECK(f.face().mask.at(x, 110) < 30);
    CHECK(f.desk.history.undoLabel() == "Erase");
}

TEST_CASE("following canvas: shapes, boxes and clicks for a worker go back to where the thing was painted") {
    Following f(kTurned);
    const auto drag = [&](char key) {
        f.desk.key(keys::letter(key));
        return f.desk.drag({f.seen(140, 60), f.seen(150, 80), f.seen(180, 100)});
    };
    for (const char key : {'R', 'O', 'L'}) {
        const auto asked = drag(key);
        const auto* fill = lastEdit<FillShape>(asked, When::commit);
        REQUIRE(fill != nullptr);
        REQUIRE(std::holds_alternative<Outline>(fill->shape));
        double left = 1e9, bottom = -1e9;
        for (const auto& vertex : std::get<Outline>(fill->shape).vertices)
            left = std::min(left, vertex.x), bottom = std::max(bottom, vertex.y);
        CHECK(std::abs(left - 140) <= 1);
        CHECK(std::abs(bottom - 100) <= 1);
    }
    const auto boxed = drag('S');
    REQUIRE(first<SelectObject>(boxed) != nullptr);
    CHECK(std::abs(first<SelectObject>(boxed)->box.x0 - 140) <= 2);
    CHECK(std::abs(first<SelectObject>(boxed)->box.y1 - 100) <= 2);
    f.desk.key(keys::letter('W'));
    const auto flooded = f.desk.click(f.seen(100, 150));
    REQUIRE(first<SelectFlood>(flooded) != nullptr);
    CHECK(first<SelectFlood>(flooded)->at.x == doctest::Approx(100).epsilon(0.02));
    CHECK(first<SelectFlood>(flooded)->at.y == doctest::Approx(150).epsilon(0.02));
}

TEST_CASE("following canvas: vertices of an outline and points of a plane are taken hold of where they are shown") {
    Document document =
        *edited(Following::followingFace(), SetOutline{"Face", Outline{{{40, 60}, {120, 60}, {80, 180}}}});
    document = *edited(
        document, SetDistance{"Face", PlaneDistance{{{{{60, 150}, 1.0_m}, {{100, 150}, 1.0_m}, {{80, 80}, 1.1_m}}}}});
    Following f(kAside, document);
    f.desk.key(keys::letter('V'));
    f.desk.drag({f.seen(120, 60), f.seen(125, 62), f.seen(130, 65)});
    REQUIRE(f.face().outline);
    CHECK(f.face().outline->vertices[1].x == doctest::Approx(130).epsilon(0.02));
    CHECK(f.face().outline->vertices[1].y == doctest::Approx(65).epsilon(0.02));
    f.desk.drag({f.seen(100, 150), f.seen(102, 148), f.seen(104, 140)});
    const auto& anchor = std::get<PlaneDistance>(f.face().distance).anchors[1].at;
    CHECK(anchor.x == doctest::Approx(104).epsilon(0.02));
    CHECK(anchor.y == doctest::Approx(140).epsilon(0.02));
}

TEST_CASE("following canvas: what follows nothing is painted and clicked where it always was") {
    Following f(kAside);
    f.desk.state.selected = "Clutter";
    f.desk.key(keys::letter('R'));
    const auto asked = f.desk.drag({f.desk.at(200, 10), f.desk.at(220, 20), f.desk.at(240, 30)});
    const auto* fill = lastEdit<FillShape>(asked, When::commit);
    REQUIRE(fill != nullptr);
    CHECK(std::holds_alternative<Rectangle>(fill->shape));
}
