// How perceived views are looked at, and what the debug panel says of them.
#include <doctest/doctest.h>

#include "tests/ui/headless.h"
#include "ui/debug_panel.h"

using namespace ilf;
using namespace ilf::ui;
using namespace ilf::ui::test;
using When = EditRequest::When;

namespace {

/// What is scrolled out of sight cannot be pressed: here all of a page is in sight.
constexpr Size kTall{1280, 2200};

/// Presses a widget of the wearer's page.
void pressOnWearerPage(Desk& desk, std::initializer_list<const char*> path) {
    desk.state.page = Page::wearer;
    desk.settle();
    desk.press(pageWindow(Page::wearer), path);
}

}  // namespace

TEST_CASE("seeing: the gaze is turned by a click, onto the point and what is there, and no edit is made") {
    Desk desk(twoRegions(), kTall);
    const Document before = desk.document();
    desk.state.mode = ViewMode::perceived;
    pressOnWearerPage(desk, {"###gaze", "point"});
    CHECK(desk.state.placingGaze);
    CHECK(desk.state.seeing.gaze == Gaze::ahead);
    const Requests asked = desk.click(desk.at(240, 120));
    CHECK(lastEdit<Paint>(asked, When::commit) == nullptr);
    CHECK_FALSE(desk.state.placingGaze);
    CHECK(desk.state.seeing.gaze == Gaze::fixed);
    CHECK(desk.state.seeing.gazeAt.x == doctest::Approx(240).epsilon(0.02));
    CHECK(desk.state.seeing.attending.value_or("nothing") == "Clutter");
    CHECK(wants(desk.state).seeing == desk.state.seeing);
    pressOnWearerPage(desk, {"###gaze", "follows"});
    CHECK(desk.state.seeing.gaze == Gaze::follows);
    CHECK(desk.document() == before);
}

TEST_CASE("seeing: Esc leaves the gaze where it was") {
    Desk desk(twoRegions(), kTall);
    pressOnWearerPage(desk, {"###gaze", "point"});
    REQUIRE(desk.state.placingGaze);
    desk.key(keys::escape);
    CHECK_FALSE(desk.state.placingGaze);
    CHECK(desk.state.seeing == ViewRequest{});
}

TEST_CASE("seeing: the key looks at what is under the cursor") {
    Desk desk(twoRegions(), kTall);
    desk.move(desk.at(80, 120));
    desk.settle();
    desk.key(keys::letter('G'));
    CHECK(desk.state.seeing.gaze == Gaze::fixed);
    CHECK(desk.state.seeing.attending.value_or("nothing") == "Face");
}

TEST_CASE("seeing: the rim is switched on; colours wait for a rig that knows its primaries") {
    Desk desk(twoRegions(), kTall);
    pressOnWearerPage(desk, {"###lensField", "on"});
    CHECK(desk.state.seeing.lensField);
    pressOnWearerPage(desk, {"###chromatic", "on"});
    CHECK_FALSE(desk.state.seeing.chromatic);
    Rig rig = desk.document().rig;
    rig.primaries = {623e-9_m, 530e-9_m, 460e-9_m};
    desk.history.preview(*edited(desk.document(), SetRig{rig}));
    desk.history.commit("Rig");
    pressOnWearerPage(desk, {"###chromatic", "on"});
    CHECK(desk.state.seeing.chromatic);
}

TEST_CASE("seeing: primaries are edited as three wavelengths, and their order is checked") {
    Desk desk(twoRegions(), {1280, 3200});  // the devices lie above the numbers
    Rig rig = desk.document().rig;
    rig.primaries = {623e-9_m, 530e-9_m, 460e-9_m};
    desk.history.preview(*edited(desk.document(), SetRig{rig}));
    desk.history.commit("Rig");
    desk.state.page = Page::rig;
    desk.settle();
    desk.press(pageWindow(Page::rig), {"###green"});
    desk.settle();
    const Requests asked = desk.type("525");
    const auto* set = lastEdit<SetRig>(asked, When::commit);
    REQUIRE(set != nullptr);
    CHECK((*set->rig.primaries)[1].si() == doctest::Approx(525e-9));
    CHECK((*set->rig.primaries)[0] == 623e-9_m);
    desk.press(pageWindow(Page::rig), {"###green"});
    desk.settle();
    desk.type("700");
    CHECK((*desk.document().rig.primaries)[1].si() == doctest::Approx(525e-9));
    CHECK(desk.refusal.find("fall from red over green to blue") != std::string::npos);
}

TEST_CASE("debug panel: it says what was computed and what was left out, and why") {
    Computed computed;
    computed.viewRung = "while dragging";
    computed.view_ms = 2.5;
    ViewCounters counters;
    counters.tiles = 100;
    counters.computed = 7;
    counters.unchanged = 90;
    counters.plain = 2;
    counters.dark = 1;
    counters.hidden = 5;
    computed.viewCounters = counters;
    computed.frameOwn_ms = 1.25;
    const auto sections = debugSections(computed);
    const auto value = [&](const std::string& label) -> std::string {
        for (const auto& section : sections)
            for (const auto& row : section.rows)
                if (row.label == label) return row.value;
        return "absent";
    };
    CHECK(sections.front().title == "VIEW, while dragging");
    CHECK(value("tiles computed") == "7 of 100");
    CHECK(value("  unchanged") == "90");
    CHECK(value("  hidden") == "5");
    CHECK(value("in all") == "2.50 ms");
    CHECK(value("own work") == "1.25 ms");
    CHECK(value("compile") == "absent");  // nothing was compiled yet
}

TEST_CASE("debug panel: its key opens and closes it, and it lies over the picture only") {
    Desk desk(twoRegions(), kTall);
    CHECK(Headless::id("###debug", {}) == 0);
    desk.key(keys::f(3));
    desk.settle();
    CHECK(desk.state.debugOpen);
    const ImGuiWindow* panel = ImGui::FindWindowByName("###debug");
    REQUIRE(panel != nullptr);
    const auto& order = ImGui::GetCurrentContext()->Windows;  // back to front
    CHECK(order.index_from_ptr(order.find(const_cast<ImGuiWindow*>(panel))) >
          order.index_from_ptr(order.find(ImGui::FindWindowByName("###canvas"))));
    const Rect canvas = desk.areas().canvas;
    CHECK(panel->Pos.x >= canvas.x);
    CHECK(panel->Pos.y + panel->Size.y <= canvas.bottom() + 0.5);
    desk.key(keys::f(3));
    CHECK_FALSE(desk.state.debugOpen);
}
