// Volts at the DAC and amperes through the lens, and the one place where both are limited.
#pragma once

#include <string>

#include "core/base/result.h"
#include "core/document/rig_devices.h"
#include "core/lens/waveform.h"

namespace ilf::devices {

using ilf::Amplifier, ilf::AmperePerSecond, ilf::VoltPerAmpere;

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
