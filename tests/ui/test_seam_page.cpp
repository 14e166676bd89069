// The seam page's list of borders, and the button that sets the feather a border asks for.
#include <doctest/doctest.h>

#include "tests/ui/headless.h"
#include "ui/seam_marks.h"

using namespace ilf;
using namespace ilf::ui;
using namespace ilf::ui::test;
using When = EditRequest::When;

namespace {

/// One border that asks for 23.4 mm.
std::shared_ptr<const std::vector<BorderSeam>> oneBorder(bool depthStep) {
    BorderSeam seam;
    seam.blurred = "Clutter";
    seam.other = kBackgroundId;
    seam.depthStep = depthStep;
    seam.now[0].weber = 0.03;
    seam.now[1].weber = 0.05;
    seam.points = {{{200.0, 60.0}, {0.03, 0.05}}};
    seam.hiding = hidingWidth(0.0_mm, 0.274_mm, 2.0_mm, 100.0_mm);
    return std::make_shared<const std::vector<BorderSeam>>(std::vector<BorderSeam>{seam});
}

}  // namespace

TEST_CASE("seam page: the button of a border sets the feather that hides it, in whole millimetres") {
    Desk desk(twoRegions(), {1280, 1400});
    desk.state.page = Page::seam;
    desk.dress = [](View& view) { view.computed.seams = oneBorder(false); };
    desk.settle();
    const Requests asked = desk.press(pageWindow(Page::seam), {"Clutter/background", "###hide"});
    const auto* set = lastEdit<SetSeam>(asked, When::commit);
    REQUIRE(set != nullptr);
    CHECK(set->seam.feather.in(1.0_mm) == doctest::Approx(24.0));
    CHECK(set->seam.blending == Blending::closedForm);
    // Nothing is left to set once it is as wide as that.
    desk.settle();
    CHECK(desk.press(pageWindow(Page::seam), {"Clutter/background", "###hide"}).empty());
}

TEST_CASE("seam page: beside a depth step no feather helps, so none is offered") {
    Desk desk(twoRegions(), {1280, 1400});
    desk.state.page = Page::seam;
    desk.dress = [](View& view) { view.computed.seams = oneBorder(true); };
    desk.settle();
    CHECK(lastEdit<SetSeam>(desk.press(pageWindow(Page::seam), {"Clutter/background", "###hide"}), When::commit) ==
          nullptr);
}

TEST_CASE("seam marks: hidden, faint and visible seams have colours of their own") {
    CHECK(seamColour(0.005) == colour::good);
    CHECK(seamColour(0.02) == colour::warn);
    CHECK(seamColour(0.05) == colour::fault);
    CHECK(sight(kFaintSeam) == SeamSight::faint);
    CHECK(sight(kVisibleSeam) == SeamSight::visible);
}

TEST_CASE("seam marks: M hides them and brings them back") {
    Desk desk(twoRegions(), {1280, 1400});
    desk.dress = [](View& view) { view.computed.seams = oneBorder(false); };
    const auto drawn = [&] {
        desk.settle();
        return ImGui::GetDrawData()->TotalVtxCount;
    };
    const int shown = drawn();
    desk.key('M');
    CHECK_FALSE(desk.state.seamMarks);
    const int hidden = drawn();
    CHECK(hidden < shown);
    desk.key('M');
    CHECK(drawn() == shown);
}
