// The machine a project plays on: projector raster, rates, delays, lens limits and where its light lands.
#pragma once

#include <array>
#include <cmath>
#include <optional>
#include <string>

#include "core/base/geometry.h"
#include "core/base/quantity.h"
#include "core/document/rig_devices.h"
#include "core/lens/waveform.h"
#include "core/registration/pinhole.h"
#include "core/registration/registration.h"

namespace ilf {

enum class ProjectorKind {
    highSpeed,         ///< 1000 frames/s class, 8 bits; triggered from outside or at a multiple of the sweep rate
    lightCrafter4500,  ///< video patterns: 24 bit planes a frame, one frame a sweep
};

/// The room's light, for what the plan says of brightness, flicker and what ambient light gives away.
struct RoomLight {
    double projector_lm = 330.0;  ///< of the projector in steady light
    double litArea_m2 = 0.5;      ///< it falls on
    double ambient_lx = 0.0;      ///< on the same area, from elsewhere
    bool operator==(const RoomLight&) const = default;
};

/// A rig is a file of its own: one room is the same for every project.
struct Rig {
    std::string name = "Simulated rig";
    Size projector{1024, 768};
    Hertz sweepRate = 60.0_Hz;
    Hertz slotRate = 960.0_Hz;        ///< an integer multiple of the sweep rate, or light would flicker below it
    Second projectorDelay = 0.46_ms;  ///< trigger to light (paper, section 4); of this projector in this mode
    ProjectorKind kind = ProjectorKind::highSpeed;
    int bits = 8;               ///< of one slot's picture
    Hertz fastest = 1000.0_Hz;  ///< pictures of that many bits; highSpeed only
    WaveMode waves = WaveMode::continuous;
    std::string lens;  ///< calibration file; empty: the connected lens's own
    /// Slots serve a level while their rms power error stays below this; for blur, if larger, this share of its power
    /// above rest.
    Dioptre powerBudget = 0.1_D;
    double blurShare = 0.1;
    RoomLight room;
    /// Dominant wavelengths of its red, green and blue light; absent: not known, and the view keeps colours together.
    std::optional<std::array<Metre, 3>> primaries;
    Dioptre lensMin = -10.0_D;
    Dioptre lensMax = 10.0_D;
    /// Where a camera pixel lands on the projector's raster; absent: the picture fitted into the raster.
    Box<Registration> registration;
    Box<ProcamCalibration> calibration;    ///< camera and projector as pinholes; empty: not known
    std::optional<RigDevices> devices;     ///< absent: simulated ones
    std::string provenance = "simulated";  ///< simulated, measured: never measured unless it was
    bool operator==(const Rig&) const = default;
};

/// Slots of one sweep: slotRate / sweepRate, rounded.
inline int slotsPerSweep(const Rig& rig) { return static_cast<int>(std::lround(rig.slotRate / rig.sweepRate)); }

}  // namespace ilf
