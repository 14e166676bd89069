// Measuring a rig in the window: the page's own buttons, the measurer behind them, and an emulated bench at its end.
#include "app/studio/measurer.h"

#include <doctest/doctest.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <filesystem>
#include <thread>

#include "app/output_core/stage_mark.h"
#include "app/rigs.h"
#include "devices/emulated_bench/emulated_bench.h"
#include "projects/wave_database.h"
#include "tests/support/run_program.h"
#include "tests/ui/headless.h"

using namespace ilf;
using namespace ilf::app;
using ui::Measure;
using Phase = ui::MeasureView::State;

namespace {

/// The page over a measurer, as the studio wires them; waves are few so that it is quick.
struct Bench {
    TemporaryDirectory folder;
    devices::EmulatedBench* bench = nullptr;  ///< of the place that is open
    std::size_t waves = 9;
    Measurer measurer{std::string(folder / "run"), {}, [this](const MeasureOrder& order, auto stop, auto watch) {
                          MeasureOrder fewer = order;
                          fewer.waves = waves;
                          auto place = MeasurePlace::open(fewer, std::move(stop), std::move(watch));
                          if (place) bench = (*place)->bench();
                          return place;
                      }};
    ui::test::Desk desk{ui::test::twoRegions(), {1280, 800}};
    std::vector<Phase> seen;

    Bench() {
        std::filesystem::create_directories(folder / "run");
        desk.dress = [this](ui::View& view) {
            view.core.emulated = true;
            view.measuring = measurer.view();
        };
    }
    /// One frame, with what it asks for done.
    void frame() { done(desk.frame()); }
    void done(const ui::Requests& requests) {
        for (const ui::Request& request : requests) {
            if (const auto* start = std::get_if<ui::StartMeasuring>(&request)) measurer.begin(start->setup);
            if (const auto* store = std::get_if<ui::StoreMeasured>(&request)) measurer.store(store->path);
            const auto* asked = std::get_if<Measure>(&request);
            if (asked == nullptr) continue;
            if (asked->step == Measure::Step::open) REQUIRE(measurer.offer(kEmulatedRig, emulatedRig()));
            if (asked->step == Measure::Step::go) measurer.go();
            if (asked->step == Measure::Step::next) measurer.next();
            if (asked->step == Measure::Step::again) measurer.again();
            if (asked->step == Measure::Step::back) measurer.back();
            if (asked->step == Measure::Step::cancel) measurer.cancel();
        }
        if (measurer.collect() && measurer.view() && (seen.empty() || seen.back() != measurer.view()->state))
            seen.push_back(measurer.view()->state);
    }
    void press(const char* button) {
        desk.settle();
        for (const ImGuiWindow* window : ImGui::GetCurrentContext()->Windows) {
            if (std::string(window->Name).starts_with("###measure/###measureNow"))
                return done(desk.press(window->Name, {button}));
        }
        FAIL("the page is not open");
    }
    bool is(Phase state) const { return measurer.view() && measurer.view()->state == state; }
    /// Until the page shows `state`, or none where that is what is waited for.
    bool waitFor(std::optional<Phase> state) {
        const auto until = std::chrono::steady_clock::now() + std::chrono::minutes(4);
        while (std::chrono::steady_clock::now() < until) {
            frame();
            if (state ? is(*state) : !measurer.view()) return true;
            if (state && *state != Phase::setup && !measurer.view()) return false;
            std::this_thread::sleep_for(std::chrono::milliseconds(2));
        }
        return false;
    }
    void open() {
        desk.state.page = ui::Page::rig;
        done({Measure{Measure::Step::open}});
        REQUIRE(is(Phase::setup));
    }
    void begin() {
        open();
        press("###measureBegin");
        REQUIRE(waitFor(Phase::connecting));
    }
    /// Presses Measure, or what begins a step, and waits for its outcome.
    bool measured(const char* button = "###measureGo") {
        press(button);
        return waitFor(Phase::judged) && now().standing == ui::MeasureStanding::good;
    }
    const ui::MeasureStepView& now() const { return measurer.view()->steps.at(measurer.view()->at); }
};

bool still(devices::EmulatedBench& bench) {
    const auto before = bench.currents();
    bench.pass(std::chrono::milliseconds(40));
    return before == bench.currents();
}

}  // namespace

TEST_CASE("measuring page: from the button to a file with every step good, on the emulated bench") {
    Bench b;
    const std::string file = b.folder / "lens.ilflens";
    b.begin();
    CHECK(b.measurer.view()->emulated);
    CHECK(b.measurer.view()->steps.size() == 6);
    CHECK_FALSE(b.measurer.wantsDevices());
    REQUIRE_MESSAGE(b.measured(), b.now().advice);  // projector
    CHECK(still(*b.bench));
    CHECK(b.measurer.view()->photodiode.size() > 100);
    CHECK(b.measurer.view()->input0.size() == b.measurer.view()->photodiode.size());
    b.press("###measureNext");
    REQUIRE(b.is(Phase::connecting));
    REQUIRE_MESSAGE(b.measured(), b.now().advice);  // dark
    b.press("###measureNext");
    REQUIRE_MESSAGE(b.measured(), b.now().advice);                  // light
    REQUIRE_MESSAGE(b.measured("###measureNext"), b.now().advice);  // powers: nothing to connect, so it begins
    CHECK(b.measurer.view()->powers.size() > 10);
    CHECK(b.measurer.view()->known.size() == 7);
    CHECK(still(*b.bench));
    b.measurer.store(file);  // not before every step was good
    CHECK_FALSE(std::filesystem::exists(file));
    REQUIRE_MESSAGE(b.measured("###measureNext"), b.now().advice);  // waves
    CHECK(b.measurer.view()->wave.size() > 100);
    CHECK_FALSE(b.measurer.view()->waveName.empty());
    REQUIRE_MESSAGE(b.measured("###measureNext"), b.now().advice);  // drift
    b.press("###measureNext");
    REQUIRE(b.is(Phase::good));
    CHECK(still(*b.bench));
    CHECK_FALSE(std::filesystem::exists(file));

    b.measurer.store("/proc/none/lens.ilflens");
    REQUIRE(b.waitFor(Phase::good));
    CHECK_FALSE(b.measurer.view()->trouble.empty());
    b.measurer.store(file);
    REQUIRE(b.waitFor(Phase::stored));
    const auto waves = projects::openWaves(file);
    REQUIRE_MESSAGE(waves, waves.error().what);
    CHECK(waves->lens.emulated);
    CHECK(waves->records.size() >= 9);
    for (const LensRecord& record : waves->records) {
        CHECK(record.provenance == Provenance::simulated);
        CHECK(record.temperature_C > 20.0);
    }
    REQUIRE(waves->delays.size() == 1);
    CHECK(std::abs(waves->delays[0].delay_s - 0.46e-3) < 8e-6);
    const auto rig = b.measurer.measuredRig(emulatedRig());
    REQUIRE(rig);
    CHECK(rig->provenance == "simulated");
    CHECK(rig->lens == file);
    b.press("###measureCancel");
    CHECK(b.waitFor(std::nullopt));
}

TEST_CASE("measuring page: what went wrong is said with what helps, and the step is good once that is put right") {
    Bench b;
    b.open();
    b.desk.state.measure.projector = false;
    b.press("###measureBegin");
    REQUIRE(b.waitFor(Phase::connecting));
    CHECK(b.measurer.view()->steps.size() == 5);
    b.bench->failsAt = b.bench->calls + 12;
    b.bench->goesAway = true;
    CHECK_FALSE(b.measured());
    REQUIRE(b.is(Phase::judged));
    CHECK(b.now().advice.find("Plug it in again") != std::string::npos);
    b.press("###measureNext");  // is not there
    REQUIRE(b.is(Phase::judged));
    b.bench->failsAt = 0;
    b.bench->goesAway = b.bench->unplugged = false;
    b.press("###measureAgain");
    REQUIRE(b.is(Phase::connecting));
    CHECK_MESSAGE(b.measured(), b.now().advice);
    CHECK(still(*b.bench));
    b.press("###measureNext");
    b.bench->lensPlugged[0] = false;
    CHECK_FALSE(b.measured());
    CHECK(b.now().advice.find("does not move") != std::string::npos);
    b.press("###measureBack");
    REQUIRE(b.is(Phase::connecting));
    CHECK(b.measurer.view()->at == 0);
    CHECK(b.now().measured.empty());
}

TEST_CASE("measuring page: Cancel ends every step, those that are worked on as well, with the lens at rest") {
    for (int steps = 0; steps < 4; ++steps) {
        CAPTURE(steps);
        Bench b;
        b.open();
        b.desk.state.measure.projector = steps == 0;
        b.press("###measureBegin");
        REQUIRE(b.waitFor(Phase::connecting));
        for (int done = 1; done < steps; ++done) {
            REQUIRE(b.measured());
            b.press("###measureNext");
            if (done == 2) break;  // powers go on by themselves
        }
        if (steps < 3) b.press("###measureGo");
        CHECK(b.is(Phase::working));
        b.press("###measureCancel");
        if (b.measurer.view()) {
            CHECK(b.is(Phase::ending));
            CHECK(b.waitFor(std::nullopt));
        }
        CHECK_FALSE(b.measurer.busy());
        CHECK(b.seen.back() != Phase::good);
    }
}

TEST_CASE("measuring page: a step that safe light stops is not good, and the lens rests") {
    Bench b;
    b.open();
    b.desk.state.measure.projector = false;
    b.press("###measureBegin");
    REQUIRE(b.waitFor(Phase::connecting));
    REQUIRE(b.measured());
    b.press("###measureNext");
    REQUIRE(b.measured());
    b.press("###measureNext");
    REQUIRE(b.is(Phase::working));
    b.measurer.stopStep();
    REQUIRE(b.waitFor(Phase::judged));
    CHECK(b.now().advice.find("the lenses rest") != std::string::npos);
    CHECK(still(*b.bench));
}

TEST_CASE("measurer: what cannot be measured is refused with the reason, before anything is opened") {
    const TemporaryDirectory folder;
    Measurer measurer(std::string(folder / "run"), {});
    const auto refused = [&](const Rig& rig, const char* part) {
        const auto offered = measurer.offer("some.json", rig);
        REQUIRE_FALSE(offered);
        CHECK(offered.error().what.find(part) != std::string::npos);
        CHECK_FALSE(measurer.view());
    };
    refused(Rig{}, "names no devices");
    Rig rehearsal = emulatedRig();
    rehearsal.devices->rehearsal = true;
    refused(rehearsal, "no lenses");

    REQUIRE(measurer.offer("room.json", emulatedRig()));
    ui::MeasureSetup setup;
    const auto troubled = [&](const char* part) {
        measurer.begin(setup);
        CHECK(measurer.view()->state == Phase::setup);
        CHECK_FALSE(measurer.wantsDevices());
        CHECK(measurer.view()->trouble.find(part) != std::string::npos);
    };
    troubled("at least two powers");
    setup.known = "-50,-3\n50;3";
    troubled("line 2");
    setup.known = "-50,-3\n50,3";
    troubled("how warm");
    setup.temperature = "300";
    troubled("0 to 80");
}

TEST_CASE("measurer: real devices are waited for, and given back whatever comes of it") {
    const TemporaryDirectory folder;
    const std::filesystem::path run(folder / "run");
    std::filesystem::create_directories(run);
    int opened = 0;
    bool marked = false, held = false;
    Measurer measurer(run, {}, [&](const MeasureOrder&, auto, auto) -> Result<std::unique_ptr<MeasurePlace>> {
        ++opened;
        marked = stageIsMarked(run);
        held = devices::FileLock::holder(devices::playerLock(run)).has_value();
        return fail(Fault::notFound, "No USB-1208FS-Plus is plugged in.");
    });
    ui::MeasureSetup setup;
    setup.known = "-50,-3\n50,3";
    setup.temperature = "30";
    const auto waitFor = [&](Phase state) {
        for (int i = 0; i < 2000 && !(measurer.view() && measurer.view()->state == state); ++i) {
            measurer.collect();
            std::this_thread::sleep_for(std::chrono::milliseconds(2));
        }
        return measurer.view() && measurer.view()->state == state;
    };
    REQUIRE(measurer.offer("room.json", emulatedRig()));
    measurer.begin(setup);
    CHECK(measurer.wantsDevices());
    CHECK(opened == 0);
    measurer.devicesAreFree({});
    measurer.devicesAreFree({});  // said again and again while it is so
    REQUIRE(waitFor(Phase::setup));
    CHECK(opened == 1);
    // The stage was marked and held meanwhile, so that the guard sees to it if the studio dies, and is neither now.
    CHECK(marked);
    CHECK(held);
    CHECK_FALSE(stageIsMarked(run));
    CHECK_FALSE(devices::FileLock::holder(devices::playerLock(run)).has_value());
    CHECK(measurer.view()->trouble.find("plugged in") != std::string::npos);
    CHECK_FALSE(measurer.wantsDevices());

    measurer.begin(setup);
    measurer.devicesAreFree(fail(Fault::device, "The output core does not let go."));
    CHECK(opened == 1);
    CHECK(measurer.view()->trouble.find("let go") != std::string::npos);
    measurer.begin(setup);
    measurer.cancel();
    for (int i = 0; i < 2000 && measurer.view(); ++i) {
        measurer.collect();
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    CHECK_FALSE(measurer.view());
    CHECK_FALSE(measurer.wantsDevices());
}
