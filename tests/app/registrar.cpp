// Registering a camera in the window: the page's own buttons, the registrar behind them, and at its end an output core
// whose light the emulated camera sees.
#include "app/studio/registrar.h"

#include <doctest/doctest.h>

#include <chrono>
#include <cmath>
#include <latch>
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
            if (const auto* shown = std::get_if<ui::ShowRegisterPicture>(&request)) registrar.showPicture(shown->what);
            const auto* asked = std::get_if<ui::Register>(&request);
            if (asked == nullptr) continue;
            camera = {};  // as the studio closes its port
            if (asked->step == Step::scan) registrar.scan(asked->setup.anyway);
            if (asked->step == Step::light) registrar.checkLight();
            if (asked->step == Step::board) registrar.findBoard();
            if (asked->step == Step::cancel) registrar.cancel();
            if (asked->step == Step::marks) registrar.toggleMarks();
            if (asked->step == Step::another) registrar.anotherPlace();
            if (asked->step == Step::pose) registrar.scanPose();
            if (asked->step == Step::tape) registrar.toggleTape();
            if (asked->step == Step::accept) registrar.accept(asked->setup);
            if (asked->step == Step::close) registrar.close();
        }
        registrar.collect();
        if (registrar.wantsCamera().empty()) return;
        if (live) registrar.livePicture(live());
    }
    void press(std::initializer_list<const char*> path) {
        desk.settle();
        for (const ImGuiWindow* window : ImGui::GetCurrentContext()->Windows) {
            if (std::string(window->Name).starts_with("###register/###registerNow"))
                return done(desk.press(window->Name, path));
        }
        FAIL("the page is not open");
    }
    void press(const char* button) { press({button}); }
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
    std::latch looked(1);  // it ends no sooner than it was looked at while it scanned
    parts.scan = [&](const ScanOrder& order, const devices::ScanWatch& watch, const std::stop_token&) {
        anyway = order.wish.anyway;
        watch({devices::ScanProgress::Step::patterns, 3, 44, "Stripes down, 2 of 9", {}});
        looked.wait();
        return Result<ScanOutcome>(someOutcome(order));
    };
    Desk d(folder / "run", parts);
    d.registrar.open(d.rig, {}, "emulated");
    CHECK(d.registrar.wantsCamera() == "emulated");
    d.press("###registerAnyway");
    d.press("###registerScan");
    CHECK(d.registrar.shows());
    CHECK(d.registrar.wantsCamera().empty());
    looked.count_down();
    REQUIRE(d.settled());
    CHECK(anyway);
    CHECK_FALSE(d.registrar.shows());
    REQUIRE(d.view().found);
    CHECK(d.view().decodedShare == doctest::Approx(0.93));
    CHECK(d.view().light->go);
    CHECK(d.view().shows == ui::RegisterPicture::quality);
    CHECK_FALSE(d.view().hasDepth);
    CHECK_FALSE(d.registrar.toWrite());
    d.live = [] { return grey(kCamera, 180); };
    d.press("###registerAccept");
    CHECK(d.view().accepting);
    std::optional<Registrar::ToWrite> both;
    REQUIRE(d.until([&] { return (both = d.registrar.toWrite()).has_value(); }));
    CHECK(both->registration->points == 70000);
    CHECK(both->picture.at(5, 5, 1) == 180);
    CHECK_FALSE(both->calibration);
    CHECK_FALSE(both->depth);
    CHECK_FALSE(d.registrar.toWrite());
    d.registrar.accepted(d.rig);
    CHECK(d.view().state == Phase::accepted);
    CHECK(d.view().shows == ui::RegisterPicture::live);
    CHECK_FALSE(d.view().found);
    CHECK_FALSE(d.view().accepting);
    d.press({"###registerWay", "Scan"});  // once more
    CHECK(d.view().state == Phase::ready);
    d.press("###registerClose");
    CHECK_FALSE(d.registrar.view());
    CHECK(d.registrar.wantsCamera().empty());
}

TEST_CASE("registrar: a scene's picture that comes slowly is waited for, in colour") {
    const TemporaryDirectory folder;
    RegisterParts parts;
    parts.scan = [](const ScanOrder& order, const auto&, const auto&) {
        return Result<ScanOutcome>(someOutcome(order));
    };
    Desk d(folder / "run", parts);
    d.registrar.open(d.rig, {}, "emulated");
    d.press("###registerScan");
    REQUIRE(d.settled());
    d.live = {};
    d.press("###registerAccept");
    for (int i = 0; i < 9; ++i)
        d.registrar.livePicture(grey(kCamera, 140));
    CHECK_FALSE(d.registrar.toWrite());
    d.registrar.livePicture(grey(kCamera, 150));
    const auto written = d.registrar.toWrite();
    REQUIRE(written);
    CHECK(written->picture.channels() == 3);
    CHECK(written->picture.at(3, 3, 0) == 150);
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
    d.press({"###registerShows", "Live"});
    CHECK(d.view().shows == ui::RegisterPicture::live);
    d.press({"###registerShows", "Quality"});
    CHECK(d.view().shows == ui::RegisterPicture::quality);
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

namespace {

/// A calibration of the test's camera and raster, as a scan of some poses would have found it.
Calibrated someCalibrated() {
    Calibrated found;
    found.calibration.camera = plainPinhole(kCamera, 500.0);
    found.calibration.projector = plainPinhole({400, 300}, 600.0);
    found.calibration.projectorFromCamera.translation = {-0.3, 0.0, 0.0};
    found.calibration.poses = 2;
    found.calibration.scale = "board";
    found.poses.resize(2);
    found.poses[0].camera_px = 0.08;
    found.poses[1].used = false;
    return found;
}

}  // namespace

TEST_CASE("registrar: one pose is refused with the reason, more can be accepted, and a pose that is deleted is gone") {
    const TemporaryDirectory folder;
    RegisterParts parts;
    std::vector<std::string> cameras;
    parts.pose = [&](const ScanOrder& order, const Board& board, std::vector<BoardView> before, const std::string& name,
                     const auto&, const auto&) {
        cameras.push_back(order.camera);
        PosesOutcome outcome;
        outcome.scan = someOutcome(order);
        outcome.scan->registration = {};
        BoardView view;
        view.name = name;
        view.camera = kCamera;
        view.projector = order.rig.projector;
        for (const auto& corner : cornersOf(board)) {
            view.inCamera.push_back({100.0 + 2000.0 * corner.x, 60.0 + 1000.0 * corner.y});
            view.onProjector.push_back(Point<ProjectorFrame>{120.0 + 2000.0 * corner.x, 80.0 + 1000.0 * corner.y});
        }
        before.push_back(view);
        // The first by what core says of it; of two the test makes its own calibration.
        if (before.size() == 1) {
            const PosesOutcome one = calibratedBy(before, board, "emulated");
            outcome.refused = one.refused;
            CHECK_FALSE(one.calibrated);
        } else {
            outcome.calibrated = Box(someCalibrated());
        }
        outcome.views = std::move(before);
        return Result<PosesOutcome>(std::move(outcome));
    };
    Desk d(folder / "run", parts);
    d.registrar.open(d.rig, {}, "emulated:binning=4");
    d.registrar.choose(RegisterWay::calibration);
    CHECK(d.registrar.wantsCamera() == "emulated:board=1,binning=4");
    d.press("###registerPose");
    REQUIRE(d.settled());
    CHECK(d.view().calibration.poses.size() == 1);
    CHECK(d.view().calibration.refused.find("pose") != std::string::npos);
    CHECK_FALSE(d.view().calibration.found);
    CHECK_FALSE(d.registrar.toWrite());
    d.press("###registerPose");
    REQUIRE(d.settled());
    CHECK(cameras == std::vector<std::string>{"emulated:board=1,binning=4", "emulated:board=2,binning=4"});
    REQUIRE(d.view().calibration.poses.size() == 2);
    CHECK(d.view().calibration.poses[0].camera_px == doctest::Approx(0.08));
    CHECK_FALSE(d.view().calibration.poses[1].used);
    CHECK(d.view().calibration.corners.size() == 54);
    d.press("###calibrationAccept");
    const auto both = d.registrar.toWrite();
    REQUIRE(both);
    CHECK(both->calibration->scale == "board");
    CHECK_FALSE(both->registration);
    d.rig.calibration = both->calibration;
    d.registrar.accepted(d.rig);
    CHECK(d.view().calibrated);
    d.registrar.choose(RegisterWay::calibration);
    d.registrar.removePose(1);
    CHECK_FALSE(d.registrar.wantsCamera().empty());  // nothing is scanned for it
    REQUIRE(d.settled());
    CHECK(d.view().calibration.poses.size() == 1);
    CHECK_FALSE(d.view().calibration.found);
    d.registrar.setBoard({7, 5, 30.0_mm});
    CHECK(d.view().calibration.poses.empty());
}

TEST_CASE("registrar: depth that a scan measured goes along with the picture, and a tape sets its metres right") {
    const TemporaryDirectory folder;
    RegisterParts parts;
    parts.scan = [](const ScanOrder& order, const auto&, const auto&) {
        ScanOutcome outcome = someOutcome(order);
        outcome.depth.emplace();
        outcome.depth->depth.camera = order.rig.calibration->camera;
        outcome.depth->depth.metres = Image<float>(kCamera, 1, std::vector<float>(320 * 240, 1.0F));
        outcome.depth->depth.sigma = Image<float>(kCamera, 1, std::vector<float>(320 * 240, 0.002F));
        return Result<ScanOutcome>(outcome);
    };
    Rig rig = someRig();
    rig.calibration = Box(someCalibrated().calibration);
    Desk d(folder / "run", parts, rig);
    d.registrar.open(d.rig, {}, "emulated");
    d.press("###registerScan");
    REQUIRE(d.settled());
    REQUIRE(d.view().found->depth);
    CHECK(d.view().found->depth->nearest.si() == doctest::Approx(1.0));
    CHECK(d.view().found->depth->sigma.si() == doctest::Approx(0.002));
    CHECK(static_cast<double>(d.view().found->depth->spread.at(7, 7)) == doctest::Approx(0.002));
    d.press({"###registerShows", "Its \u00b1"});
    CHECK(d.view().shows == ui::RegisterPicture::spread);
    CHECK(d.view().picture.size() == kCamera);
    CHECK_FALSE(d.view().ramp.empty());
    d.press("###registerTape");
    d.registrar.placeTape({110, 120});
    CHECK(d.view().tape.length == 0.0_m);
    d.registrar.placeTape({210, 120});
    // 100 pixels at a focal length of 500, a metre away.
    CHECK(d.view().tape.length.si() == doctest::Approx(0.2));
    d.registrar.tapeSays(0.22_m);
    CHECK(d.view().tape.length.si() == doctest::Approx(0.22));
    CHECK(d.view().tape.scale == "tape");
    CHECK(d.view().found->depth->farthest.si() == doctest::Approx(1.1));
    d.press("###registerAccept");
    std::optional<Registrar::ToWrite> all;
    REQUIRE(d.until([&] { return (all = d.registrar.toWrite()).has_value(); }));
    CHECK(static_cast<double>(all->depth->metres.at(7, 7)) == doctest::Approx(1.1));
    CHECK(static_cast<double>(all->depth->sigma.at(7, 7)) == doctest::Approx(0.0022));
    CHECK(all->calibration->projectorFromCamera.translation[0] == doctest::Approx(-0.33));
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
