// The registering page: each state shows its buttons, clicks on the picture are where they were made, TAKE waits.
#include <doctest/doctest.h>

#include "tests/ui/headless.h"
#include "ui/new_region.h"
#include "ui/register_page.h"

using namespace ilf;
using namespace ilf::ui;
using namespace ilf::ui::test;
using Phase = RegisterView::State;
using Step = Register::Step;

namespace {

std::string column() {
    for (const ImGuiWindow* window : ImGui::GetCurrentContext()->Windows) {
        if (std::string(window->Name).starts_with("###register/###registerNow")) return window->Name;
    }
    return {};
}

RegisterView someView(RegisterWay way = RegisterWay::scan, Phase state = Phase::ready) {
    RegisterView r;
    r.way = way;
    r.state = state;
    r.camera = "emulated";
    r.emulated = true;
    r.picture = Image<std::uint8_t>({640, 480}, 3, std::vector<std::uint8_t>(3 * 640 * 480, 90));
    r.corners = {{{100, 80}, {540, 90}, {530, 400}, {90, 410}}};
    r.legend = qualityLegend();
    r.doing = "Stripes down, 4 of 10";
    r.done = 8;
    r.all = 44;
    return r;
}

struct Shown {
    explicit Shown(RegisterView view, Size window = {1280, 800}) : desk(twoRegions(), window), r(std::move(view)) {
        desk.dress = [this](View& shown) {
            shown.registering = r;
            shown.camera.open = true;
            shown.cameras = {"simulated", "emulated"};
        };
        desk.settle();
    }
    Requests press(const char* button) { return desk.press(column().c_str(), {button}); }
    bool asks(const char* button, Step step) {
        const Requests asked = press(button);
        const auto* found = first<Register>(asked);
        return found != nullptr && found->step == step && asked.size() == 1;
    }
    Point<WidgetFrame> at(double x, double y) const {
        return registerViewport(r, registerPictureArea(desk.areas(), 1.0)).toWindow({x, y});
    }

    Desk desk;
    RegisterView r;
};

RegisterFound someFound() {
    RegisterFound found;
    found.rms_px = 0.21;
    found.worst_px = 0.4;
    found.points = 700000;
    found.provenance = "emulated";
    found.depth = RegisterDepth{0.9_m, 1.2_m, 2.0_mm, 0.97, 1.0_mm, 8.0_mm, {}, {}};
    found.depth->metres = Image<float>({640, 480}, 1, std::vector<float>(640 * 480, 1.0F));
    found.depth->spread = Image<float>({640, 480}, 1, std::vector<float>(640 * 480, 0.002F));
    return found;
}

}  // namespace

TEST_CASE("register page: the card of Rig and a key open it, and not twice") {
    {
        Desk desk(twoRegions(), {1280, 3000});
        desk.state.page = ui::Page::rig;
        desk.settle();
        const Requests asked = desk.press(pageWindow(ui::Page::rig), {"###registerOpen"});
        REQUIRE(first<Register>(asked) != nullptr);
        CHECK(first<Register>(asked)->step == Step::open);
        const Requests byKey = desk.key(info(Command::registerCamera).key.key);
        REQUIRE(first<Register>(byKey) != nullptr);
        CHECK(first<Register>(byKey)->step == Step::open);
    }
    Shown shown(someView());
    CHECK(first<Register>(shown.desk.key(info(Command::registerCamera).key.key)) == nullptr);
}

TEST_CASE("register page: every way is at hand wherever the camera is free, and each has its buttons") {
    for (const RegisterWay way :
         {RegisterWay::scan, RegisterWay::corners, RegisterWay::pairs, RegisterWay::board, RegisterWay::calibration}) {
        Shown shown(someView(way));
        const Requests asked = shown.desk.press(column().c_str(), {"###registerWay", "Pairs"});
        REQUIRE(first<ChooseRegisterWay>(asked) != nullptr);
        CHECK(first<ChooseRegisterWay>(asked)->way == RegisterWay::pairs);
        CHECK(shown.asks("###registerClose", Step::close));
        CHECK(shown.asks("###registerScan", Step::scan) == (way == RegisterWay::scan));
        CHECK(shown.asks("###registerLight", Step::light) == (way == RegisterWay::scan));
        CHECK(shown.asks("###registerMarks", Step::marks) ==
              (way == RegisterWay::corners || way == RegisterWay::pairs));
        CHECK(shown.asks("###registerBoard", Step::board) == (way == RegisterWay::board));
        CHECK(shown.asks("###registerPose", Step::pose) == (way == RegisterWay::calibration));
        CHECK(shown.press("###registerAccept").empty());
        CHECK(shown.press("###registerCancel").empty());
    }
}

TEST_CASE("register page: what the operator said goes along with the scan") {
    Shown shown(someView());
    shown.press("###registerAnyway");
    const Requests asked = shown.press("###registerScan");
    REQUIRE(first<Register>(asked) != nullptr);
    CHECK(first<Register>(asked)->setup.anyway);
}

TEST_CASE("register page: while patterns are shown there is cancel and nothing else, and TAKE says why it waits") {
    Shown shown(someView(RegisterWay::scan, Phase::working));
    CHECK(shown.asks("###registerCancel", Step::cancel));
    CHECK(shown.press("###registerClose").empty());
    CHECK(shown.press("###registerScan").empty());
    CHECK_FALSE(asks(shown.desk.key(keys::enter, true), Command::take));
    REQUIRE_FALSE(shown.desk.state.toasts.empty());
    CHECK(shown.desk.state.toasts.back().text.find("cancel that first") != std::string::npos);
    CHECK(asks(shown.desk.key(keys::f(12)), Command::safeLight));
    shown.r = someView(RegisterWay::corners);
    shown.r.showsMarks = true;
    shown.desk.settle();
    CHECK_FALSE(asks(shown.desk.key(keys::enter, true), Command::take));
    shown.r.showsMarks = false;
    shown.desk.settle();
    CHECK(asks(shown.desk.key(keys::enter, true), Command::take));
}

TEST_CASE("register page: a corner that is dragged goes where the pointer is, the others stay") {
    Shown shown(someView(RegisterWay::corners));
    const Requests asked = shown.desk.drag({shown.at(540, 90), shown.at(500, 60), shown.at(520, 70)});
    const PlaceCorner* last = nullptr;
    for (const Request& request : asked) {
        if (const auto* placed = std::get_if<PlaceCorner>(&request)) {
            last = placed;
            CHECK(placed->corner == 1);
        }
    }
    REQUIRE(last != nullptr);
    CHECK(last->at.x == doctest::Approx(520).epsilon(0.005));
    CHECK(last->at.y == doctest::Approx(70).epsilon(0.02));
    CHECK(first<PlaceCorner>(shown.desk.drag({shown.at(320, 240), shown.at(330, 250)})) == nullptr);
}

TEST_CASE("register page: a click is a pair only while a cross is shown") {
    RegisterView view = someView(RegisterWay::pairs);
    view.pairs = {{{{10, 20}, {30, 40}}}, {{{50, 20}, {90, 40}}}};
    Shown shown(view);
    CHECK(first<PlaceCross>(shown.desk.click(shown.at(200, 100))) == nullptr);
    shown.r.showsMarks = true;
    const Requests asked = shown.desk.click(shown.at(200, 100));
    REQUIRE(first<PlaceCross>(asked) != nullptr);
    CHECK(first<PlaceCross>(asked)->at.x == doctest::Approx(200).epsilon(0.01));
    CHECK(first<PlaceCross>(asked)->at.y == doctest::Approx(100).epsilon(0.02));
    CHECK(shown.asks("###registerAnother", Step::another));
    shown.r.targetsLeft = false;
    CHECK(first<PlaceCross>(shown.desk.click(shown.at(200, 100))) == nullptr);
}

TEST_CASE("register page: a pair is deleted by its own button") {
    RegisterView view = someView(RegisterWay::pairs);
    view.pairs = {{{{10, 20}, {30, 40}}, 0.4, true, true}, {{{50, 20}, {90, 40}}, 9.0, true, false}};
    view.worst = 1;
    Shown shown(view);
    const std::string name = column();
    ImGuiWindow* window = ImGui::FindWindowByName(name.c_str());
    REQUIRE(window != nullptr);
    const int second = 1;
    ImGui::ActivateItem(ImHashStr("###registerRemove", 0, ImHashData(&second, sizeof second, window->ID)));
    Requests asked = shown.desk.frame();
    for (const Request& request : shown.desk.frame())
        asked.push_back(request);
    REQUIRE(first<RemovePair>(asked) != nullptr);
    CHECK(first<RemovePair>(asked)->pair == 1);
}

TEST_CASE("register page: what was found can be accepted, with or without its picture") {
    RegisterView view = someView();
    view.found = someFound();
    Shown shown(view);
    Requests asked = shown.press("###registerAccept");
    REQUIRE(first<Register>(asked) != nullptr);
    CHECK(first<Register>(asked)->step == Step::accept);
    CHECK(first<Register>(asked)->setup.asScene);
    shown.press("###registerAsScene");
    asked = shown.press("###registerAccept");
    REQUIRE(first<Register>(asked) != nullptr);
    CHECK_FALSE(first<Register>(asked)->setup.asScene);
    shown.r.state = Phase::accepted;
    CHECK(shown.press("###registerAccept").empty());
    CHECK(shown.asks("###registerClose", Step::close));
}

TEST_CASE("register page: findings, legend, light and refusals find room in every window") {
    for (const Size window : {Size{640, 400}, Size{1280, 720}, Size{3840, 2160}}) {
        for (const Phase state : {Phase::ready, Phase::working, Phase::stopping, Phase::accepted}) {
            RegisterView view = someView(RegisterWay::scan, state);
            view.found = someFound();
            view.light = RegisterLight{false, "The room is too bright: draw the curtains.", 0.2, 9.0, 0.033};
            view.findings = {{ScanFault::moved, ScanFinding::Weight::failure, "Something moved.", {10, 20, 300, 200}}};
            view.decodedShare = 0.42;
            view.trouble = "The map was made but does not hold.";
            view.shows = RegisterPicture::quality;
            view.hasQuality = view.hasDepth = true;
            Shown shown(view, window);
            const Rect area = registerPictureArea(shown.desk.areas(), 1.0);
            CHECK(area.x >= 0);
            CHECK(area.right() <= window.width);
            CHECK(area.bottom() <= window.height);
            if (state != Phase::ready) continue;
            const Requests asked = shown.desk.press(column().c_str(), {"###registerShows", "Depth"});
            REQUIRE(first<ShowRegisterPicture>(asked) != nullptr);
            CHECK(first<ShowRegisterPicture>(asked)->what == RegisterPicture::depth);
            const Requests spread = shown.desk.press(column().c_str(), {"###registerShows", "Its \u00b1"});
            REQUIRE(first<ShowRegisterPicture>(spread) != nullptr);
            CHECK(first<ShowRegisterPicture>(spread)->what == RegisterPicture::spread);
            shown.r.shows = RegisterPicture::spread;
            shown.r.ramp = {{0, 0, 0}, {255, 255, 0}};
            shown.desk.move(shown.at(320, 240));
            shown.desk.settle();
        }
    }
}

TEST_CASE(
    "register page: a calibration shows poses with their residuals, what was found and why not, and is accepted") {
    RegisterView view = someView(RegisterWay::calibration);
    view.calibration.poses = {{"Pose 1", 54, 54, true, true, 0.08, 0.11}, {"Pose 2", 54, 40, true, false, 0.0, 0.0}};
    view.calibration.refused = "One pose tells no focal length.";
    Shown shown(view);
    CHECK(shown.press("###calibrationAccept").empty());
    const std::string name = column();
    ImGuiWindow* window = ImGui::FindWindowByName(name.c_str());
    REQUIRE(window != nullptr);
    const int second = 1;
    ImGui::ActivateItem(ImHashStr("###poseRemove", 0, ImHashData(&second, sizeof second, window->ID)));
    Requests asked = shown.desk.frame();
    for (const Request& request : shown.desk.frame())
        asked.push_back(request);
    REQUIRE(first<RemovePose>(asked) != nullptr);
    CHECK(first<RemovePose>(asked)->pose == 1);
    shown.r.calibration.found = Box(Calibrated());
    shown.r.calibration.refused.clear();
    CHECK(shown.asks("###calibrationAccept", Step::accept));
    shown.r.state = Phase::accepted;
    const Requests next = shown.press("###registerToScan");
    REQUIRE(first<ChooseRegisterWay>(next) != nullptr);
    CHECK(first<ChooseRegisterWay>(next)->way == RegisterWay::scan);
}

TEST_CASE("register page: nothing of what it covers reacts, and no border of a panel lies on it") {
    RegisterView view = someView();
    view.picture = {};
    Shown shown(view);
    const Layout usual = layout({1280, 800}, 1.0, {});
    const PanelSizes before = shown.desk.state.panels;
    const double x = usual.canvas.x + usual.canvas.w / 2, y = usual.sweep.y;
    shown.desk.drag({{x, y}, {x, y - 40}, {x, y - 80}});
    CHECK(shown.desk.state.panels == before);
    const Tool tool = shown.desk.state.tool;
    for (double down = usual.tools.y; down < usual.tools.bottom(); down += 20)
        shown.desk.click({usual.tools.w / 2, down});
    CHECK(shown.desk.state.tool == tool);
}

TEST_CASE("register page: of what was registered one may go on to any way") {
    Shown shown(someView(RegisterWay::scan, Phase::accepted));
    const Requests asked = shown.desk.press(column().c_str(), {"###registerWay", "Calibrate"});
    REQUIRE(first<ChooseRegisterWay>(asked) != nullptr);
    CHECK(first<ChooseRegisterWay>(asked)->way == RegisterWay::calibration);
}

TEST_CASE("register page: while the scene's picture is waited for nothing is accepted again") {
    RegisterView view = someView();
    view.found = someFound();
    view.accepting = true;
    Shown shown(view);
    CHECK(shown.press("###registerAccept").empty());
}

TEST_CASE("register page: clicks are a tape's ends while one is laid, and what it says scales the depth") {
    RegisterView view = someView();
    view.found = someFound();
    Shown shown(view);
    CHECK(first<PlaceTape>(shown.desk.click(shown.at(200, 100))) == nullptr);
    CHECK(shown.asks("###registerTape", Step::tape));
    shown.r.tape.placing = true;
    const Requests asked = shown.desk.click(shown.at(200, 100));
    REQUIRE(first<PlaceTape>(asked) != nullptr);
    CHECK(first<PlaceTape>(asked)->at.x == doctest::Approx(200).epsilon(0.01));
    shown.r.tape.ends = {{200, 100}, {300, 100}};
    shown.r.tape.length = 0.412_m;
    shown.desk.settle();
    shown.press("###tapeSays");
    shown.desk.settle();
    const Requests typed = shown.desk.type("0.42");
    REQUIRE(first<TapeSays>(typed) != nullptr);
    CHECK(first<TapeSays>(typed)->length.si() == doctest::Approx(0.42));
}
