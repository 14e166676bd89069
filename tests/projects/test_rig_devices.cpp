#include <doctest/doctest.h>

#include "core/document/edit.h"
#include "projects/wearer_rig.h"
#include "tests/projects/folder.h"
#include "tests/support/law.h"

using namespace ilf;
using namespace ilf::projects;

namespace {

double number(double low, double high) { return low + (high - low) * *rc::gen::inRange(0, 1'000'001) / 1e6; }

LensWiring someWiring() {
    LensWiring wiring;
    wiring.amplifier.zero = Volt::fromSi(number(2.4, 2.6));
    wiring.amplifier.dac = VoltPerAmpere::fromSi(number(-9.0, -5.0));
    wiring.amplifier.input = VoltPerAmpere::fromSi(number(0.1, 1.0));
    wiring.amplifier.most = Ampere::fromSi(number(0.1, 0.25));
    wiring.amplifier.slew = AmperePerSecond::fromSi(number(10.0, 2000.0));
    if (!*rc::gen::arbitrary<bool>()) return wiring;
    const int points = *rc::gen::inRange(2, 6);
    for (int i = 0; i < points; ++i)
        wiring.powers.push_back(
            {Ampere::fromSi(-0.1 + 0.03 * i + number(0.0, 0.02)), Dioptre::fromSi(-5.0 + 2.0 * i + number(0.0, 1.0))});
    return wiring;
}

Rig withDevices() {
    Rig rig;
    rig.devices.emplace();
    rig.devices->left.powers = {{Ampere::fromSi(-0.1), -6.0_D}, {Ampere::fromSi(0.1), 7.0_D}};
    return rig;
}

std::string refusal(const Rig& rig) {
    const auto fine = checked(rig);
    REQUIRE_FALSE(fine);
    return fine.error().what;
}

}  // namespace

TEST_CASE("rig's devices: what is saved opens the same, and an older file has none") {
    Folder folder;
    law("any devices survive", [&] {
        Rig rig;
        rig.devices = RigDevices{*rc::gen::element<std::string>("", "1-2", "10-4.2.11"),
                                 "3-1",
                                 {"HDMI-2", "Maker \xC3\xA4", *rc::gen::element<std::string>("", "DLP \"4500\""), "12"},
                                 someWiring(),
                                 someWiring(),
                                 Volt::fromSi(number(0.1, 0.9)),
                                 Volt::fromSi(number(1.0, 3.0)),
                                 *rc::gen::element<std::string>("", "/opt/vendor/projector.so"),
                                 *rc::gen::element<std::string>("", "mode=1, \"slow\""),
                                 false};
        rig.devices->rehearsal = rig.devices->projectorPlugin.empty() && *rc::gen::arbitrary<bool>();
        RC_ASSERT(writeRig(folder / "r.json", rig).has_value());
        const auto opened = readRig(folder / "r.json");
        if (!opened) RC_FAIL(opened.error().what);
        RC_ASSERT(*opened == rig);
    });
    REQUIRE(writeRig(folder / "old.json", Rig{}));
    CHECK(contentOf(folder / "old.json").find("devices") == std::string::npos);
    CHECK_FALSE(readRig(folder / "old.json")->devices);
    // Taken out again, they leave the file.
    REQUIRE(writeRig(folder / "old.json", withDevices()));
    REQUIRE(writeRig(folder / "old.json", Rig{}));
    CHECK_FALSE(readRig(folder / "old.json")->devices);
}

TEST_CASE("rig's devices: written by hand, what is not said is as usual") {
    Folder folder;
    REQUIRE(writeRig(folder / "r.json", Rig{}));
    std::string text = contentOf(folder / "r.json");
    text.insert(text.rfind('}'), R"(, "devices": {"lenses_at": "1-3", "left_lens": {"amplifier": {"most_A": 0.1}}})");
    folder.put("r.json", text);
    const auto rig = readRig(folder / "r.json");
    REQUIRE_MESSAGE(rig, rig.error().what);
    REQUIRE(rig->devices);
    RigDevices wanted;
    wanted.lensesAt = "1-3";
    wanted.left.amplifier.most = Ampere::fromSi(0.1);
    CHECK(*rig->devices == wanted);
}

TEST_CASE("rig's devices: what cannot be is refused with what to correct") {
    const auto refused = [](const std::function<void(RigDevices&)>& change) {
        Rig rig = withDevices();
        REQUIRE(checked(rig));
        change(*rig.devices);
        return refusal(rig);
    };
    const auto says = [](const std::string& text, const char* part) { return text.find(part) != std::string::npos; };
    CHECK(says(refused([](RigDevices& d) { d.projectorPlugin = "vendor.so"; }), "nothing is searched for"));
    CHECK(says(refused([](RigDevices& d) {
                   d.projectorPlugin = "/opt/vendor.so";
                   d.rehearsal = true;
               }),
               "leave one of the two"));
    CHECK(says(refused([](RigDevices& d) { d.projectorAt = "COM3"; }), "the projector must be one on the USB"));
    CHECK(says(refused([](RigDevices& d) { d.lensesAt = "1-2."; }), "the lenses must be one on the USB"));
    CHECK(says(refused([](RigDevices& d) { d.projectorAt = d.lensesAt = "1-2"; }), "same place"));
    CHECK(says(refused([](RigDevices& d) { d.display.model = "a\nb"; }), "its display"));
    CHECK(says(refused([](RigDevices& d) { d.left.amplifier.dac = VoltPerAmpere(); }), "The gain at the DAC"));
    CHECK(says(refused([](RigDevices& d) { d.right.amplifier.most = Ampere::fromSi(0.29); }), "0 to 5 V of the DAC"));
    CHECK(says(refused([](RigDevices& d) { d.right.amplifier.most = Ampere::fromSi(1.0); }), "0.001 to 0.3 A"));
    CHECK(says(refused([](RigDevices& d) { d.left.amplifier.slew = AmperePerSecond::fromSi(NAN); }), "slope"));
    CHECK(says(refused([](RigDevices& d) { d.left.powers.pop_back(); }), "none or from 2"));
    CHECK(says(refused([](RigDevices& d) { std::swap(d.left.powers[0], d.left.powers[1]); }), "ascend"));
    CHECK(says(refused([](RigDevices& d) { d.left.powers[1].power = d.left.powers[0].power; }), "rise or all fall"));
    CHECK(says(refused([](RigDevices& d) { d.left.powers[1].current = Ampere::fromSi(0.26); }), "amplifier gives no"));
    CHECK(says(refused([](RigDevices& d) { d.triggerLow = d.triggerHigh; }), "below the high one"));
}
