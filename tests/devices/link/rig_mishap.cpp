// Mishaps as they are written on command lines.
#include "devices/link/rig_mishap.h"

#include <doctest/doctest.h>

#include <string>

using namespace ilf;
using namespace ilf::devices;

TEST_CASE("rig mishap: what is not written is at once, for ever, and nothing") {
    CHECK(*mishapFrom("projector:unplug") == RigMishap{"projector", "unplug", 0, 0, 0.0});
    CHECK(*mishapFrom("lenses:clock-drift:10:2:-200.5") == RigMishap{"lenses", "clock-drift", 10, 2, -200.5});
}

TEST_CASE("rig mishap: anything else is refused with an example") {
    for (const std::string text : {"", ":", "projector", "projector:", ":unplug", "a:b:c", "a:b:-1", "a:b:1:nan",
                                   "a:b:1e20", "a:b:1:2:3:4", "a:b:1:2:3x"}) {
        CAPTURE(text);
        const auto mishap = mishapFrom(text);
        REQUIRE_FALSE(mishap);
        CHECK(mishap.error().what.find("such as projector:unplug") != std::string::npos);
    }
}
