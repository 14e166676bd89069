// The card of the selected region: what it says, what it keeps from frame to frame, and its "why".
#include "ui/prediction_card.h"

#include <doctest/doctest.h>

#include "tests/ui/headless.h"

using namespace ilf;
using namespace ilf::ui;
using namespace ilf::ui::test;

TEST_CASE("prediction card: says of the selected region what core predicts of it") {
    Desk desk(twoRegions());
    REQUIRE(desk.state.predicted);
    CHECK(desk.state.predicted->region.id == "Clutter");
    const auto planned = ilf::plan(planInput(desk.document()));
    REQUIRE(planned);
    CHECK(desk.state.predicted->plan == *planned);
    const auto& clutter = *std::ranges::find(planned->regions, RegionId("Clutter"), &RegionPlan::id);
    const RegionPrediction seen = predicted(*planned, clutter, desk.document());
    CHECK(desk.state.predicted->seen == seen);
    CHECK(desk.state.predicted->said == statement(*planned, clutter, seen));
}

TEST_CASE("prediction card: nothing is worked out again until something it rests on changes") {
    Desk desk(twoRegions());
    const auto first = desk.state.predicted;
    desk.settle();
    CHECK(desk.state.predicted == first);
    const auto now = [&] {
        desk.settle();
        return desk.state.predicted->seen;
    };
    const RegionPrediction before = first->seen;

    desk.history.preview(*edited(desk.document(), SetDistance{"Clutter", ConstantDistance{0.5_m, 0.02_m}}));
    desk.history.commit("tolerance");
    CHECK(now().blur_arcmin.part(ErrorSource::distance) > before.blur_arcmin.part(ErrorSource::distance));

    Wearer wide = desk.document().wearer;
    wide.pupil = 6.0_mm;
    desk.history.preview(*edited(desk.document(), SetWearer{wide}));
    desk.history.commit("pupil");
    CHECK(now().blur_arcmin.value > before.blur_arcmin.value);

    Seam narrow = desk.document().seam;
    narrow.feather = 4.0_mm;
    const double seam = now().seam.value;
    desk.history.preview(*edited(desk.document(), SetSeam{narrow}));
    desk.history.commit("feather");
    CHECK(now().seam.value > seam);

    desk.state.selected = "Face";
    desk.settle();
    CHECK(desk.state.predicted->region.id == "Face");
}

TEST_CASE("prediction card: why the +- is so large opens with a click and stays open") {
    Desk desk(twoRegions(), {1280, 1600});  // the region has a panel of its own, in full
    CHECK_FALSE(desk.state.whyOpen);
    CHECK(desk.press("###selected", {"region", "###why"}).empty());
    CHECK(desk.state.whyOpen);
    desk.state.selected = "Face";
    desk.settle();
    CHECK(desk.state.whyOpen);
    desk.press("###selected", {"region", "###why"});
    CHECK_FALSE(desk.state.whyOpen);
}

TEST_CASE("prediction card: a region that cannot be blurred says the problem, and no plan leaves no card") {
    Desk desk(twoRegions());
    desk.history.preview(*edited(desk.document(), SetDistance{"Clutter", ConstantDistance{0.06_m, {}}}));
    desk.history.commit("near");
    desk.settle();
    CHECK(desk.state.predicted->said.about == Saying::problem);
    CHECK(desk.state.predicted->said.text.starts_with("\"Clutter\" cannot be blurred"));
}

TEST_CASE("prediction card: is drawn alike on a display of twice the scale") {
    const auto saidAt = [](Size window, double scale) {
        Desk desk(twoRegions(), window, scale);
        desk.press("###selected", {"region", "###why"});
        return std::pair(desk.state.predicted->said, desk.state.whyOpen);
    };
    CHECK(saidAt({1280, 1600}, 1.0) == saidAt({2560, 3200}, 2.0));
    CHECK(saidAt({2560, 3200}, 2.0).second);
}
