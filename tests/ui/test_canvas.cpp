// The pointer on the picture: strokes, shapes, handles, zoom.
#include <doctest/doctest.h>

#include "core/document/stroke.h"
#include "tests/ui/headless.h"
#include "ui/canvas.h"

using namespace ilf;
using namespace ilf::ui;
using namespace ilf::ui::test;
using When = EditRequest::When;

TEST_CASE("canvas: a stroke is previews while the button is down and one undo step when it is let go") {
    Desk desk(twoRegions());
    const Document before = desk.document();
    const std::size_t steps = desk.history.steps();
    const Requests asked = desk.drag({desk.at(100, 20), desk.at(140, 20), desk.at(200, 24), desk.at(240, 20)});
    const auto* paint = lastEdit<Paint>(asked, When::preview);
    REQUIRE(paint != nullptr);
    CHECK(paint->region == "Clutter");
    REQUIRE(first<CommitGesture>(asked) != nullptr);
    CHECK(desk.history.steps() == steps + 1);
    CHECK(desk.document().regions[0]->mask.at(170, 20) > 200);
    desk.key(keys::letter('Z'), true);
    CHECK(desk.document() == before);
}

TEST_CASE("canvas: a stroke whose positions all came within one frame paints all of them") {
    Desk desk(twoRegions());
    desk.state.brush.radius = 5;
    desk.move(desk.at(20, 10));
    desk.frame();
    for (const double x : {20.0, 80.0, 150.0, 300.0})
        desk.input.trail.push_back({desk.at(x, x == 80.0 ? 40 : 10), 0.0, true});
    ImGui::GetIO().MouseDown[0] = true;
    desk.frame();
    desk.input.trail = {{desk.at(300, 10), 0.0, false}};
    ImGui::GetIO().MouseDown[0] = false;
    desk.frame();
    const Mask& mask = desk.document().regions[0]->mask;
    CHECK(mask.at(80, 40) > 200);   // the corner between the samples
    CHECK(mask.at(225, 10) > 200);  // the way to the last
    CHECK(desk.history.undoLabel() == "Paint");
}

TEST_CASE("canvas: the dabs of a stroke do not depend on how many frames it took") {
    const auto painted = [](bool slowly) {
        Desk desk(twoRegions());
        desk.state.brush.radius = 7;
        desk.move(desk.at(20, 12));
        desk.frame();
        ImGui::GetIO().MouseDown[0] = true;
        for (int i = 0; i <= 20; ++i) {
            desk.input.trail.push_back({desk.at(20.0 + 10 * i, 12.0 + i % 3), 0.0, true});
            if (slowly) desk.frame();
        }
        desk.frame();
        ImGui::GetIO().MouseDown[0] = false;
        desk.frame();
        return desk.document().regions[0]->mask;
    };
    CHECK(painted(true) == painted(false));
}

TEST_CASE("canvas: Shift-click draws a straight line from where the last stroke ended") {
    Desk desk(twoRegions());
    desk.state.brush.radius = 4;
    desk.click(desk.at(30, 15));
    ImGui::GetIO().KeyShift = true;
    desk.click(desk.at(280, 15));
    ImGui::GetIO().KeyShift = false;
    CHECK(desk.document().regions[0]->mask.at(150, 15) > 200);
}

TEST_CASE("canvas: painting without a region makes one") {
    Desk desk(newDocument(twoRegions().scene));
    desk.drag({desk.at(50, 50), desk.at(90, 50)});
    REQUIRE(desk.document().regions.size() == 1);
    CHECK(desk.document().regions[0]->name == "Region 1");
    CHECK_FALSE(desk.document().regions[0]->mask.blank());
}

TEST_CASE("canvas: Escape in a stroke leaves nothing") {
    Desk desk(twoRegions());
    const Document before = desk.document();
    desk.move(desk.at(100, 20));
    desk.frame();
    ImGui::GetIO().MouseDown[0] = true;
    desk.frame();
    desk.move(desk.at(160, 20));
    desk.frame();
    CHECK_FALSE(desk.document() == before);
    CHECK(first<CancelGesture>(desk.key(keys::escape)) != nullptr);
    CHECK(desk.document() == before);
    ImGui::GetIO().MouseDown[0] = false;
    desk.settle();
    CHECK(desk.document() == before);
}

TEST_CASE("canvas: a polygon of three clicks and Enter is an outline whose vertices can be dragged and removed") {
    Desk desk(twoRegions());
    desk.press("###regions", {"###add"});
    desk.key(keys::letter('P'));
    for (const auto& at : {desk.at(40, 20), desk.at(120, 30), desk.at(80, 110), desk.at(20, 80)})
        desk.click(at);
    const auto* set = lastEdit<SetOutline>(desk.key(keys::enter), When::commit);
    REQUIRE(set != nullptr);
    CHECK(set->outline.vertices.size() == 4);
    REQUIRE(desk.document().regions[0]->outline);
    desk.drag({desk.at(120, 30), desk.at(140, 40), desk.at(150, 50)});
    CHECK(desk.document().regions[0]->outline->vertices[1].x == doctest::Approx(150).epsilon(0.02));
    desk.click(desk.at(150, 50), 1);
    CHECK(desk.document().regions[0]->outline->vertices.size() == 3);
}

TEST_CASE("canvas: Backspace takes the last vertex back, Escape the whole polygon") {
    Desk desk(twoRegions());
    desk.key(keys::letter('P'));
    desk.click(desk.at(40, 20));
    desk.click(desk.at(120, 30));
    desk.key(keys::backspace);
    CHECK(desk.state.polygon.size() == 1);
    desk.key(keys::escape);
    CHECK(desk.state.polygon.empty());
}

TEST_CASE("canvas: rectangle, ellipse and lasso fill on release; select and flood ask a worker") {
    Desk desk(twoRegions());
    const auto fill = [&](char key) {
        desk.key(keys::letter(key));
        return desk.drag({desk.at(20, 10), desk.at(60, 30), desk.at(80, 50)});
    };
    const Requests rectangle = fill('R');
    CHECK(std::holds_alternative<Rectangle>(lastEdit<FillShape>(rectangle, When::commit)->shape));
    const Requests ellipse = fill('O');
    CHECK(std::holds_alternative<Ellipse>(lastEdit<FillShape>(ellipse, When::commit)->shape));
    const Requests lasso = fill('L');
    CHECK(std::holds_alternative<Outline>(lastEdit<FillShape>(lasso, When::commit)->shape));
    const Requests box = fill('S');
    REQUIRE(first<SelectObject>(box) != nullptr);
    CHECK(first<SelectObject>(box)->box.width() == doctest::Approx(60).epsilon(0.05));
    desk.key(keys::letter('W'));
    CHECK(first<SelectFlood>(desk.click(desk.at(160, 20))) != nullptr);
}

TEST_CASE("canvas: dragging with D held scrubs the distance of what lies there; the key alone does not") {
    Desk desk(twoRegions());
    desk.input.pressed.push_back({keys::letter('D')});
    desk.frame();
    const Requests asked = desk.drag({desk.at(240, 120), desk.at(240, 100), desk.at(240, 80)});
    CHECK(lastEdit<SetDistance>(asked, When::preview) != nullptr);
    CHECK(desk.history.undoLabel() == "Set distance");
    CHECK(std::get<ConstantDistance>(findRegion(desk.document(), "Clutter")->distance).value > 0.5_m);
    desk.input.released.push_back({keys::letter('D')});
    desk.settle();
    CHECK(desk.state.field.editing == 0);
}

TEST_CASE("canvas: an optical centre dragged with the pointer moves that eye's axis") {
    Desk desk(twoRegions());
    desk.key(keys::letter('V'));
    const auto left = opticalCentre(desk.document(), Eye::left, 0.5_m);
    const double before = desk.document().wearer.axis(Eye::left).right.si();
    const auto at = desk.at(left.x, left.y);
    desk.drag({at, {at.x - 10, at.y}, {at.x - 20, at.y}});
    CHECK(desk.document().wearer.axis(Eye::left).right.si() < before);
    CHECK(desk.document().wearer.axis(Eye::right) == Wearer{}.axis(Eye::right));
}

TEST_CASE("canvas: the pointer selects the region it clicks, and the background beside them") {
    Desk desk(twoRegions());
    desk.key(keys::letter('V'));
    desk.click(desk.at(60, 60));
    CHECK(desk.state.selected == "Face");
    desk.click(desk.at(310, 10));
    CHECK(desk.state.selected == kBackgroundId);
}

TEST_CASE("canvas: the wheel zooms about the cursor, Space and drag pans, F fits again") {
    Desk desk(twoRegions());
    const auto at = desk.at(100, 100);
    desk.move(at);
    desk.frame();
    const double before = desk.state.zoom;
    ImGui::GetIO().MouseWheel = 3;
    desk.frame();
    desk.frame();
    CHECK(desk.state.zoom > before);
    CHECK(desk.at(100, 100).x == doctest::Approx(at.x).epsilon(0.01));
    desk.input.pressed.push_back({keys::space});
    desk.frame();
    const auto centre = desk.state.centre;
    CHECK(lastEdit<Paint>(desk.drag({at, {at.x + 30, at.y}, {at.x + 60, at.y}}), When::preview) == nullptr);
    CHECK(desk.state.centre.x < centre.x);
    desk.input.released.push_back({keys::space});
    desk.frame();
    desk.key(keys::letter('F'));
    CHECK(desk.state.zoom == doctest::Approx(before));
}

TEST_CASE("canvas: a point dragged on the blur-range chart sets its region's distance") {
    Desk desk(twoRegions());
    const Rect chart = desk.areas().blurRange;
    const auto widget = [&] {
        return ImHashStr("###object", 0, ImHashStr("Clutter", 0, Headless::id("###blurRange", {})));
    };
    Point<WidgetFrame> at{};
    for (double y = chart.y + 10; y < chart.bottom() && at.x == 0; y += 8) {
        for (double x = chart.x + 10; x < chart.right(); x += 8) {
            desk.move({x, y});
            desk.frame();
            if (ImGui::GetHoveredID() == widget()) {
                at = {x, y};
                break;
            }
        }
    }
    REQUIRE(at.x > 0);
    const Requests asked = desk.drag({at, {at.x + 20, at.y}, {at.x + 40, at.y}});
    CHECK(lastEdit<SetDistance>(asked, When::preview) != nullptr);
    CHECK(first<CommitGesture>(asked) != nullptr);
    CHECK(std::get<ConstantDistance>(findRegion(desk.document(), "Clutter")->distance).value > 0.5_m);
}

TEST_CASE("wants: only what is shown is worked out") {
    State state;
    CHECK_FALSE(wants(state).perceivedLeft);
    state.mode = ViewMode::perceived;
    state.eye = Eye::right;
    CHECK(wants(state).perceivedRight);
    CHECK_FALSE(wants(state).perceivedLeft);
    CHECK_FALSE(wants(state).plain);
    state.mode = ViewMode::compare;
    CHECK(wants(state).plain);
}
