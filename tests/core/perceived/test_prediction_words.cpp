// What predictions say: one sentence for each look, the order in which they win, and privacy on both sides of its
// thresholds.
#include "core/perceived/prediction_words.h"

#include <doctest/doctest.h>

#include "core/plan/notes.h"

using namespace ilf;

namespace {

bool says(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

PlanObject object(const char* name, double metres, Look look) {
    return {name, name, look, std::nullopt, Metre::fromSi(metres), Metre::fromSi(metres)};
}

struct Planned {
    Document document;
    Plan plan;
    Statement of(std::size_t i) const { return statement(plan, plan.regions[i], seen(i)); }
    RegionPrediction seen(std::size_t i) const { return predicted(plan, plan.regions[i], document); }
    /// As if that much contrast were left, attending what is focused and looked at.
    Statement with(std::size_t i, double aside, double looked) const;
};

Planned planned(std::vector<PlanObject> objects, Document document = {}) {
    document.wearer.confusion.preset = CircleOfConfusion::Preset::oneArcmin;
    document.rig.waves = WaveMode::idealSine;
    PlanInput input = planInput(document);
    input.objects = std::move(objects);
    return {document, *plan(input)};
}

Planned desk(double strength = 0.0) {
    std::vector<PlanObject> objects{object("book", 0.5, Look::focus), object("letter", 0.5, Look::blur),
                                    object("wall", 2.0, Look::neutral)};
    if (strength > 0.0) objects[1].strength = Dioptre::fromSi(strength);
    return planned(std::move(objects));
}

}  // namespace

TEST_CASE("prediction words: a blurred region says its blur with one +-, its acuity and what print keeps") {
    const Statement said = desk(3.5).of(1);
    CHECK(said.about == Saying::blurred);
    CHECK_FALSE(said.warns);
    CHECK(says(said.text, "Blurred to about 79 \u00b1 20\u2032 (5.8 D): like 20/300"));
    CHECK(says(said.text, "3 mm print at 0.5 m keeps at most 1.0 % contrast (sharp: 59 %)."));
    // One statement, one +-.
    CHECK(said.text.find("\u00b1") == said.text.rfind("\u00b1"));
}

TEST_CASE("prediction words: a sharp region says what it keeps, its seam first where that will be seen") {
    Planned scene = desk();
    const Statement seam = scene.of(0);
    CHECK(seam.about == Saying::seam);
    CHECK(says(seam.text,
               "its border shows: up to 14 \u00b1 3 % brighter or darker; 3 mm print at 0.5 m keeps at least"));
    CHECK(seam.privacy.empty());
    scene.document.wearer.axes = {LensAxis{}, LensAxis{}};
    scene.document.seam.feather = 40.0_mm;
    const Statement sharp = scene.of(0);
    CHECK(sharp.about == Saying::sharp);
    CHECK(says(sharp.text, "Sharp: blurred by no more than 1.5\u2032; 3 mm print at 0.5 m keeps at least 56 %"));
    CHECK(says(sharp.text, "of steady light."));
    scene.plan.levels[0].rmsError = 0.5_D;
    const Statement soft = scene.of(0);
    CHECK(soft.about == Saying::soft);
    CHECK(soft.warns);
    CHECK(says(soft.text, "May look soft: blurred to 0 \u00b1 7\u2032, and 4.1\u2032 still counts as sharp"));
}

TEST_CASE("prediction words: a neutral region says which part of its light is sharp, and in steady light that it is") {
    const Statement said = desk().of(2);
    CHECK(said.about == Saying::even);
    CHECK(says(said.text, "sharp in 50 % of its light, under a haze blurred to 32 \u00b1 8\u2032 (2.3 D) in the rest"));
    CHECK(says(said.text, "12 mm print at 2 m keeps at least 28 %"));
    CHECK(planned({object("wall", 2.0, Look::neutral)}).of(0).about == Saying::steady);
}

TEST_CASE("prediction words: a region that cannot be blurred says the plan's problem first") {
    const Planned scene = planned({object("book", 0.5, Look::focus), object("lash", 0.06, Look::blur)});
    const Statement said = scene.of(1);
    CHECK(said.about == Saying::problem);
    CHECK(said.warns);
    CHECK(said.text == scene.plan.regions[1].problem);
    CHECK(says(said.text, "\"lash\" cannot be blurred at 0.060 m"));
    CHECK(says(said.help, "Move it beyond"));
    CHECK(says(said.privacy, "People without glasses read all of it."));
}

Statement Planned::with(std::size_t i, double aside, double looked) const {
    RegionPrediction p = seen(i);
    p.contrast = {aside, {}};
    p.contrastLooked = {looked, {}};
    p.print = legibility(p);
    return statement(plan, plan.regions[i], p);
}

TEST_CASE("prediction words: privacy holds up to 2 % of contrast, looked at, the +- included") {
    const Planned scene = desk();
    const Statement hidden = scene.with(1, 0.0199, 0.0199);
    CHECK_FALSE(hidden.privacyWarns);
    CHECK(says(hidden.privacy, "To the wearer 3 mm print at 0.5 m stays unreadable, even looked at: at most 2.0 %"));
    CHECK(says(hidden.privacy, "Letters of"));
    const Statement aside = scene.with(1, 0.0199, 0.0201);
    CHECK(aside.privacyWarns);
    CHECK(says(aside.privacy, "stays unreadable only while the eye looks at \"book\""));
    CHECK(aside.about == Saying::blurred);
    const Statement doubtful = scene.with(1, 0.0201, 0.0201);
    CHECK(says(doubtful.privacy, "No privacy"));
    CHECK(doubtful.about == Saying::blurred);
    const Statement readable = scene.with(1, 0.0501, 0.3);
    CHECK(readable.about == Saying::readable);
    CHECK(readable.warns);
    CHECK(says(readable.text, "Print in it can be read. Blurred to about"));
    for (const Statement& said : {hidden, aside, doubtful, readable})
        CHECK(says(said.privacy, "People without glasses read all of it."));

    RegionPrediction p = scene.seen(1);
    p.contrast = {0.015, {0.0, 0.004, 0.0, 0.0}};
    p.contrastLooked = {0.01, {}};
    CHECK(legibility(p) == Legibility::hidden);
    p.contrast.from[3] = 0.004;  // 0.0057 together
    CHECK(legibility(p) == Legibility::doubtful);
}

TEST_CASE("prediction words: a deep enough blur in a dark room is private, in a lit one it is not") {
    const Planned deep = desk(6.0);
    CHECK(deep.seen(1).print == Legibility::hidden);
    Document lit;
    lit.rig.room.ambient_lx = 200.0;
    std::vector<PlanObject> objects{object("book", 0.5, Look::focus), object("letter", 0.5, Look::blur)};
    objects[1].strength = 6.0_D;
    CHECK(planned(std::move(objects), lit).seen(1).print == Legibility::readable);
    // The paper's alpha keeps an eye that looks elsewhere from reading; one that relaxes reads.
    CHECK(desk().seen(1).contrastLooked.value > 0.4);
}

TEST_CASE("prediction words: a camera is told blur alone") {
    Document document;
    document.wearer.camera = CameraObserver{};
    const Planned scene = planned({object("B", 0.5, Look::focus), object("C", 0.5, Look::blur)}, std::move(document));
    const Statement said = scene.of(1);
    CHECK(says(said.text, "Blurred for the camera to about"));
    CHECK_FALSE(says(said.text, "20/"));
    CHECK(said.privacy.empty());
}

TEST_CASE("prediction words: a +- is written with as many decimals as it has sense") {
    CHECK(plusMinus(30.4, 7.6) == "30 \u00b1 8");
    CHECK(plusMinus(3.04, 0.76) == "3.0 \u00b1 0.8");
    CHECK(plusMinus(1.234, 0.056) == "1.23 \u00b1 0.06");
    CHECK(plusMinus(12.0, 0.0) == "12.0 \u00b1 0.0");
    CHECK(plusMinusPercent({0.14, {0.0, 0.0, 0.03, 0.0}}) == "14 \u00b1 3 %");
}
