#include <doctest/doctest.h>

#include <functional>

#include "app/output_core/played_rig.h"
#include "app/output_core/rest_current.h"
#include "app/output_core/stage_mark.h"
#include "app/output_core/stage_of.h"
#include "app/output_core/usb_place.h"
#include "app/rigs.h"
#include "projects/wearer_rig.h"
#include "tests/devices/programs.h"
#include "tests/projects/folder.h"
#include "tests/support/law.h"

namespace ilf::app {
namespace {

bool says(const std::string& text, const char* part) { return text.find(part) != std::string::npos; }

double number(double low, double high) { return low + (high - low) * *rc::gen::inRange(0, 1'000'001) / 1e6; }

/// Points that ascend in current, with powers that all rise or all fall.
LensWiring someWiring() {
    LensWiring wiring;
    const double sign = *rc::gen::element(-1.0, 1.0);
    double current = -0.1, power = number(-6.0, -4.0);
    const int points = *rc::gen::inRange(2, 8);
    for (int i = 0; i < points; ++i) {
        wiring.powers.push_back({Ampere::fromSi(current), Dioptre::fromSi(sign * power)});
        current += number(0.001, 0.03);
        power += number(0.01, 2.0);
    }
    return wiring;
}

}  // namespace

TEST_CASE("rig choice: words and files say what plays") {
    CHECK(playedRig("simulated")->machine == Machine::simulated);
    CHECK(playedRig("emulated")->machine == Machine::emulated);
    Folder folder;
    REQUIRE(projects::writeRig(folder / "old.json", Rig{}));
    REQUIRE(projects::writeRig(folder / "room.json", emulatedRig()));
    CHECK(playedRig((folder / "old.json").string())->machine == Machine::simulated);
    const auto room = playedRig((folder / "room.json").string());
    CHECK(room->machine == Machine::real);  // devices in a file are those of this machine
    CHECK(room->word == (folder / "room.json").string());
    CHECK_FALSE(playedRig((folder / "none.json").string()));
    CHECK_FALSE(lightsThroughDisplay(*playedRig("simulated")));
    CHECK(lightsThroughDisplay(*playedRig("emulated")));
}

TEST_CASE("rig choice: a rig that cannot be played refuses with the reason and never plays a simulation") {
    Folder folder;
    PlayedRig dynaFlash{"room.json", Rig{}, Machine::real};
    dynaFlash.rig.devices.emplace();
    const auto fast = stageOf(dynaFlash, folder.path());
    PlayedRig emulated{"emulated", emulatedRig(), Machine::emulated};
    const auto unready = stageOf(emulated, folder.path());
    for (const auto& [stage, why] : {std::pair(fast.get(), "through a plugin"), std::pair(unready.get(), "Xvfb")}) {
        stage->safeLight();
        for (const auto& done : {stage->load(test::program(1)), stage->swap(), stage->heartbeat()}) {
            REQUIRE_FALSE(done);
            CHECK(says(done.error().what, why));
        }
        const auto report = stage->report();
        CHECK(says(report.projectorLine, why));
        CHECK_FALSE(report.well);
        REQUIRE(report.devices.size() == 1);
        CHECK(report.devices[0].health == devices::DeviceHealth::absent);
        CHECK(says(report.devices[0].line, why));
    }
    CHECK_FALSE(fast->report().simulated);
    CHECK(unready->report().emulated);
}

TEST_CASE("rig choice: a vendor's projector comes through the plugin that the rig names, or nothing plays") {
    Folder folder;
    PlayedRig rig{"room.json", Rig{}, Machine::real};
    rig.rig.devices.emplace().projectorPlugin = (folder / "none.so").string();
    CHECK_FALSE(lightsThroughDisplay(rig));
    const auto stage = stageOf(rig, folder.path());
    CHECK(says(stage->name(), "through a plugin"));
    const auto found = stage->heartbeat();
    REQUIRE_FALSE(found);
    CHECK(says(found.error().what, "none.so"));
    CHECK_FALSE(stage->report().well);
}

TEST_CASE("rig choice: any projector rehearses, lit through a display, and moves no lens") {
    Folder folder;
    PlayedRig rig{"room.json", Rig{}, Machine::real};
    rig.rig.devices.emplace().rehearsal = true;
    CHECK(lightsThroughDisplay(rig));
    CHECK(says(stageOf(rig, folder.path())->name(), "nothing is blurred"));
}

TEST_CASE("rest current: on the straight line between two points, and nowhere beyond them") {
    law("each point gives its own current, and what lies between stays between and in order", [] {
        const LensWiring wiring = someWiring();
        for (const auto& point : wiring.powers)
            RC_ASSERT(std::abs((restCurrent(wiring, point.power, "left lens").value() - point.current).si()) < 1e-12);
        const auto &a = wiring.powers.front(), &b = wiring.powers.back();
        double shares[] = {number(0.0, 1.0), number(0.0, 1.0)};
        std::sort(std::begin(shares), std::end(shares));
        const Ampere lower = restCurrent(wiring, a.power + shares[0] * (b.power - a.power), "left lens").value();
        const Ampere upper = restCurrent(wiring, a.power + shares[1] * (b.power - a.power), "left lens").value();
        RC_ASSERT(lower >= a.current && lower <= upper && upper <= b.current);
    });
    law("beyond the ends it is refused with what is known", [] {
        const LensWiring wiring = someWiring();
        const auto [low, high] = std::minmax(wiring.powers.front().power, wiring.powers.back().power);
        const Dioptre away = Dioptre::fromSi(number(0.001, 5.0));
        for (const Dioptre power : {low - away, high + away, Dioptre::fromSi(std::nan(""))}) {
            const auto refused = restCurrent(wiring, power, "right lens");
            RC_ASSERT_FALSE(refused.has_value());
            RC_ASSERT(says(refused.error().what, "right lens"));
        }
    });
    CHECK(restCurrent({}, 0.0_D, "left lens").value() == Ampere());
    CHECK(says(restCurrent({}, -1.5_D, "left lens").error().what, "-1.50 D"));
    // 0.51 D at no current: the emulated lens needs some to rest at 0 D.
    const Ampere zero = restCurrent(emulatedRig().devices->left, 0.0_D, "left lens").value();
    CHECK(zero.si() == doctest::Approx(-0.00739).epsilon(0.01));
}

TEST_CASE("stage mark: keeps the power at which the lenses rest, until the stage is left alone") {
    Folder folder;
    CHECK_FALSE(stageIsMarked(folder.path()));
    CHECK(markedRest(folder.path()) == 0.0_D);
    for (const Dioptre rest : {0.0_D, Dioptre::fromSi(-1.0 / 3.0), 2.25_D}) {
        markStage(folder.path(), rest);
        CHECK(stageIsMarked(folder.path()));
        CHECK(markedRest(folder.path()) == rest);
    }
    folder.put("stage-in-use", "1e9");
    CHECK(markedRest(folder.path()) == 0.0_D);
    folder.put("stage-in-use", "rubbish");
    CHECK(markedRest(folder.path()) == 0.0_D);
    unmarkStage(folder.path());
    CHECK_FALSE(stageIsMarked(folder.path()));
}

TEST_CASE("usb places: the one meant, or a sentence that says what is wrong") {
    CHECK(placeOf("LightCrafter 4500", "1-2", {"1-1", "1-2"}).value() == "1-2");
    CHECK(placeOf("LightCrafter 4500", "", {"3-1"}).value() == "3-1");
    CHECK(says(placeOf("LightCrafter 4500", "", {}).error().what, "plug it in"));
    CHECK(says(placeOf("LightCrafter 4500", "", {"1-1", "1-2"}).error().what, "1-1, 1-2"));
    CHECK(says(placeOf("LightCrafter 4500", "1-3", {}).error().what, "USB 1-3"));
    CHECK(says(placeOf("LightCrafter 4500", "1-3", {"1-2"}).error().what, "there is one at 1-2"));
}

}  // namespace ilf::app
