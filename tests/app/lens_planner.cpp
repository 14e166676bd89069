// Plans on calibrated lenses: what they hold on every preset, what is kept, and what a lens cannot do.
#include "app/lens/lens_planner.h"

#include <unistd.h>

#include <cstdlib>
#include <filesystem>

#include "app/open.h"
#include "core/plan/report.h"
#include "tests/support/law.h"

using namespace ilf;
using namespace ilf::app;

namespace {

PlanObject object(const char* name, double metres, Look look) {
    return {name, name, look, std::nullopt, Metre::fromSi(metres), Metre::fromSi(metres)};
}

PlanInput scene(LensPlanner& planner, std::vector<PlanObject> objects, WaveMode waves = WaveMode::continuous) {
    Document document;
    document.wearer.confusion.preset = CircleOfConfusion::Preset::oneArcmin;
    document.rig.waves = waves;
    PlanInput input;
    input.objects = std::move(objects);
    input.eye = eyeOptics(document.wearer);
    input.rig = document.rig;
    input.lens = *planner.calibration(document.rig);
    return input;
}

std::vector<PlanObject> paperObjects() {
    return {object("A", 0.25, Look::blur), object("B", 0.5, Look::focus), object("C", 0.5, Look::blur),
            object("D", 1.3, Look::blur)};
}

bool says(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

}  // namespace

TEST_CASE("planner: every preset's continuous wave holds the paper's scene within the budget") {
    for (const devices::LensPreset preset : devices::kLensPresets) {
        INFO(word(preset));
        LensPlanner planner{devices::SimulatedLens(preset)};
        const auto planned = planner.plan(scene(planner, paperObjects()), nullptr, true);
        REQUIRE(planned);
        CHECK(planned->waveform.mode == WaveMode::continuous);
        CHECK(planned->waveform.high.si() == doctest::Approx(4.27261643584172).epsilon(1e-12));
        CHECK_FALSE(planned->waveform.drive.c.empty());
        CHECK(planned->warnings.empty());
        for (const Level& level : planned->levels) {
            CHECK_FALSE(level.slots.empty());
            CHECK(level.rmsError <= level.budget);
            CHECK(level.exposure == doctest::Approx(16.0 * planned->light));
        }
    }
}

TEST_CASE("planner: the samples are planned on every preset without a warning or a problem") {
    for (const char* name : {"museum-guide", "study-desk", "tutorial-recording", "four-objects"}) {
        const auto opened = openAny(std::string(ILF_SOURCE_DIR) + "/projects/samples/" + name + ".ilfd");
        REQUIRE(opened);
        for (const devices::LensPreset preset : devices::kLensPresets) {
            INFO(name, " ", word(preset));
            LensPlanner planner{devices::SimulatedLens(preset)};
            const auto planned = planner.plan(*planner.input(opened->document), nullptr, true);
            REQUIRE(planned);
            CHECK(planned->warnings.empty());
            for (const RegionPlan& region : planned->regions)
                CHECK_MESSAGE(region.problem.empty(), region.problem);
        }
    }
}

TEST_CASE("planner: the paper's rule plans with 2485 recorded waves, kept from one time to the next") {
    const auto folder = std::filesystem::temp_directory_path() / ("ilf-lenses-" + std::to_string(getpid()));
    setenv("ILF_CACHE_DIR", folder.c_str(), 1);
    LensPlanner planner{devices::SimulatedLens(devices::LensPreset::datasheet)};
    const PlanInput input =
        scene(planner, {object("book", 0.5, Look::focus), object("clutter", 0.5, Look::blur)}, WaveMode::paper);
    CHECK(input.lens->tables.at(0).waves.size() == 2485);
    const auto planned = planner.plan(input, nullptr, true);
    REQUIRE(planned);
    CHECK(planned->waveform.mode == WaveMode::paper);
    CHECK(planned->waveform.wave > 0);
    const Extremes reach = extremes(planned->waveform.power);
    CHECK(reach.low <= 0.0);
    CHECK(reach.high >= planned->waveform.high.si());
    for (const Level& level : planned->levels)
        CHECK(level.rmsError < 0.3_D);
    LensPlanner next{devices::SimulatedLens(devices::LensPreset::datasheet)};
    CHECK(plan(scene(next, input.objects, WaveMode::paper))->waveform == planned->waveform);
    CHECK(std::filesystem::remove_all(folder) > 1);
    unsetenv("ILF_CACHE_DIR");
}

TEST_CASE("planner: a shaped wave is learnt when there is time for it, and gives more light for less error") {
    LensPlanner planner{devices::SimulatedLens(devices::LensPreset::datasheet)};
    PlanInput input = scene(planner, {object("book", 0.5, Look::focus), object("clutter", 0.5, Look::blur)});
    const Plan sine = *planner.plan(input, nullptr, true);
    input.rig.waves = WaveMode::shaped;
    const Plan waiting = *planner.plan(input, nullptr, false);
    CHECK(waiting.waveform.mode == WaveMode::continuous);
    REQUIRE(waiting.unlearnt.size() == 2);
    REQUIRE(waiting.warnings.size() == 1);
    CHECK(says(waiting.warnings[0], "has been learnt"));
    const Plan shaped = *planner.plan(input, &waiting, true);
    CHECK(shaped.waveform.mode == WaveMode::shaped);
    CHECK(shaped.unlearnt.empty());
    CHECK(shaped.warnings.empty());
    CHECK(shaped.light > 1.4 * sine.light);
    for (const Level& level : shaped.levels)
        CHECK(level.rmsError <= 0.1_D);
}

TEST_CASE("planner: what an edit cannot change is kept, and the plan is the same as one from nothing") {
    LensPlanner planner{devices::SimulatedLens(devices::LensPreset::datasheet)};
    Plan last = *planner.plan(scene(planner, paperObjects()), nullptr, true);
    PlanInput input = last.input;
    input.objects[3].nearest = input.objects[3].farthest = 1.0_m;  // D drives nothing
    const Plan moved = *planner.plan(input, &last, true);
    CHECK(moved.work.wavesChosen == last.work.wavesChosen);
    CHECK(moved.work.wavesKept > last.work.wavesKept);
    CHECK(moved.work.schedulesMade == last.work.schedulesMade);
    CHECK(moved == *plan(input));

    law("with the plan before or without, a plan is the same", [&] {
        const auto which = *rc::gen::inRange<std::size_t>(0, 4);
        const Metre to = *rc::gen::inRange(22, 200) * 0.01_m;
        input.objects[which].nearest = input.objects[which].farthest = to;
        input.rig.powerBudget = *rc::gen::element(0.05, 0.1, 0.2) * 1.0_D;
        const auto with = plan(input, &last), without = plan(input);
        RC_ASSERT(with.has_value() == without.has_value());
        if (!with) return;
        RC_ASSERT(*with == *without);
        last = *with;
    });
}

TEST_CASE(
    "planner: where the lens does not reach, alpha gives way with a warning, then the plan is refused with how far") {
    LensPlanner planner{devices::SimulatedLens(devices::LensPreset::datasheet)};
    PlanInput input = scene(planner, paperObjects());
    const auto reach = [&](double metres) {
        input.objects[0].nearest = input.objects[0].farthest = Metre::fromSi(metres);
        return plan(input);
    };
    // Survey: up to about 7 D. The first distance at which all of alpha is not there any more.
    double metres = 0.2;
    auto planned = reach(metres);
    while (planned && planned->alpha == planned->input.alpha && metres > 0.05)
        planned = reach(metres -= 0.0002);
    REQUIRE(planned);
    CHECK(planned->alpha < planned->input.alpha);
    CHECK(planned->alpha > 0.0_D);
    REQUIRE_FALSE(planned->warnings.empty());
    CHECK(says(planned->warnings[0], "Alpha is"));
    CHECK(planned->waveform.high == *planned->pS + planned->alpha);
    const auto refused = reach(metres - 0.02);
    REQUIRE_FALSE(refused);
    CHECK(refused.error().fault == Fault::unsafe);
    CHECK(says(refused.error().what, "largest P_s"));
    CHECK(says(refused.error().what, "move it beyond"));
}

TEST_CASE("planner: a camera's levels in the middle of the sweep are held by a wave learnt for them") {
    LensPlanner planner{devices::SimulatedLens(devices::LensPreset::datasheet)};
    Document document;
    document.wearer.camera = CameraObserver{};
    document.rig.waves = WaveMode::shaped;
    PlanInput input = *planner.input(document);
    input.objects = {object("near", 0.333, Look::focus), object("middle", 0.5, Look::focus),
                     object("far", 1.3, Look::focus)};
    CHECK_FALSE(planner.plan(input, nullptr, false));  // a continuous wave is too fast there
    const auto planned = planner.plan(input, nullptr, true);
    REQUIRE_MESSAGE(planned, (planned ? std::string() : planned.error().what));
    CHECK(planned->waveform.mode == WaveMode::shaped);
    CHECK(planned->levels.size() == 3);
    for (const Level& level : planned->levels) {
        CHECK(level.rmsError <= level.budget);
        CHECK(level.exposure >= 1.0);
    }
}

TEST_CASE("planner: a strong wave is on its prediction while the lens warms, and the devices let it warm") {
    LensPlanner planner{devices::SimulatedLens(devices::LensPreset::datasheet)};
    const Plan planned = *planner.plan(scene(planner, paperObjects(), WaveMode::shaped), nullptr, true);
    REQUIRE(planned.waveform.mode == WaveMode::shaped);
    CHECK(planned.waveform.warming_C > 1.0);
    devices::EmulatedLens lens(devices::LensPreset::datasheet, 0);
    lens.play(planned.waveform, 0);
    const auto at = [&](double seconds) { lens.advance(static_cast<std::int64_t>(seconds * 1e9)); };
    for (const double seconds : {0.9, 60.0, 180.0, 900.0}) {
        at(seconds);
        at(seconds + 0.9);  // watched again after the gap
        INFO(seconds, " s: ", lens.temperature_C(), " C");
        // A static trim leaves a little of what 5 degrees do to the swing; untrimmed it was 0.21 D.
        CHECK(lens.offWave() < (seconds < 100.0 ? 0.08_D : 0.03_D));
    }
    CHECK(lens.temperature_C() == doctest::Approx(30.0 + planned.waveform.warming_C).epsilon(0.01));
}

TEST_CASE("planner: wearers of glasses get a survey about their own rest power") {
    for (const double ametropia_D : {-4.0, 4.0}) {
        INFO(ametropia_D);
        LensPlanner planner{devices::SimulatedLens(devices::LensPreset::datasheet)};
        Document document;
        document.wearer.ametropia = Dioptre::fromSi(ametropia_D);
        PlanInput input = *planner.input(document);
        input.objects = {object("book", 0.5, Look::focus), object("clutter", 0.5, Look::blur)};
        const auto planned = planner.plan(input, nullptr, true);
        REQUIRE_MESSAGE(planned, (planned ? std::string() : planned.error().what));
        CHECK(planned->warnings.empty());
        for (const Level& level : planned->levels)
            CHECK(level.rmsError <= level.budget);
    }
}

TEST_CASE("planner: ten degrees warmer another drive gives the same powers") {
    LensPlanner planner{devices::SimulatedLens(devices::LensPreset::datasheet)};
    PlanInput input = scene(planner, paperObjects());
    const Plan cool = *plan(input);
    LensCalibration warmer = *input.lens;
    warmer.temperature_C += 10.0;
    input.lens = std::make_shared<const LensCalibration>(warmer);
    const Plan warm = *plan(input);
    CHECK(warm.waveform.high == cool.waveform.high);
    CHECK(cool.waveform.drive.mean() - warm.waveform.drive.mean() > 0.0);
    CHECK(warm.waveform.drive != cool.waveform.drive);
}

TEST_CASE("planner: a calibration that is not there, and a rate at which nothing was recorded") {
    LensPlanner planner{devices::SimulatedLens(devices::LensPreset::datasheet)};
    Rig rig;
    rig.lens = "no-such-lens.ilflens";
    const auto none = planner.calibration(rig);
    REQUIRE_FALSE(none);
    CHECK(says(none.error().what, "no-such-lens.ilflens"));
    PlanInput input = scene(planner, paperObjects());
    input.rig.sweepRate = 90.0_Hz;
    input.rig.slotRate = 990.0_Hz;
    const auto otherRate = plan(input);
    REQUIRE_FALSE(otherRate);
    CHECK(says(otherRate.error().what, "90"));
}
