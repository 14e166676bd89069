// What a plan says for itself: reasons, help, notes with known values, and the curve of light against error.
#include "core/plan/report.h"

#include <cmath>

#include "tests/support/law.h"

using namespace ilf;

namespace {

PlanObject object(const char* name, double metres, Look look) {
    return {name, name, look, std::nullopt, Metre::fromSi(metres), Metre::fromSi(metres)};
}

PlanInput scene(std::vector<PlanObject> objects) {
    Wearer wearer;
    wearer.confusion.preset = CircleOfConfusion::Preset::oneArcmin;
    PlanInput input;
    input.objects = std::move(objects);
    input.eye = eyeOptics(wearer);
    input.rig.waves = WaveMode::idealSine;
    return input;
}

Plan twoObjects() { return *plan(scene({object("book", 0.5, Look::focus), object("clutter", 0.5, Look::blur)})); }

bool says(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

const PlanNote& noteOn(const std::vector<PlanNote>& notes, NoteTopic topic) {
    return *std::ranges::find(notes, topic, &PlanNote::topic);
}

}  // namespace

TEST_CASE("report: flicker fusion has the reference's values") {
    // Scheduling 7: 200 lx effective on white, fields of 10, 30 and 50 degrees.
    const double luminance = 200.0 * 0.8 / 3.14159265;
    CHECK(flickerFusion(luminance, 1.97, 10.0, 28.0).si() == doctest::Approx(64.0).epsilon(0.03));
    CHECK(flickerFusion(luminance, 1.97, 30.0, 28.0).si() == doctest::Approx(73.0).epsilon(0.03));
    CHECK(flickerFusion(luminance, 1.97, 50.0, 28.0).si() == doctest::Approx(78.0).epsilon(0.03));
    CHECK(flickerFusion(20.0 * 0.8 / 3.14159265, 1.97, 10.0, 28.0).si() == doctest::Approx(52.0).epsilon(0.03));
}

TEST_CASE("report: a few slots flash by nearly all they can, at the sweep rate and its multiples") {
    const Plan p = twoObjects();
    for (std::size_t l = 0; l < p.levels.size(); ++l) {
        CHECK(modulationAt(p, l, 1) > 1.85);
        CHECK(modulationAt(p, l, 1) < 2.0);
        CHECK(modulationAt(p, l, 16) < 0.05);  // every slot alike: nothing at the slot rate
    }
    const auto notes = planNotes(p);
    CHECK(says(noteOn(notes, NoteTopic::flicker).text, "60 Hz"));
    CHECK(says(noteOn(notes, NoteTopic::flicker).model, "Farrell"));
}

TEST_CASE("report: ambient light gives blurred print away, as the reference says") {
    // Scheduling 6: DynaFlash sine, 2.2 D, 12 % on 1 m2: 40 lx of light; 40 lx ambient leave 6.6 % and 37 %.
    PlanInput input = scene({object("book", 0.5, Look::focus), object("clutter", 0.5, Look::blur)});
    input.rig.room.ambient_lx = 40.0;
    Plan p = *plan(input);
    p.input.rig.room.litArea_m2 = p.input.rig.room.projector_lm * p.light / 40.0;
    CHECK(litIlluminance(p) == doctest::Approx(40.0));
    const ContrastLeft blurred = contrastLeft(p, p.regions[1]), sharp = contrastLeft(p, p.regions[0]);
    CHECK(blurred.ambient == doctest::Approx(0.09).epsilon(0.35));
    CHECK(blurred.dark < 0.03);
    CHECK(sharp.dark == doctest::Approx(0.59).epsilon(0.01));
    CHECK(sharp.ambient == doctest::Approx(0.37).epsilon(0.05));
    CHECK(noteOn(planNotes(p), NoteTopic::ambient).warns);
    CHECK(noteOn(planNotes(p), NoteTopic::privacy).warns);

    law("up to the light it names, the contrast stays below what was asked", [&] {
        Plan q = p;
        const double contrast = *rc::gen::inRange(30, 200) * 1e-3;
        q.input.rig.room.ambient_lx = ambientFor(q, q.regions[1], contrast);
        if (q.input.rig.room.ambient_lx > 0.0)
            RC_ASSERT(std::abs(contrastLeft(q, q.regions[1]).ambient - contrast) < 1e-9);
    });
}

TEST_CASE("report: the driving region moved gives the power and the light the sentence says") {
    const PlanInput input = scene({object("A", 0.25, Look::blur), object("B", 0.5, Look::focus),
                                   object("C", 0.5, Look::blur), object("D", 1.3, Look::blur)});
    const Plan p = *plan(input);
    const PlanReport report = planReport(p);
    CHECK(says(report.why, "\"A\""));
    CHECK(says(report.why, "4.27 D"));
    REQUIRE_FALSE(report.help.empty());
    CHECK(says(report.help[0], "Move \"A\" from 0.250 m to 0.500 m: P_s falls from 4.07 D to 2.07 D"));
    PlanInput moved = input;
    moved.objects[0].nearest = moved.objects[0].farthest = 0.5_m;
    const double gain = 100.0 * (plan(moved)->light / p.light - 1.0);
    CHECK(says(report.help[0], std::to_string(std::lround(gain)) + " %"));
}

TEST_CASE("report: the curve of light passes through the plan, and rises") {
    const Plan p = twoObjects();
    const auto curve = lightCurve(p, 41);
    REQUIRE(curve.size() == 41);
    CHECK(curve.front().budget.si() == doctest::Approx(0.01));
    CHECK(curve.back().budget.si() == doctest::Approx(1.0));
    CHECK(curve[20].budget == p.input.rig.powerBudget);
    CHECK(curve[20].light == doctest::Approx(p.light).epsilon(0.03));
    for (std::size_t i = 1; i < curve.size(); ++i)
        CHECK(curve[i].light >= curve[i - 1].light / 1.03);
    CHECK(curve.back().light > 1.2 * curve[20].light);  // P_min, not the error, is what then limits blur
    CHECK(lightCurve(*plan(scene({object("book", 0.5, Look::focus)}))).empty());
}
