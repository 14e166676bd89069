// A tunable lens with its amplifier, as it might be: resonances, hysteresis, warmth. Simulated; never fitted to a real
// one.
#pragma once

#include <cstdint>
#include <optional>
#include <random>
#include <string_view>

#include "core/lens/record.h"

namespace ilf::devices {

/// Readings of one data sheet pair (5 ms rise, 25 ms settling), and two invented ends (scheduling 2).
enum class LensPreset : std::uint8_t { slow, datasheet, lively, clean, dirty };
inline constexpr LensPreset kLensPresets[] = {LensPreset::slow, LensPreset::datasheet, LensPreset::lively,
                                              LensPreset::clean, LensPreset::dirty};
std::string_view word(LensPreset preset);
std::optional<LensPreset> lensPresetFromWord(std::string_view word);

/// DAC (zero-order hold, quantised) -> amplifier (A/V, one pole, clipped) -> static table P(I, T) -> two resonant
/// modes, the first with stiffness depending on deflection -> Bouc-Wen loop; coil heat drifts the table. SI units.
struct LensParameters {
    double dacRate_Hz = 48000.0, dacStep_V = 0.0;  ///< a step of 0 is not quantised
    double amplifier_A_per_V = 2.4, amplifierPole_s = 80e-6, clip_A = 0.29;
    double mode_Hz = 64.0, damping = 0.30;                ///< first mode
    double stiffnessLinear = 0.0, stiffnessSquare = 0.0;  ///< b1 per dioptre, b2 per dioptre squared
    double mode2Ratio = 3.9, mode2Damping = 0.06, mode2Share = 0.05;
    double loop_D = 0.0, slip_D = 0.5;  ///< Bouc-Wen half-width and slip scale
    double coil_ohm = 12.5, warming_C_per_W = 25.0, warming_s = 180.0;
};
/// The preset's parameters; `seed` not 0 varies each of them by up to 20 %, the same way for the same seed.
LensParameters lensParameters(LensPreset preset, std::uint64_t seed = 0);

/// A value: a copy goes on by itself. Time only goes forward.
class LensEmulator {
public:
    /// At rest, no current.
    explicit LensEmulator(const LensParameters& parameters = lensParameters(LensPreset::datasheet),
                          double ambient_C = 30.0);

    /// From now on plays `drive` in volts at `rate`, x = 0 now. Beyond the clip the amplifier clips.
    void play(const Harmonics& drive, Hertz rate);
    /// Holds the lens at a power as its driver's own calibration knows how (static, temperature-compensated).
    void hold(Dioptre power);
    void setAmbient(double ambient_C);
    void advance(Second time);

    Dioptre power() const;
    double temperature_C() const;  ///< of the coil
    double current_A() const;
    DriveLimits limits() const;  ///< in volts
};

/// Plays until the wave repeats, then samples like a photodiode: `samples` of one period, averaged over `periods`, each
/// with white noise of `noise_D` before averaging. Deterministic for a seed.
struct RecordOptions {
    int samples = 250, periods = 8;
    double noise_D = 0.02;
    Second settle = 0.25_s;
    std::uint64_t seed = 1;
};
Result<LensRecord> recorded(LensEmulator& lens, const Harmonics& drive, Hertz rate, const RecordOptions& options = {});
/// The same as what calibration asks for. `lens` must outlive it; each record gets noise of its own.
RecordLens recorder(LensEmulator& lens, RecordOptions options = {});

}  // namespace ilf::devices
