// Registering a camera in the window: the page's own buttons, the registrar behind them, and at its end an output core
// whose light the emulated camera sees.
#include "app/studio/registrar.h"

#include <doctest/doctest.h>

#include <chrono>
#include <cmath>
#include <thread>

#include "app/headless/own_core.h"
#include "app/studio/register_marks.h"
#include "devices/emulated_scene/emulated_camera.h"
#include "devices/link/core_link.h"
#include "tests/support/run_program.h"
#include "tests/ui/headless.h"

using namespace ilf;
using namespace ilf::app;
using ui::RegisterWay;
using Phase = ui::RegisterView::State;

namespace {

constexpr Size kCamera{320, 240};

Image<std::uint8_t> grey(Size size, std::uint8_t value) {
    return Image<std::uint8_t>(
        size, 3, std::vector<std::uint8_t>(3 * static_cast<std::size_t>(size.width * size.height), value));
}

Rig someRig() {
    Rig rig;
    rig.projector = {400, 300};
    return rig;
}

/// A scan that found the homography "half a raster pixel for each of the camera's", or not.
ScanOutcome someOutcome(const ScanOrder& order) {
    ScanOutcome outcome;
    outcome.captured.ambient = {0.7, 0.8, 90.0, 0.0, true, "Go."};
    outcome.captured.exposure = 33.0_ms;
    outcome.captured.scan.pictures = {Image<std::uint8_t>(kCamera, 1, std::vector<std::uint8_t>(320 * 240, 200))};
    outcome.decoded.state = Image<std::uint8_t>(kCamera, 1, std::vector<std::uint8_t>(320 * 240, 0));
    outcome.decoded.confidence = outcome.decoded.state;
    outcome.diagnosis.decodedShare = 0.93;
    Registration found;
    found.method = Registration::Method::scan;
    found.camera.picture = kCamera;
    found.projector = order.rig.projector;
    found.rms_px = 0.2;
    found.points = 70000;
    found.provenance = "emulated";
    outcome.registration = Box(std::move(found));
    return outcome;
}

/// The page over a registrar, as the studio wires them, with a camera that gives `picture`.
struct Desk {
    explicit Desk(std::filesystem::path directory, RegisterParts parts, Rig itsRig = someRig())
        : rig(std::move(itsRig)), registrar(std::move(directory), {}, std::move(parts)) {
        desk.dress = [this](ui::View& view) {
            view.registering = registrar.view();
            view.camera.open = true;
        };
    }

    void frame() { done(desk.frame()); }
    void done(const ui::Requests& requests) {
        using Step = ui::Register::Step;
        for (const ui::Request& request : requests) {
            if (const auto* way = std::get_if<ui::ChooseRegisterWay>(&request)) registrar.choose(way->way);
            if (const auto* gone = std::get_if<ui::RemovePair>(&request)) registrar.removePair(gone->pair);
            const auto* asked = std::get_if<ui::Register>(&request);
            if (asked == nullptr) continue;
            camera = {};  // as the studio closes its port
            if (asked->step == Step::scan) registrar.scan(asked->setup.anyway);
            if (asked->step == Step::light) registrar.checkLight();
            if (asked->step == Step::board) registrar.findBoard();
            if (asked->step == Step::cancel) registrar.cancel();
            if (asked->step == Step::marks) registrar.toggleMarks();
            if (asked->step == Step::another) registrar.anotherPlace();
            if (asked->step == Step::picture) registrar.togglePicture();
            if (asked->step == Step::accept) registrar.accept(asked->setup.asScene);
            if (asked->step == Step::close) registrar.close();
        }
        registrar.collect();
        if (registrar.wantsCamera().empty()) return;
        if (live) registrar.livePicture(live());
    }
    void press(const char* button) {
        desk.settle();
        for (const ImGuiWindow* window : ImGui::GetCurrentContext()->Windows) {
            if (std::string(window->Name).starts_with("###register/###registerNow"))
                return done(desk.press(window->Name, {button}));
        }
        FAIL("the page is not open");
    }
    template <class Condition>
    bool until(Condition met) {
        const auto patience = std::chrono::steady_clock::now() + std::chrono::minutes(4);
        while (std::chrono::steady_clock::now() < patience) {
            frame();
            if (met()) return true;
            std::this_thread::sleep_for(std::chrono::milliseconds(2));
        }
        return false;
    }
    bool settled() {
        return until([this] { return !registrar.view() || registrar.view()->state == Phase::ready; });
    }
    const ui::RegisterView& view() const { return *registrar.view(); }

    Rig rig;
    Registrar registrar;
    std::unique_ptr<devices::CameraSource> camera;
    std::function<Image<std::uint8_t>()> live = [] { return grey(kCamera, 120); };
    ui::test::Desk desk{ui::test::twoRegions(), {1280, 900}};
};

}  // namespace

TEST_CASE("registrar: a scan that finds a map can be accepted with the picture under steady light, once") {
    const TemporaryDirectory folder;
    RegisterParts parts;
    bool anyway = false;
    parts.scan = [&](const ScanOrder& order, const devices::ScanWatch& watch, const std::stop_token&) {
        anyway = order.wish.anyway;
        watch({devices::ScanProgress::Step::patterns, 3, 44, "Stripes down, 2 of 9", {}});
        return Result<ScanOutcome>(someOutcome(order));
    };
    Desk d(folder / "run", parts);
    d.registrar.open(d.rig, {}, "emulated");
    CHECK(d.registrar.wantsCamera() == "emulated");
    d.press("###registerAnyway");
    d.press("###registerScan");
    CHECK(d.registrar.shows());
    CHECK(d.registrar.wantsCamera().empty());
    REQUIRE(d.settled());
    CHECK(anyway);
    CHECK_FALSE(d.registrar.shows());
    REQUIRE(d.view().found);
    CHECK(d.view().decodedShare == doctest::Approx(0.93));
    CHECK(d.view().light->go);
    CHECK(d.view().quality);
    CHECK_FALSE(d.registrar.toWrite());
    d.live = [] { return grey(kCamera, 180); };
    d.press("###registerAccept");
    std::optional<Registrar::ToWrite> both;
    REQUIRE(d.until([&] { return (both = d.registrar.toWrite()).has_value(); }));
    CHECK(both->registration->points == 70000);
    CHECK(both->picture.at(5, 5, 1) == 180);
    CHECK_FALSE(d.registrar.toWrite());
    d.registrar.accepted();
    CHECK(d.view().state == Phase::accepted);
    CHECK_FALSE(d.view().found);
    d.press("###registerClose");
    CHECK_FALSE(d.registrar.view());
    CHECK(d.registrar.wantsCamera().empty());
}

TEST_CASE("registrar: a bad scan shows its findings and quality, and there is nothing to accept") {
    const TemporaryDirectory folder;
    RegisterParts parts;
    parts.scan = [](const ScanOrder& order, const auto&, const auto&) {
        ScanOutcome outcome = someOutcome(order);
        outcome.registration = {};
        outcome.trouble = "Something moved while it was scanned.";
        outcome.diagnosis.findings = {{ScanFault::moved, ScanFinding::Weight::failure, outcome.trouble, {}}};
        return Result<ScanOutcome>(outcome);
    };
    Desk d(folder / "run", parts);
    d.registrar.open(d.rig, {}, "emulated");
    d.press("###registerScan");
    REQUIRE(d.settled());
    CHECK_FALSE(d.view().found);
    CHECK_FALSE(d.registrar.found());
    REQUIRE(d.view().findings.size() == 1);
    CHECK(d.view().trouble.empty());  // the finding says it
    CHECK(d.view().hasQuality);
    d.press("###registerQuality");
    CHECK_FALSE(d.view().quality);
}

TEST_CASE("registrar: cancelled at any time, closed at any time; a refusal is a sentence and the page stays") {
    const TemporaryDirectory folder;
    RegisterParts parts;
    parts.scan = [](const ScanOrder&, const auto&, const std::stop_token& stop) -> Result<ScanOutcome> {
        while (!stop.stop_requested())
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        return fail(Fault::device, "The scan was cancelled.");
    };
    parts.light = [](const ScanOrder&, const auto&, const auto&) -> Result<LightCheck> {
        LightCheck check;
        check.ambient = {0.5, 0.2, 8.0, 0.0, false, "The room is too bright: draw the curtains."};
        check.trouble = "The patterns are on another screen.";
        return check;
    };
    Desk d(folder / "run", parts);
    d.registrar.open(d.rig, {}, "emulated");
    d.press("###registerScan");
    d.press("###registerCancel");
    REQUIRE(d.settled());
    CHECK(d.view().trouble == "The scan was cancelled.");
    d.press("###registerLight");
    REQUIRE(d.settled());
    REQUIRE(d.view().light);
    CHECK_FALSE(d.view().light->go);
    CHECK(d.view().trouble == "The patterns are on another screen.");
    d.press("###registerScan");
    d.registrar.close();
    CHECK(d.registrar.shows());
    CHECK(d.until([&] { return !d.registrar.view(); }));
}

TEST_CASE("registrar: dragged corners give a registration or say why not") {
    const TemporaryDirectory folder;
    Desk d(folder / "run", {});
    d.registrar.open(d.rig, {}, "emulated");
    d.registrar.choose(RegisterWay::corners);
    d.frame();
    const Point<CameraFrame> seen[] = {{20, 15}, {300, 25}, {290, 220}, {30, 210}};
    for (int i = 0; i < 4; ++i)
        d.registrar.placeCorner(i, seen[i]);
    REQUIRE(d.registrar.found());
    const auto there = d.registrar.found()->map.toProjector({300, 25});
    CHECK(there.x == doctest::Approx(400));
    CHECK(std::abs(there.y) < 1e-6);
    CHECK(d.registrar.found()->provenance == "emulated");
    d.registrar.placeCorner(0, {295, 215});  // crossed
    CHECK_FALSE(d.registrar.found());
    CHECK_FALSE(d.view().trouble.empty());
}

TEST_CASE("registrar: on a core with the emulated scene, from the scan by its buttons to pairs and back" *
          doctest::timeout(280)) {
    const auto core = OwnCore::start(ILF_CORE_PATH, {});
    REQUIRE_MESSAGE(core, core.error().what);
    Desk d((*core)->directory(), {}, Rig());
    d.live = [&]() -> Image<std::uint8_t> {
        if (!d.camera) d.camera = *devices::openEmulatedCamera("emulated:binning=2", (*core)->directory());
        return (**d.camera->read()).rgb;
    };
    d.registrar.open(d.rig, {}, "emulated:binning=2");
    d.frame();
    d.camera.reset();
    d.press("###registerScan");
    REQUIRE(d.settled());
    REQUIRE_MESSAGE(d.registrar.found(), d.view().trouble);
    const Box<Registration> scanned = d.registrar.found();
    CHECK(scanned->provenance == "emulated");
    CHECK(scanned->rms_px < 1.0);
    devices::CoreLink link((*core)->directory());
    const auto light = [&] {
        for (int i = 0; i < 20; ++i)
            link.poll(std::chrono::milliseconds(10));
        return link.status().light;
    };
    CHECK(light() == devices::LightMode::steady);

    // Crosses clicked where the scan says they are seen.
    d.registrar.choose(RegisterWay::pairs);
    d.press("###registerMarks");
    REQUIRE(d.until([&] { return light() == devices::LightMode::slotted; }));
    for (int i = 0; i < 6; ++i)
        d.registrar.placeCross(scanned->map.nearest().inverted()(d.view().target));
    REQUIRE(d.registrar.found());
    CHECK(d.registrar.found()->rms_px < 0.01);
    d.registrar.placeCross({10, 10});
    CHECK(d.view().worst == 6);
    CHECK_FALSE(d.view().pairs[6].used);
    const auto place = d.view().pairs[6].at.projector;
    d.registrar.removePair(6);
    CHECK(d.view().target == place);
    d.press("###registerMarks");
    CHECK(light() == devices::LightMode::steady);

    // Safe light asked for by somebody else ends the marks.
    d.press("###registerMarks");
    REQUIRE(d.until([&] { return light() == devices::LightMode::slotted; }));
    REQUIRE(link.safeLight());
    CHECK(d.until([&] { return light() == devices::LightMode::steady && !d.view().showsMarks; }));
}
