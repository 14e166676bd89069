// What a lens may be driven with: the one place where currents are clamped and temperatures judged.
#pragma once

#include <algorithm>

#include "core/base/quantity.h"

namespace ilf::devices {

/// Of one lens, from the rig. The temperatures are this project's caution, not a manufacturer's figure: set them from
/// the lens's data sheet.
struct LensProtection {
    Ampere most = Ampere::fromSi(0.25);  ///< nominal of an EL-16-40-TC (community figure); either direction
    double warnAbove_C = 45.0, stopAbove_C = 55.0;
};

struct CurrentLimits {
    Ampere low, high;
    bool operator==(const CurrentLimits&) const = default;
};

/// The narrowest of what the rig allows, what the driver can give (`driverMost`) and what its EEPROM allows.
inline CurrentLimits currentLimits(const LensProtection& rig, Ampere driverMost, Ampere eepromLow, Ampere eepromHigh) {
    return {std::max({-rig.most, -driverMost, eepromLow}), std::min({rig.most, driverMost, eepromHigh})};
}

/// What is not a number becomes the current nearest to none. Precondition: low <= high.
inline Ampere clamped(Ampere wanted, const CurrentLimits& limits) {
    return std::clamp(isFinite(wanted) ? wanted : Ampere(), limits.low, limits.high);
}

}  // namespace ilf::devices
