// Light cut into sweeps: by triggers where there are any, else by vertical syncs.
#include "devices/emulated_rig/received_sweeps.h"

#include <doctest/doctest.h>

#include "tests/support/law.h"

using namespace ilf;
using namespace ilf::devices;

namespace {

constexpr std::int64_t kFrame_ns = 16'666'667;

emulators::LightSlot slot(std::int64_t start_ns, std::int64_t end_ns, int pattern) {
    emulators::LightSlot made;
    made.start_ns = start_ns;
    made.end_ns = end_ns;
    made.pattern = pattern;
    return made;
}

}  // namespace

TEST_CASE("received sweeps: the newest whole one, from trigger to trigger, with all its slots in order") {
    law("every slot of the sweep and none of another", [] {
        const int slots = *rc::gen::inRange(1, 25), sweeps = *rc::gen::inRange(2, 30);
        const std::int64_t late_ns = *rc::gen::inRange(-20'000, 20'000);
        ReceivedSweeps received;
        for (int sweep = 0; sweep < sweeps; ++sweep) {
            const std::int64_t began_ns = sweep * kFrame_ns;
            received.trigger(began_ns + late_ns);
            received.sync(began_ns);
            for (int i = 0; i < slots; ++i)
                received.light(slot(began_ns + i * kFrame_ns / slots, began_ns + (i + 1) * kFrame_ns / slots, i));
        }
        const auto newest = received.newest();
        RC_ASSERT(newest);
        RC_ASSERT(newest->trigger_ns == (sweeps - 2) * kFrame_ns + late_ns);
        RC_ASSERT(newest->end_ns - newest->trigger_ns == kFrame_ns);
        RC_ASSERT(newest->light.size() == std::size_t(slots));
        for (int i = 0; i < slots; ++i)
            RC_ASSERT(newest->light[std::size_t(i)].pattern == i);
        RC_ASSERT(received.triggers() == std::uint64_t(sweeps));
        RC_ASSERT(received.syncs() == std::uint64_t(sweeps));
    });
}

TEST_CASE("received sweeps: plain video has no triggers, and old ones are not taken for new") {
    ReceivedSweeps received;
    CHECK_FALSE(received.newest());
    for (int i = 0; i < 3; ++i) {
        received.trigger(i * kFrame_ns);
        received.sync(i * kFrame_ns);
    }
    for (int i = 3; i < 12; ++i) {
        received.light(slot((i - 1) * kFrame_ns, i * kFrame_ns, 0));
        received.sync(i * kFrame_ns);
    }
    const auto newest = received.newest();
    REQUIRE(newest);
    CHECK(newest->trigger_ns == 10 * kFrame_ns);
    CHECK(newest->end_ns == 11 * kFrame_ns);
    CHECK(newest->light.size() == 1);
    received.forget();
    CHECK_FALSE(received.newest());
}
