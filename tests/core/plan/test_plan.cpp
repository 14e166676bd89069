// The plan: powers, levels, what cannot be done, and what would help.
#include "core/plan/plan.h"

#include <algorithm>
#include <cmath>

#include "tests/support/law.h"

using namespace ilf;

namespace {

PlanObject object(std::string name, double metres, Look look) {
    return {name, name, look, {}, Metre::fromSi(metres), Metre::fromSi(metres)};
}

Wearer wearerOfPaper() {
    Wearer wearer;
    wearer.confusion.preset = CircleOfConfusion::Preset::oneArcmin;
    return wearer;
}

PlanInput input(std::vector<PlanObject> objects, const Wearer& wearer = wearerOfPaper()) {
    PlanInput in;
    in.objects = std::move(objects);
    in.eye = eyeOptics(wearer);
    in.camera = wearer.camera.has_value();
    return in;
}

PlanInput paperScene() {
    return input({object("A", 0.25, Look::blur), object("B", 0.5, Look::focus), object("C", 0.5, Look::blur),
                  object("D", 1.3, Look::blur)});
}

const RegionPlan& regionOf(const Plan& plan, const std::string& name) {
    return *std::ranges::find(plan.regions, name, &RegionPlan::name);
}

bool says(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

std::vector<PlanObject> anyObjects() {
    std::vector<PlanObject> objects;
    const int count = *rc::gen::inRange(1, 7);
    for (int i = 0; i < count; ++i) {
        const double metres = 1e-3 * *rc::gen::inRange(120, 4000) + 1e-6 * i;  // no two alike
        objects.push_back(
            object("r" + std::to_string(i), metres, *rc::gen::element(Look::focus, Look::blur, Look::neutral)));
        if (objects.back().look == Look::blur && *rc::gen::inRange(0, 3) == 0) {
            objects.back().strength = Dioptre::fromSi(0.1 * *rc::gen::inRange(1, 20));
        }
    }
    return objects;
}

}  // namespace

TEST_CASE("plan: the paper's four objects, A, C and D blurred") {
    const Plan p = *plan(paperScene());
    CHECK(std::abs(p.pS->si() - 4.07261643584172) < 1e-12);
    CHECK(p.driver == "A");
    CHECK(p.waveform.low == 0.0_D);
    CHECK(std::abs(p.waveform.high.si() - 4.27261643584172) < 1e-12);
    CHECK(std::abs(p.farOffset.si() - 0.07261643584172) < 1e-13);
    CHECK(p.focusPower == 0.0_D);
    CHECK(p.levels.size() == 2);
    for (const RegionPlan& region : p.regions)
        CHECK(region.problem.empty());
    CHECK(regionOf(p, "B").levelPower == 0.0_D);
    CHECK(regionOf(p, "B").blurDiameterAttending == 0.0_m);
    CHECK(regionOf(p, "C").levelPower == p.waveform.high);
    CHECK(regionOf(p, "D").pMin->si() == doctest::Approx(0.841847205072491).epsilon(1e-12));
}

TEST_CASE("plan: the paper's four objects, only B blurred") {
    const Plan p = *plan(input({object("A", 0.25, Look::focus), object("B", 0.5, Look::blur),
                                object("C", 0.5, Look::focus), object("D", 1.3, Look::focus)}));
    CHECK(std::abs(p.pS->si() - 2.07261643584172) < 1e-12);
    CHECK(std::abs(p.waveform.high.si() - 2.27261643584172) < 1e-12);
    CHECK(p.driver == "B");
}

TEST_CASE("plan: nothing to blur is no sweep: the lens stands still in steady light") {
    const Plan p = *plan(input({object("A", 0.25, Look::focus), object("wall", 2.0, Look::neutral)}));
    CHECK_FALSE(p.sweeps());
    CHECK_FALSE(p.pS);
    CHECK(p.levels.size() == 1);
    CHECK(p.light == 1.0);
    CHECK(std::ranges::all_of(p.slots, [](const Slot& slot) { return slot.level() == 0; }));
    CHECK_FALSE(plan(input({}))->sweeps());
}

TEST_CASE("plan: a strength of its own lights a region at P_min + strength, and widens the sweep when it must") {
    auto scene = paperScene();
    scene.objects[0].strength = 1.0_D;
    const Plan wider = *plan(scene);
    CHECK(wider.waveform.high.si() == doctest::Approx(5.07261643584172));
    CHECK(regionOf(wider, "A").levelPower == wider.waveform.high);

    // 0.3 D above C's border lies mid-sweep, where 0..4.27 D passes in less than a slot.
    scene = paperScene();
    scene.objects[2].strength = 0.3_D;
    const Plan tooFast = *plan(scene);
    CHECK(says(regionOf(tooFast, "C").problem, "too fast"));
    CHECK(says(regionOf(tooFast, "C").help, "strength"));
    CHECK(regionOf(tooFast, "C").levelPower == tooFast.waveform.high);
}

TEST_CASE("plan: a presbyope's focus level is inside the window of sharp powers, and the sweep starts there") {
    Wearer wearer = wearerOfPaper();
    wearer.measuredAccommodation = 0.5_D;
    const Plan p = *plan(input({object("book", 0.5, Look::focus), object("lamp", 0.4, Look::blur)}, wearer));
    CHECK(p.focusPower.si() == doctest::Approx(1.42).epsilon(0.002));
    CHECK(p.waveform.low == p.focusPower);
    CHECK(p.waveform.rest == 0.0_D);
    CHECK(p.levels[0].slots.size() >= 1);
}

TEST_CASE("plan: objects whose windows do not meet get levels of their own") {
    Wearer wearer = wearerOfPaper();
    wearer.measuredAccommodation = 0.5_D;
    const Plan p = *plan(input({object("book", 0.5, Look::focus), object("shelf", 2.0, Look::focus)}, wearer));
    REQUIRE(p.levels.size() == 2);
    CHECK(p.sweeps());
    CHECK_FALSE(p.pS);
    CHECK(p.levels[0].power == 0.0_D);
    CHECK(p.levels[1].power.si() == doctest::Approx(1.42).epsilon(0.002));
    // 1 m and 2 m share one.
    CHECK(plan(input({object("desk", 1.0, Look::focus), object("shelf", 2.0, Look::focus)}, wearer))->levels.size() ==
          1);
}

TEST_CASE("plan: what an uncorrected focus power blurs already needs no sweep") {
    Wearer wearer = wearerOfPaper();
    wearer.measuredAccommodation = 0.2_D;
    const Plan p = *plan(input({object("book", 0.4, Look::focus), object("wall", 3.0, Look::blur)}, wearer));
    CHECK_FALSE(p.sweeps());
    CHECK(regionOf(p, "wall").alreadyBlurred);
    CHECK(regionOf(p, "wall").levelPower == p.focusPower);
    CHECK(p.focusPower > *regionOf(p, "wall").pMin);
}

TEST_CASE("plan: what cannot be blurred is said, with the distance that would do") {
    const Plan p = *plan(input({object("hand", 0.09, Look::blur), object("book", 0.5, Look::focus)}));
    CHECK(says(regionOf(p, "hand").problem, "cannot be blurred"));
    CHECK(says(regionOf(p, "hand").help, "Move it beyond 0.101 m"));
    CHECK_FALSE(p.sweeps());
    CHECK(plan(input({object("hand", 0.103, Look::blur)}))->regions[0].problem.empty());
}

TEST_CASE("plan: what cannot be seen sharp is said") {
    Wearer wearer = wearerOfPaper();
    wearer.measuredAccommodation = 0.5_D;
    PlanObject desk = object("desk", 0.4, Look::focus);
    desk.farthest = 2.0_m;
    const Plan deep = *plan(input({desk, object("book", 0.5, Look::focus)}, wearer));
    CHECK(says(deep.regions[0].problem, "deeper than the depth of focus"));
    CHECK_FALSE(deep.regions[0].help.empty());
    CHECK(deep.regions[0].level.has_value());
    const Plan near = *plan(input({object("nose", 0.05, Look::focus)}, wearer));
    CHECK(says(near.regions[0].help, "Move it beyond"));
}

TEST_CASE("plan: a camera lights each focused object at its own power, and refuses what a sine cannot hold") {
    Wearer wearer = wearerOfPaper();
    wearer.camera = CameraObserver{};
    const Plan two = *plan(input({object("B", 0.5, Look::focus), object("D", 1.0, Look::focus)}, wearer));
    REQUIRE(two.levels.size() == 2);
    CHECK(two.levels[0].power.si() == doctest::Approx(-1.0));
    CHECK(two.levels[1].power.si() == doctest::Approx(0.0));
    CHECK(two.waveform.rest == 0.0_D);

    const auto four = plan(input({object("A", 0.25, Look::focus), object("B", 0.4, Look::focus),
                                  object("C", 0.5, Look::focus), object("D", 1.3, Look::focus)},
                                 wearer));
    REQUIRE_FALSE(four);
    CHECK(four.error().fault == Fault::unsafe);
    CHECK(says(four.error().what, "in focus for the camera"));
}

TEST_CASE("plan: refusals") {
    auto scene = paperScene();
    scene.rig.slotRate = 1000.0_Hz;
    CHECK(plan(scene).error().fault == Fault::unsafe);
    CHECK(says(plan(scene).error().what, "flicker"));
    CHECK(says(plan(scene).error().what, "960.0 Hz"));
    CHECK(says(plan(scene).error().what, "62.5 Hz"));
    scene = paperScene();
    scene.rig.lensMax = -1.0_D;
    CHECK_FALSE(plan(scene));
    scene = paperScene();
    scene.objects[1].nearest = scene.objects[1].farthest = 0.0_m;
    CHECK(says(plan(scene).error().what, "\"B\""));
    scene = paperScene();
    scene.alpha = Dioptre::fromSi(std::nan(""));
    CHECK(plan(scene).error().fault == Fault::outOfRange);
    Wearer wearer = wearerOfPaper();
    wearer.ametropia = -15.0_D;
    CHECK(plan(input({}, wearer)).error().fault == Fault::unsafe);
}

TEST_CASE("plan: without alpha the driving region stays at its border, and that is said") {
    auto scene = paperScene();
    scene.alpha = 0.0_D;
    CHECK(says(regionOf(*plan(scene), "A").problem, "border"));
    CHECK(regionOf(*plan(scene), "D").problem.empty());
}

TEST_CASE("plan: laws") {
    law("moving the driving region nearer raises P_s", [] {
        auto in = input(anyObjects());
        const auto before = plan(in);
        RC_PRE(before && before->driver);
        const auto driver = std::ranges::find(in.objects, *before->driver, &PlanObject::id);
        driver->nearest = driver->farthest = driver->nearest * 0.999;
        const auto after = plan(in);
        RC_PRE(after && regionOf(*after, driver->name).problem.empty());
        RC_ASSERT(*after->pS > *before->pS);
    });
    law("one more focused object never changes P_s", [] {
        auto in = input(anyObjects());
        const auto before = plan(in);
        in.objects.push_back(object("new", 1e-3 * *rc::gen::inRange(120, 4000), Look::focus));
        const auto after = plan(in);
        RC_ASSERT(before.has_value() && after.has_value());
        RC_ASSERT(before->pS == after->pS);
    });
    law("the order of regions changes nothing but their order", [] {
        auto in = input(anyObjects());
        const auto before = plan(in);
        std::ranges::reverse(in.objects);
        const auto after = plan(in);
        RC_ASSERT(before.has_value() && after.has_value());
        RC_ASSERT(before->waveform == after->waveform);
        RC_ASSERT(before->levels == after->levels);
        RC_ASSERT(before->slots == after->slots);
        RC_ASSERT(before->driver == after->driver);
        auto regions = after->regions;
        std::ranges::reverse(regions);
        RC_ASSERT(regions == before->regions);
    });
    law("every blurred region without a problem is lit above its P_min, in slots that are above it too", [] {
        const auto p = plan(input(anyObjects()));
        RC_ASSERT(p.has_value());
        for (const RegionPlan& region : p->regions) {
            if (region.look != Look::blur || !region.problem.empty()) continue;
            RC_ASSERT(region.levelPower > *region.pMin);
            for (const int slot : p->levels[static_cast<std::size_t>(*region.level)].slots) {
                RC_ASSERT(p->slots[static_cast<std::size_t>(slot)].power > *region.pMin);
            }
        }
    });
    law("levels are equally bright; regions to blur make a sweep", [] {
        const auto p = plan(input(anyObjects()));
        RC_ASSERT(p.has_value());
        for (const Level& level : p->levels)
            RC_ASSERT(std::abs(level.exposure / 16.0 - p->light) < 1e-9);
        RC_ASSERT(p->light > 0.0);
        RC_ASSERT(p->sweeps() == p->pS.has_value());
    });
}
