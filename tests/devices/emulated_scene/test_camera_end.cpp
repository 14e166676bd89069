// Emulated cameras one after the other: closing one waits for no rays, and the next has those of the last.
#include <doctest/doctest.h>

#include <stop_token>

#include "devices/emulated_scene/emulated_camera.h"
#include "tests/support/run_program.h"

using namespace ilf;
using namespace ilf::devices;

TEST_CASE("a camera that shall end gives up working out where light goes, and gives no picture") {
    const TemporaryDirectory nobody;
    EmulatedCamera camera(nobody.path(), {});
    std::stop_source stop;
    camera.endWhen(stop.get_token());
    stop.request_stop();
    const auto frame = camera.read();
    REQUIRE(frame.has_value());
    CHECK_FALSE(frame->has_value());
    CHECK(camera.truth() == nullptr);
}

TEST_CASE("a camera that sees what the last one saw has its rays at once, one that sees something else has its own") {
    const TemporaryDirectory nobody;
    SceneWish small;
    small.binning = 8;
    EmulatedCamera first(nobody.path(), small);
    REQUIRE(first.read());
    REQUIRE(first.truth() != nullptr);
    SceneWish dark = small;
    dark.dark = true;  // changes no rays
    EmulatedCamera second(nobody.path(), dark);
    REQUIRE(second.read());
    CHECK(second.truth() == first.truth());
    SceneWish turned = small;
    turned.turn_deg = 1.0;
    EmulatedCamera third(nobody.path(), turned);
    REQUIRE(third.read());
    CHECK(third.truth() != first.truth());
}
