// The amplifier between DAC and lens: volts, amperes, and the one place where both are limited.
#pragma once

#include <string>

#include "core/base/quantity.h"
#include "core/base/result.h"
#include "core/lens/waveform.h"

namespace ilf::devices {

using VoltPerAmpere = Quantity<0, 0, -1, 1>;
using AmperePerSecond = Quantity<0, -1, 1>;

/// From the rig; the defaults are a bipolar amplifier behind a divider that maps 0..5 V to +-0.07 V (paper, section 4)
/// and that to +-250 mA.
///
/// At 0 V, which is what an unplugged or unpowered DAC gives, such an amplifier drives its full negative current. It
/// needs an enable or relay of its own; no software can bring that about.
struct Amplifier {
    Volt zero = Volt::fromSi(2.5);                           ///< at the DAC, where no current flows
    VoltPerAmpere dac = VoltPerAmpere::fromSi(10.0);         ///< change at the DAC for each ampere; below 0: inverting
    VoltPerAmpere input = VoltPerAmpere::fromSi(0.28);       ///< what a drive in volts means
    Ampere most = Ampere::fromSi(0.25);                      ///< either direction
    AmperePerSecond slew = AmperePerSecond::fromSi(1000.0);  ///< 20.8 mA a sample; a 60 Hz sine of 250 mA needs 94
    bool operator==(const Amplifier&) const = default;
};

/// Refuses gains of 0, limits that are not above 0, and a greatest current that 0..5 V at the DAC cannot give.
Result<void> checked(const Amplifier& amplifier, const std::string& name);

/// What `drive` means: amperes through the lens, or volts at the amplifier's input.
Ampere currentOf(const Amplifier& amplifier, double drive, DriveUnit unit);
/// At the DAC.
Volt voltsFor(const Amplifier& amplifier, Ampere current);
Ampere currentAt(const Amplifier& amplifier, Volt dac);

/// The next current on the way from `previous` to `wanted`, `step` later: never beyond `most`, never faster than
/// `slew`. What is not a number counts as 0 mA. Every sample goes through here.
Ampere limited(const Amplifier& amplifier, Ampere previous, Ampere wanted, Second step);

}  // namespace ilf::devices
