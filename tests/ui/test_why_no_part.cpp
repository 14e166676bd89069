// What is read of a region that the plan leaves out.
#include "ui/why_no_part.h"

#include <doctest/doctest.h>

#include "tests/ui/headless.h"

using namespace ilf;
using namespace ilf::ui;
using namespace ilf::ui::test;

TEST_CASE("selected: a region that takes no part says why, and what would help") {
    Desk desk(newDocument(twoRegions().scene));
    desk.dress = [](View&) {};
    const auto region = [&](const char* id, double opacity) {
        Region added;
        added.id = added.name = id;
        added.look = Look::blur;
        added.distance = ConstantDistance{0.5_m, {}};
        Document document = *edited(desk.document(), AddRegion{added, 0});
        if (opacity > 0.0)
            document =
                *edited(document, Paint{id, {Dab{{100, 100}, Brush{30.0, 1.0, opacity}}}, PaintMode::add, false});
        desk.history.preview(document);
        desk.history.commit("set up");
    };
    const auto why = [&](const char* id) {
        desk.state.selected = id;
        desk.settle();
        return whyNoPart(desk.document(), *findRegion(desk.document(), id));
    };
    region("bare", 0.0);
    region("faint", 0.4);
    region("strong", 1.0);
    CHECK(plan(planInput(desk.document()))->regions.size() == 2);  // "strong", and the background
    CHECK(why("bare") == "Covers nothing yet: paint it.");
    CHECK(why("faint").find("less than half of every pixel") != std::string::npos);
    region("above", 1.0);
    CHECK(why("strong") == "Regions above it hide all of it.");
    desk.history.preview(*edited(desk.document(), SetVisible{"above", false}));
    desk.history.commit("hide");
    CHECK(why("above").find("hidden") != std::string::npos);
    desk.history.preview(*edited(desk.document(), SetSolo{"strong", true}));
    desk.history.commit("solo");
    CHECK(why("faint").find("solo") != std::string::npos);
}
