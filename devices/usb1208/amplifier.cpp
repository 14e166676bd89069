#include "devices/usb1208/amplifier.h"

#include <algorithm>

#include "devices/lens_driver/limits.h"

namespace ilf::devices {

Result<void> checked(const Amplifier& a, const std::string& name) {
    const auto refused = [&](const std::string& why) {
        return fail(Fault::outOfRange, "The amplifier of the " + name + " " + why + ". Correct it in the rig.");
    };
    if (!isFinite(a.zero) || !isFinite(a.dac) || a.dac == VoltPerAmpere()) return refused("has no gain at the DAC");
    if (!isFinite(a.input) || a.input == VoltPerAmpere()) return refused("has no gain at its input");
    if (!isFinite(a.most) || a.most <= Ampere()) return refused("has no greatest current");
    if (!isFinite(a.slew) || a.slew <= AmperePerSecond()) return refused("has no greatest slope of its current");
    for (const Ampere end : {a.most, -a.most}) {
        const double volts = voltsFor(a, end).si();
        if (volts < -1e-9 || volts > 5.0 + 1e-9)
            return refused("needs more than the 0 to 5 V of the DAC for its greatest current");
    }
    return {};
}

Ampere currentOf(const Amplifier& a, double drive, DriveUnit unit) {
    return unit == DriveUnit::ampere ? Ampere::fromSi(drive) : Ampere::fromSi(drive / a.input.si());
}

Volt voltsFor(const Amplifier& a, Ampere current) { return a.zero + Volt::fromSi(current.si() * a.dac.si()); }

Ampere currentAt(const Amplifier& a, Volt dac) { return Ampere::fromSi((dac - a.zero).si() / a.dac.si()); }

Ampere limited(const Amplifier& a, Ampere previous, Ampere wanted, Second step) {
    const Ampere most = Ampere::fromSi(a.slew.si() * step.si());
    const Ampere inside = clamped(wanted, {-a.most, a.most});
    const Ampere from = clamped(previous, {-a.most, a.most});
    return std::clamp(inside, from - most, from + most);
}

}  // namespace ilf::devices
