// What the lens does over one sweep: the power it is predicted to have, and the drive that makes it so.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "core/base/quantity.h"
#include "core/lens/harmonics.h"

namespace ilf {

/// How a wave was found (scheduling 1.3, 3.4).
enum class WaveMode : std::uint8_t {
    idealSine,   ///< no calibration: a lens that follows a sine exactly
    paper,       ///< of the recorded waves the narrowest that covers the range (paper, section 3.4)
    slotAware,   ///< of the recorded waves the one with the least error in the slots that are lit
    continuous,  ///< a model fitted to the records, inverted
    shaped,      ///< several harmonics that hold the lens at the levels, learnt on the lens
};
std::string_view word(WaveMode mode);
std::optional<WaveMode> waveModeFromWord(std::string_view word);

/// What a drive is counted in: volts at the amplifier's input, or amperes through the lens.
enum class DriveUnit : std::uint8_t { volt, ampere };
std::string_view word(DriveUnit unit);

/// Where powers come from. "measured" is said only of records of a real lens.
enum class Provenance : std::uint8_t { simulated, measured, imported };
std::string_view word(Provenance provenance);
std::optional<Provenance> provenanceFromWord(std::string_view word);

struct Waveform {
    WaveMode mode = WaveMode::idealSine;
    Dioptre rest;       ///< where the lens goes when nothing plays: the wearer's prescription offset
    Dioptre low, high;  ///< the range the plan asked for; equal: the lens stands still
    Hertz rate = 60.0_Hz;
    Harmonics power;  ///< predicted, in dioptres; x = 0 is the start of the sweep, where slot 0's light begins
    Harmonics drive;  ///< in `unit`, same x; empty: the lens takes powers and needs no drive
    DriveUnit unit = DriveUnit::volt;
    std::int64_t wave = 0;  ///< the record it was taken from (paper, slotAware, shaped); 0: none
    Provenance provenance = Provenance::simulated;
    double temperature_C = 30.0;  ///< of the lens at rest, for which `power` is predicted
    /// By how much the drive itself warms the coil in the end; `power` is that of the warm lens. Until it is warm, the
    /// lens's driver trims the drive by its own static calibration.
    double warming_C = 0.0;
    bool operator==(const Waveform&) const = default;

    bool still() const { return low == high; }
    /// Predicted.
    Dioptre powerAt(Second t) const { return Dioptre::fromSi(power.at(t * rate)); }
};

/// A lens that follows P(t) = (low + high)/2 - (high - low)/2 cos(2 pi (t - tLow) rate) exactly. `low` = `high`: still.
Waveform idealSine(Dioptre rest, Dioptre low, Dioptre high, Hertz rate, Second tLow);
/// A lens told to stand still at `power`.
Waveform stillWave(Dioptre rest, Dioptre power, Hertz rate);

}  // namespace ilf
