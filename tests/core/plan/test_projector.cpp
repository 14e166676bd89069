// What projectors can show in a sweep, and what becomes of slots that are no multiple of it.
#include "core/plan/projector.h"

#include "tests/support/law.h"

using namespace ilf;

TEST_CASE("projector: a LightCrafter 4500 shows as many slots as its bit planes and exposures allow") {
    // Devices reference 1.6: slots of a 60 Hz frame by bits.
    constexpr int kSlots[] = {24, 12, 8, 6, 4, 4, 3, 2};
    for (int bits = 1; bits <= 8; ++bits) {
        const Rig rig = withProjector(Rig{}, ProjectorKind::lightCrafter4500, bits);
        INFO(bits);
        CHECK(mostSlots(rig) == kSlots[bits - 1]);
        CHECK(slotsPerSweep(rig) == kSlots[bits - 1]);
        CHECK(checkedProjector(rig));
    }
}

TEST_CASE("projector: slots that do not fit are refused with what would") {
    Rig rig = withProjector(Rig{}, ProjectorKind::lightCrafter4500, 6);
    rig.slotRate = 6.0 * rig.sweepRate;
    const auto refused = checkedProjector(rig);
    REQUIRE_FALSE(refused);
    CHECK(refused.error().fault == Fault::unsafe);
    CHECK(refused.error().what.find("2500 us") != std::string::npos);
    CHECK(refused.error().what.find("4 slots, 240.0 Hz") != std::string::npos);

    Rig fast;
    fast.slotRate = 1020.0_Hz;
    CHECK_FALSE(checkedProjector(fast));
    fast.slotRate = 960.0_Hz;
    CHECK(checkedProjector(fast));
    fast.sweepRate = 90.0_Hz;
    CHECK(mostSlots(fast) == 11);
}

TEST_CASE("projector: 1000 slots over 60 sweeps beat at 20 Hz, by the amount the reference simulated") {
    const Beat beat = slowestBeat(1000.0_Hz, 60.0_Hz);
    CHECK(beat.frequency.si() == doctest::Approx(20.0));
    CHECK(beat.modulation == doctest::Approx(0.048).epsilon(0.05));
    CHECK(slowestBeat(960.0_Hz, 60.0_Hz).modulation == 0.0);
    CHECK(slowestBeat(1000.0_Hz, 62.5_Hz).modulation == 0.0);
}
