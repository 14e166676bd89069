// The measuring page: each state shows its words and its buttons, whatever the window's size, and asks for no more.
#include <doctest/doctest.h>

#include <cmath>
#include <set>

#include "tests/ui/headless.h"
#include "ui/measure_page.h"

using namespace ilf;
using namespace ilf::ui;
using namespace ilf::ui::test;
using Phase = MeasureView::State;

namespace {

/// Names of the child windows the page is made of, by the number ImGui gives them.
std::string childOf(const char* name) {
    for (const ImGuiWindow* window : ImGui::GetCurrentContext()->Windows) {
        if (std::string(window->Name).starts_with(std::string("###measure/") + name)) return window->Name;
    }
    return {};
}

MeasureView someView(Phase state, MeasureStanding standing = MeasureStanding::now) {
    MeasureView m;
    m.state = state;
    m.rig = "Some rig";
    m.emulated = true;
    m.steps = {{"Dark", "Laser off, room dark.", "A small, steady voltage.", MeasureStanding::good,
                "0.043 V, noise 12.0 mV, and a figure with so many words that its line must be broken", ""},
               {"Light through the lens", "Laser on.", "More than in the dark.", standing, "", "There is no light."},
               {"Waves", "Nothing to change.", "Waves that repeat.", MeasureStanding::waiting, "", ""}};
    m.at = 1;
    for (int i = 0; i <= 60; ++i) {
        m.photodiode.push_back({i * 0.8, 1.0 + 0.3 * std::sin(0.2 * i)});
        m.input0.push_back({i * 0.8, i % 20 < 2 ? 3.3 : 0.0});
        m.wave.push_back({i * 16.7 / 60.0, 2.0 * std::sin(0.1 * i)});
        m.drive.push_back({i * 16.7 / 60.0, 60.0 * std::sin(0.1 * i)});
    }
    m.powers = {{-60.0, -3.6}, {0.0, 0.5}, {60.0, 4.5}};
    m.known = {{-60.0, -3.61}, {60.0, 4.49}};
    return m;
}

struct Shown {
    explicit Shown(MeasureView view, Size window = {1280, 800}) : desk(twoRegions(), window), m(std::move(view)) {
        desk.dress = [this](View& shown) { shown.measuring = m; };
        desk.settle();
    }
    Requests press(const char* button) { return desk.press(childOf("###measureNow").c_str(), {button}); }
    bool asks(const char* button, Measure::Step step) {
        const Requests asked = press(button);
        const auto* found = first<Measure>(asked);
        return found != nullptr && found->step == step && asked.size() == 1;
    }

    Desk desk;
    MeasureView m;
};

}  // namespace

TEST_CASE("measure page: the button of Rig opens it, and says why simulated devices cannot be measured") {
    Desk desk(twoRegions(), {1280, 3000});
    desk.state.page = ui::Page::rig;
    desk.settle();
    const Requests asked = desk.press(pageWindow(ui::Page::rig), {"###measureOpen"});
    REQUIRE(first<Measure>(asked) != nullptr);
    CHECK(first<Measure>(asked)->step == Measure::Step::open);
    CoreStatus core;
    core.connected = true;
    CHECK(whyNotMeasured(core).find("choose the emulated rig") != std::string::npos);
    core.emulated = true;
    CHECK(whyNotMeasured(core).empty());
    core = {};
    core.connected = true;
    core.simulated = false;
    CHECK(whyNotMeasured(core).empty());
}

TEST_CASE("measure page: a form first, which gives what was typed") {
    MeasureView m = someView(Phase::setup);
    m.steps.clear();
    m.emulated = false;
    Shown page(m);
    page.desk.state.measure.known = "-50,-3\n50,3.5";
    page.desk.state.measure.temperature = "31.5";
    page.desk.settle();
    page.desk.press(childOf("###measureNow").c_str(), {"###measureEye", "Right"});
    page.desk.press(childOf("###measureNow").c_str(), {"###measureDelay", "Leave"});
    const Requests asked = page.press("###measureBegin");
    const auto* start = first<StartMeasuring>(asked);
    REQUIRE(start != nullptr);
    CHECK(start->setup.eye == Eye::right);
    CHECK_FALSE(start->setup.projector);
    CHECK(start->setup.known == "-50,-3\n50,3.5");
    CHECK(start->setup.temperature == "31.5");
    CHECK(page.asks("###measureCancel", Measure::Step::cancel));
}

TEST_CASE("measure page: each state offers what belongs to it, and Cancel wherever something is going on") {
    struct Case {
        Phase state;
        MeasureStanding standing;
        std::set<std::string> offered;
    };
    const char* const kButtons[] = {"###measureBegin", "###measureGo",    "###measureNext",   "###measureAgain",
                                    "###measureBack",  "###measureStore", "###measureCancel", "###measureUse"};
    for (const auto& [state, standing, offered] :
         {Case{Phase::preparing, MeasureStanding::now, {"###measureCancel"}},
          Case{Phase::connecting, MeasureStanding::now, {"###measureGo", "###measureBack", "###measureCancel"}},
          Case{Phase::working, MeasureStanding::working, {"###measureCancel"}},
          Case{Phase::judged,
               MeasureStanding::good,
               {"###measureNext", "###measureAgain", "###measureBack", "###measureCancel"}},
          Case{Phase::judged, MeasureStanding::bad, {"###measureAgain", "###measureBack", "###measureCancel"}},
          Case{Phase::good, MeasureStanding::good, {"###measureStore", "###measureBack", "###measureCancel"}},
          Case{Phase::storing, MeasureStanding::good, {}}, Case{Phase::ending, MeasureStanding::good, {}},
          Case{Phase::stored, MeasureStanding::good, {"###measureCancel"}}}) {
        CAPTURE(static_cast<int>(state));
        Shown page(someView(state, standing));
        for (const char* button : kButtons) {
            CAPTURE(std::string(button));
            const bool answered = !page.press(button).empty() || page.desk.state.fileDialog.has_value();
            if (page.desk.state.fileDialog) page.desk.press("###fileDialog", {"###cancel"});
            page.desk.settle();
            CHECK(answered == offered.contains(button));
        }
    }
    Shown hardware([] {
        MeasureView m = someView(Phase::stored, MeasureStanding::good);
        m.emulated = false;
        return m;
    }());
    CHECK(hardware.asks("###measureUse", Measure::Step::use));
}

TEST_CASE("measure page: storing asks for a name first") {
    Shown page(someView(Phase::good, MeasureStanding::good));
    page.m.eye = Eye::right;
    page.desk.settle();
    CHECK(page.press("###measureStore").empty());
    REQUIRE(page.desk.state.fileDialog);
    CHECK(page.desk.state.fileDialog->purpose == FileDialog::Purpose::storeWaves);
    CHECK(page.desk.state.fileDialog->name == "lens-right.ilflens");
    page.desk.state.fileDialog->folder = "/nonexistent-folder";
    page.desk.state.fileDialog->name = "mine";
    page.desk.settle();
    const Requests asked = page.desk.press("###fileDialog", {"###accept"});
    REQUIRE(first<StoreMeasured>(asked) != nullptr);
    CHECK(first<StoreMeasured>(asked)->path == "/nonexistent-folder/mine.ilflens");
}

TEST_CASE("measure page: SAFE LIGHT stays under the pointer, and the picture is not painted on meanwhile") {
    Shown page(someView(Phase::working, MeasureStanding::working));
    CHECK(ui::test::asks(page.desk.click({1280 - 60, 8}), Command::safeLight));
    CHECK(ui::test::asks(page.desk.key(keys::f(12)), Command::safeLight));
    const Document before = page.desk.document();
    const Rect canvas = page.desk.areas().canvas;
    page.desk.drag(
        {{canvas.x + canvas.w - 40, canvas.bottom() - 40}, {canvas.x + canvas.w - 140, canvas.bottom() - 60}});
    CHECK(page.desk.document() == before);
}

TEST_CASE("measure page: nothing is wider than its place, from small windows to large ones") {
    for (const Size window : {Size{900, 600}, Size{1280, 800}, Size{1600, 1000}}) {
        for (const Phase state : {Phase::setup, Phase::connecting, Phase::judged, Phase::good, Phase::stored}) {
            CAPTURE(window.width);
            CAPTURE(static_cast<int>(state));
            MeasureView view = someView(state, MeasureStanding::bad);
            if (state == Phase::setup) view.steps.clear();
            view.emulated = state != Phase::setup;
            Shown page(view, window);
            for (const char* child : {"###measureNow", "###measureSteps"}) {
                const ImGuiWindow* found = ImGui::FindWindowByName(childOf(child).c_str());
                if (found == nullptr) {
                    CHECK(state == Phase::setup);  // has no steps yet
                    continue;
                }
                CHECK(found->ContentSize.x <= found->Size.x);
                if (window.width >= 1280) CHECK(found->ContentSize.y <= found->Size.y);
            }
        }
    }
}

TEST_CASE("measure page: a chart's range holds its curve with room, and is never empty") {
    CHECK(rangeOf({}, 0.1).high > rangeOf({}, 0.1).low);
    const ChartRange flat = rangeOf({{0.0, 2.0}, {1.0, 2.0}}, 0.1);
    CHECK(flat.low < 2.0);
    CHECK(flat.high > 2.0);
    CHECK(flat.high - flat.low >= 0.1);
    const ChartRange steep = rangeOf({{0.0, -1.0}, {1.0, 3.0}}, 0.1);
    CHECK(steep.low < -1.0);
    CHECK(steep.high > 3.0);
}
