// The device panel: every device's state is said in words, and what keeps time is told only where it is measured.
#include <doctest/doctest.h>

#include <set>

#include "tests/ui/headless.h"
#include "ui/devices_card.h"

using namespace ilf;
using namespace ilf::ui;
using namespace ilf::ui::test;

namespace {

constexpr DeviceHealth kAll[] = {DeviceHealth::well, DeviceHealth::absent, DeviceHealth::unplugged,
                                 DeviceHealth::wrongMode, DeviceHealth::silent};

}  // namespace

TEST_CASE("devices card: every state has a word of its own") {
    std::set<std::string> words;
    for (const DeviceHealth health : kAll)
        words.insert(word(health));
    CHECK(words.size() == std::size(kAll));
    CHECK(words.count("") == 0);
}

TEST_CASE("devices card: emulated devices are not called simulated ones, nor hardware") {
    CoreStatus core;
    CHECK(kindOf(core) == "simulated");
    core.emulated = true;
    CHECK(kindOf(core) == "emulated");
    core = {};
    core.simulated = false;
    CHECK(kindOf(core) == "hardware");
}

TEST_CASE("devices card: timing is told where it is measured, and an unlocked sweep has no phase") {
    CoreStatus core;
    CHECK(timingRows(core).empty());
    core.timing = CoreStatus::Timing{true, 42.0_us, 7.0_us, -3.25, 2};
    core.lensTemperature_C = 31.25;
    const auto rows = timingRows(core);
    REQUIRE(rows.size() == 4);
    CHECK(rows[0].value == "42 \u00b5s, \u00b17 \u00b5s");
    CHECK(rows[1].value == "-3.2 ppm");
    CHECK(rows[2].value == "2 missed");
    CHECK(rows[3].value == "31.2 \u00b0C");
    core.timing->locked = false;
    CHECK(timingRows(core)[0].value == "not locked");
}

TEST_CASE("devices card: any mixture of devices fits on the narrowest page") {
    Desk desk(twoRegions(), {900, 600});
    desk.state.page = Page::rig;
    for (const DeviceHealth health : kAll) {
        desk.dress = [health](View& view) {
            const std::string place = "LightCrafter 4500 at USB 1-2.3.4 behind a hub with a very long name";
            view.core.devices = {{"projector", health, place, "Plug it in; TAKE plays again."},
                                 {"lenses", DeviceHealth::well, "", ""}};
            view.core.limits = {"Real-time priority is not allowed."};
        };
        desk.settle();
        const ImGuiWindow* page = ImGui::FindWindowByName(pageWindow(Page::rig));
        REQUIRE(page != nullptr);
        CHECK(page->ContentSize.x <= page->Size.x);
    }
}

TEST_CASE(
    "devices card: another rig waits for the operator's word while something plays, and for nothing in steady light") {
    Desk desk(twoRegions(), {1280, 3000});
    desk.state.page = Page::rig;
    desk.settle();
    const char* page = pageWindow(Page::rig);
    CHECK(first<UseRig>(desk.press(page, {"###rigKind", "Emulated"})) == nullptr);
    CHECK(desk.state.rigWanted == "emulated");
    desk.settle();
    CHECK(first<UseRig>(desk.press(page, {"###keepRig"})) == nullptr);
    CHECK(desk.state.rigWanted.empty());
    desk.press(page, {"###rigKind", "Emulated"});
    desk.settle();
    const Requests asked = desk.press(page, {"###changeRig"});
    REQUIRE(first<UseRig>(asked) != nullptr);
    CHECK(first<UseRig>(asked)->rig == "emulated");

    desk.dress = [](View& view) { view.core.light = Light::steady; };
    desk.settle();
    const Requests atOnce = desk.press(page, {"###rigKind", "Emulated"});
    REQUIRE(first<UseRig>(atOnce) != nullptr);
    CHECK(desk.state.rigWanted.empty());
}
