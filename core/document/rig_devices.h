// The devices a real rig is made of: where they hang, and what its amplifiers and wires make of numbers.
#pragma once

#include <string>
#include <vector>

#include "core/base/quantity.h"

namespace ilf {

using VoltPerAmpere = Quantity<0, 0, -1, 1>;
using AmperePerSecond = Quantity<0, -1, 1>;

/// Which display a picture must be on, so that it never lands on the operator's.
struct DisplayIdentity {
    std::string connector;     ///< "HDMI-2"
    std::string maker, model;  ///< as its EDID says
    std::string serial;        ///< may be empty
    bool operator==(const DisplayIdentity&) const = default;
};

/// The amplifier between DAC and lens. The defaults are a bipolar amplifier behind a divider that maps 0..5 V to
/// +-0.07 V (paper, section 4) and that to +-250 mA.
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

/// A current through one lens and the power at which it comes to rest with it, at the lens's working temperature.
struct StaticPower {
    Ampere current;
    Dioptre power;
    bool operator==(const StaticPower&) const = default;
};

/// One eye's lens: its amplifier, and its static calibration, ascending in current. Between two points powers lie on
/// the straight line; beyond them nothing is known. Empty: only 0 D is taken to be 0 A.
struct LensWiring {
    Amplifier amplifier;
    std::vector<StaticPower> powers;
    bool operator==(const LensWiring&) const = default;
};

/// In a rig file under "devices". Places are where they hang on the USB ("1-2", "1-2.3"), so that two of a kind are
/// never exchanged; empty: the only one there is.
struct RigDevices {
    std::string projectorAt;  ///< LightCrafter 4500, or where the plugin looks for its projector
    std::string lensesAt;     ///< USB-1208FS-Plus: AO0 left, AO1 right, AI0 the projector's TRIG_OUT_2, AI1 AO0's echo
    /// Of the projector. All empty: the only display of exactly the projector's raster.
    DisplayIdentity display;
    LensWiring left, right;
    Volt triggerLow = Volt::fromSi(0.8), triggerHigh = Volt::fromSi(2.0);  ///< of TRIG_OUT_2, for 3.3 V logic
    /// A vendor's projector is driven by this library (absolute path, see devices/plugin), told these options; empty:
    /// a LightCrafter 4500.
    std::string projectorPlugin{}, projectorOptions{};
    /// Any projector on `display`, to rehearse masks: all slots' light together, no lenses, nothing is blurred.
    bool rehearsal = false;
    bool operator==(const RigDevices&) const = default;
};

}  // namespace ilf
