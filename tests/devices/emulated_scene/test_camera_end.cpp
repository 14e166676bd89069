// Closing an emulated camera must not wait for rays that nobody will look at.
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
