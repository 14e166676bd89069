// Panels driven without a window: clicks and typed numbers become edits, keys become commands.
#include <doctest/doctest.h>

#include "tests/ui/headless.h"

using namespace ilf;
using namespace ilf::ui;
using namespace ilf::ui::test;
using When = EditRequest::When;

TEST_CASE("panels: a window at rest asks for nothing") {
    Desk desk(twoRegions());
    CHECK(desk.frame().empty());
    CHECK(desk.state.selected == "Clutter");
}

TEST_CASE("panels: a click on a look sets it") {
    Desk desk(twoRegions());
    const Requests asked = desk.press(pageWindow(Page::selected), {"region", "###look", "focus"});
    const auto* set = lastEdit<SetLook>(asked, When::commit);
    REQUIRE(set != nullptr);
    CHECK(set->region == "Clutter");
    CHECK(set->look == Look::focus);
    CHECK(findRegion(desk.document(), "Clutter")->look == Look::focus);
}

TEST_CASE("panels: a distance typed as 50 cm becomes half a metre") {
    Desk desk(twoRegions());
    desk.state.selected = "Face";
    desk.press(pageWindow(Page::selected), {"region", "###distance"});
    desk.settle();
    const Requests asked = desk.type("50 cm");
    const auto* set = lastEdit<SetDistance>(asked, When::commit);
    REQUIRE(set != nullptr);
    CHECK(set->region == "Face");
    CHECK(std::get<ConstantDistance>(set->distance).value.si() == doctest::Approx(0.5));
    CHECK(desk.state.field.editing == 0);
}

TEST_CASE("panels: a text that is no distance is refused with a sentence and changes nothing") {
    Desk desk(twoRegions());
    const Document before = desk.document();
    desk.press(pageWindow(Page::selected), {"region", "###distance"});
    desk.settle();
    CHECK(lastEdit<SetDistance>(desk.type("far away"), When::commit) == nullptr);
    CHECK(desk.document() == before);
    CHECK(desk.state.field.refusal.starts_with("\"far away\" is not a number."));
}

TEST_CASE("panels: the key of a distance opens its field") {
    Desk desk(twoRegions());
    desk.key(keys::letter('D'));
    desk.settle();
    CHECK(desk.state.field.editing == Headless::id(pageWindow(Page::selected), {"region", "###distance"}));
}

TEST_CASE("panels: a key pressed and let go within one frame acts and is not held") {
    Desk desk(twoRegions());
    desk.input.pressed = desk.input.released = {{keys::letter('D')}};
    desk.frame();
    desk.input.pressed = desk.input.released = {{keys::space}};
    desk.frame();
    CHECK_FALSE(desk.state.distanceHeld);
    CHECK_FALSE(desk.state.panHeld);
    CHECK(desk.state.field.editing != 0);
}

TEST_CASE("panels: a field is scrubbed by previews and one commit") {
    Desk desk(twoRegions());
    desk.state.page = Page::wearer;
    desk.settle();
    // The pupil is the second row; its field fills the right of the page.
    const ImGuiID pupil = Headless::id(pageWindow(Page::wearer), {"###pupil"});
    const Rect page = desk.areas().pages;
    Point<WidgetFrame> at{page.right() - 60, page.y};
    for (; at.y < page.bottom(); at.y += 4) {
        desk.move(at);
        desk.settle();
        if (ImGui::GetHoveredID() == pupil) break;
    }
    REQUIRE(ImGui::GetHoveredID() == pupil);
    const Metre before = desk.document().wearer.pupil;
    const std::size_t steps = desk.history.steps();
    const Requests asked = desk.drag({at, {at.x + 10, at.y}, {at.x + 30, at.y}, {at.x + 50, at.y}});
    CHECK(lastEdit<SetWearer>(asked, When::preview) != nullptr);
    REQUIRE(lastEdit<SetWearer>(asked, When::commit) != nullptr);
    CHECK(desk.document().wearer.pupil > before);
    CHECK(desk.history.steps() == steps + 1);
}

TEST_CASE("panels: keys run commands: undo, looks, tools, and TAKE and SAFE LIGHT reach the app") {
    Desk desk(twoRegions());
    CHECK(lastEdit<SetLook>(desk.key(keys::digit3), When::commit)->look == Look::neutral);
    CHECK(asks(desk.key(keys::letter('Z'), true), Command::undo));
    CHECK(findRegion(desk.document(), "Clutter")->look == Look::blur);
    CHECK(asks(desk.key(keys::enter, true), Command::take));
    CHECK(asks(desk.key(keys::f(12)), Command::safeLight));
    desk.key(keys::letter('P'));
    CHECK(desk.state.tool == Tool::polygon);
}

TEST_CASE("panels: TAKE and SAFE LIGHT are buttons of at least 44 pixels, with and without panels") {
    Desk desk(twoRegions());
    for (const bool hidden : {false, true}) {
        desk.state.panels.hidden = hidden;
        desk.settle();
        CHECK(asks(desk.press("###top", {"###safeLight"}), Command::safeLight));
        CHECK(asks(desk.press("###top", {"###take"}), Command::take));
        CHECK(asks(desk.click({1280 - 60, 8}), Command::safeLight));
        CHECK(asks(desk.click({1280 - 60, 48}), Command::safeLight));
    }
}

TEST_CASE("panels: SAFE LIGHT answers its key even over a dialog and in a text field") {
    Desk desk(twoRegions());
    desk.key(keys::slash, false, true);
    desk.settle();
    CHECK(desk.state.shortcutsOpen);
    CHECK(asks(desk.key(keys::f(12)), Command::safeLight));
    desk.nativeKey(keys::escape);
    desk.settle();
    CHECK_FALSE(desk.state.shortcutsOpen);
    desk.press(pageWindow(Page::selected), {"region", "###distance"});
    desk.settle();
    CHECK(asks(desk.key(keys::f(12)), Command::safeLight));
    CHECK(desk.key(keys::letter('B')).empty());
}

TEST_CASE("panels: regions are added, renamed, hidden, reordered, duplicated and deleted") {
    Desk desk(twoRegions());
    desk.press("###regions", {"###add"});
    REQUIRE(desk.document().regions.size() == 3);
    CHECK(desk.document().regions[0]->name == "Region 3");
    CHECK(desk.state.selected == desk.document().regions[0]->id);
    desk.key(keys::f(2));
    desk.settle();
    desk.type("Vase");
    CHECK(desk.document().regions[0]->name == "Vase");
    desk.key(keys::down, true);
    CHECK(desk.document().regions[1]->name == "Vase");
    desk.key(keys::letter('H'));
    CHECK_FALSE(desk.document().regions[1]->visible);
    desk.key(keys::letter('D'), true);
    CHECK(desk.document().regions.size() == 4);
    desk.key(keys::del);
    desk.key(keys::del);
    CHECK(desk.document().regions.size() == 2);
}

TEST_CASE("panels: a project is saved through the file dialog") {
    Desk desk(twoRegions());
    CHECK(desk.key(keys::letter('S'), true).empty());
    desk.settle();
    REQUIRE(desk.state.fileDialog);
    CHECK(desk.state.fileDialog->purpose == FileDialog::Purpose::saveAs);
    desk.state.fileDialog->name = "no such project yet";
    const Requests asked = desk.press("###fileDialog", {"###accept"});
    REQUIRE(first<SaveFile>(asked) != nullptr);
    CHECK(first<SaveFile>(asked)->path.ends_with("no such project yet.ilf"));
    CHECK_FALSE(desk.state.fileDialog);
}

TEST_CASE("panels: the recovery question has an answer for each button") {
    Desk desk(twoRegions());
    desk.state.recovery = RecoveryQuestion{"\"Museum\"", true};
    desk.settle();
    const Requests asked = desk.press("###recovery", {"###recover"});
    REQUIRE(first<Recover>(asked) != nullptr);
    CHECK(first<Recover>(asked)->choice == Recover::Choice::recover);
    CHECK_FALSE(desk.state.recovery);
}

TEST_CASE("panels: an error stays until it is dismissed, a note goes by itself") {
    Desk desk(twoRegions());
    say(desk.state, "It can not be.", Tone::error, 0.0);
    say(desk.state, "Saved.", Tone::note, 0.0);
    for (int i = 0; i < 400; ++i)
        desk.frame();
    REQUIRE(desk.state.toasts.size() == 1);
    CHECK(desk.state.toasts[0].text == "It can not be.");
    desk.press("###toast0", {"###dismiss"});
    CHECK(desk.state.toasts.empty());
}

TEST_CASE("panels: a hint goes when what it speaks of was done once") {
    Desk desk(twoRegions());
    desk.state.hintsUsed.clear();
    desk.frame();
    desk.key(keys::enter, true);
    CHECK(desk.state.hintsUsed == std::set<Hint>{Hint::take});
    desk.press("###hint", {"###gotIt"});
    CHECK(desk.state.hintsUsed.contains(Hint::brush));
}

TEST_CASE("panels: every page and view draws at every size, with and without a plan, a core and a camera") {
    for (const auto& [window, scale] :
         {std::pair{Size{1280, 720}, 1.0}, {Size{2560, 1440}, 2.0}, {Size{640, 400}, 1.0}}) {
        for (const bool bare : {false, true}) {
            Desk desk(bare ? newDocument({}) : twoRegions(), window, scale);
            desk.dress = [&](View& view) {
                if (bare) view.computed.plan.reset(), view.core.connected = false;
                view.core.lastFault = bare ? "The lens does not answer." : "";
                view.core.faultSeen = false;
                view.camera.open = !bare;
                view.camera.isVideoFile = true;
                view.cameras = {"front"};
                view.recent = {{"/nowhere/a.ilf", "a.ilf"}};
                view.historyLabels = {"", "Paint"};
            };
            for (int page = 0; page <= static_cast<int>(Page::history); ++page) {
                for (int mode = 0; mode <= static_cast<int>(ViewMode::compare); ++mode) {
                    desk.state.page = static_cast<Page>(page);
                    desk.state.mode = static_cast<ViewMode>(mode);
                    CHECK(desk.frame().empty());
                }
            }
        }
    }
}
