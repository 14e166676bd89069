#include "app/rigs.h"

#include <doctest/doctest.h>

#include "core/document/edit.h"
#include "core/plan/projector.h"
#include "devices/simulated/lens_emulator.h"
#include "projects/wearer_rig.h"
#include "tests/projects/folder.h"

namespace ilf::app {

TEST_CASE("rigs: the emulated one is a rig like any other, and says that it is simulated") {
    const Rig rig = emulatedRig();
    CHECK(checked(rig).has_value());
    CHECK(checkedProjector(rig).has_value());
    CHECK(slotsPerSweep(rig) == 6);
    CHECK(mostSlots(rig) == 6);
    CHECK(rig.provenance == "simulated");
    REQUIRE(rig.devices);
}

TEST_CASE("rigs: the emulated lens comes to rest where the emulated rig says") {
    const LensWiring wiring = emulatedRig().devices->left;
    for (const StaticPower& one : wiring.powers) {
        devices::LensEmulator lens(devices::lensParameters(devices::LensPreset::datasheet));
        const double drive_V = one.current.si() * wiring.amplifier.input.si();
        lens.play(Harmonics{{drive_V}}, 60.0_Hz);
        lens.warmUp();
        lens.advance(0.5_s);
        CHECK(lens.power().si() == doctest::Approx(one.power.si()).epsilon(0.01).scale(1.0));
    }
}

TEST_CASE("rigs: by word, by file, or not at all") {
    CHECK(rigFrom("simulated").value() == Rig{});
    CHECK(rigFrom("emulated").value() == emulatedRig());
    Folder folder;
    REQUIRE(projects::writeRig(folder / "room.json", emulatedRig()));
    CHECK(rigFrom((folder / "room.json").string()).value() == emulatedRig());
    folder.put("other.json", R"({"format": "illuminatedfocus-wearer", "version": 1})");
    CHECK_FALSE(rigFrom((folder / "other.json").string()));
    CHECK_FALSE(rigFrom((folder / "none.json").string()));
}

}  // namespace ilf::app
