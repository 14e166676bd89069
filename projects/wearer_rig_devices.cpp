// The devices of a rig, under "devices" in its file.
#include "projects/wearer_rig_json.h"

namespace ilf::projects {
namespace {

Json written(const DisplayIdentity& display, Json json) {
    json.set("connector", display.connector);
    json.set("maker", display.maker);
    json.set("model", display.model);
    json.set("serial", display.serial);
    return json;
}

Json written(const Amplifier& amplifier, Json json) {
    json.set("zero_V", amplifier.zero.si());
    json.set("dac_V_per_A", amplifier.dac.si());
    json.set("input_V_per_A", amplifier.input.si());
    json.set("most_A", amplifier.most.si());
    json.set("slew_A_per_s", amplifier.slew.si());
    return json;
}

Json written(const LensWiring& wiring, Json json) {
    json.set("amplifier", written(wiring.amplifier, json.object("amplifier")));
    std::vector<std::pair<double, double>> powers;
    for (const StaticPower& one : wiring.powers)
        powers.emplace_back(one.current.si(), one.power.si());
    json.setPairs("static_A_D", powers);
    return json;
}

LensWiring wiringFrom(JsonReader reader) {
    LensWiring wiring;
    if (reader.has("amplifier")) {
        JsonReader json = reader.object("amplifier");
        Amplifier& a = wiring.amplifier;
        a.zero = Volt::fromSi(json.number("zero_V", a.zero.si()));
        a.dac = VoltPerAmpere::fromSi(json.number("dac_V_per_A", a.dac.si()));
        a.input = VoltPerAmpere::fromSi(json.number("input_V_per_A", a.input.si()));
        a.most = Ampere::fromSi(json.number("most_A", a.most.si()));
        a.slew = AmperePerSecond::fromSi(json.number("slew_A_per_s", a.slew.si()));
    }
    if (reader.has("static_A_D"))
        for (const auto& [current_A, power_D] : reader.pairs("static_A_D"))
            wiring.powers.push_back({Ampere::fromSi(current_A), Dioptre::fromSi(power_D)});
    return wiring;
}

}  // namespace

Json written(const RigDevices& devices, Json json) {
    json.set("projector_at", devices.projectorAt);
    json.set("projector_plugin", devices.projectorPlugin);
    json.set("projector_options", devices.projectorOptions);
    json.set("rehearsal", devices.rehearsal);
    json.set("lenses_at", devices.lensesAt);
    json.set("display", written(devices.display, json.object("display")));
    json.set("left_lens", written(devices.left, json.object("left_lens")));
    json.set("right_lens", written(devices.right, json.object("right_lens")));
    json.set("trigger_low_V", devices.triggerLow.si());
    json.set("trigger_high_V", devices.triggerHigh.si());
    return json;
}

RigDevices rigDevicesFrom(JsonReader reader) {
    RigDevices devices;
    devices.projectorAt = reader.word("projector_at", "");
    devices.projectorPlugin = reader.word("projector_plugin", "");
    devices.projectorOptions = reader.word("projector_options", "");
    devices.rehearsal = reader.flag("rehearsal", false);
    devices.lensesAt = reader.word("lenses_at", "");
    if (reader.has("display")) {
        JsonReader display = reader.object("display");
        devices.display = {display.word("connector", ""), display.word("maker", ""), display.word("model", ""),
                           display.word("serial", "")};
    }
    if (reader.has("left_lens")) devices.left = wiringFrom(reader.object("left_lens"));
    if (reader.has("right_lens")) devices.right = wiringFrom(reader.object("right_lens"));
    devices.triggerLow = Volt::fromSi(reader.number("trigger_low_V", devices.triggerLow.si()));
    devices.triggerHigh = Volt::fromSi(reader.number("trigger_high_V", devices.triggerHigh.si()));
    return devices;
}

}  // namespace ilf::projects
