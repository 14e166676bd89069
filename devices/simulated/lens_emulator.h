// A tunable lens with its amplifier, as it might be: resonances, hysteresis, warmth. Simulated; never fitted to a real
// one.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "core/lens/record.h"

namespace ilf::devices {

/// Readings of one data sheet pair (5 ms rise, 25 ms settling), and two invented ends (scheduling 2).
enum class LensPreset : std::uint8_t { slow, datasheet, lively, clean, dirty };
inline constexpr LensPreset kLensPresets[] = {LensPreset::slow, LensPreset::datasheet, LensPreset::lively,
                                              LensPreset::clean, LensPreset::dirty};
std::string_view word(LensPreset preset);
std::optional<LensPreset> lensPresetFromWord(std::string_view word);

/// DAC (zero-order hold, quantised) -> amplifier (A/V, clipped, one pole) -> static table P(I, T) -> two resonant
/// modes, the first with stiffness 1 + b1 x + b2 x^2 -> Bouc-Wen loop; coil heat drifts the table. SI units. The table
/// is what the lens shows at rest, so stiffness bends the way to it and not where it leads.
struct LensParameters {
    double dacRate_Hz = 48000.0, dacStep_V = 0.0;  ///< a step of 0 is not quantised
    double amplifier_A_per_V = 2.4, amplifierPole_s = 80e-6, clip_A = 0.29;
    double mode_Hz = 64.0, damping = 0.30;                ///< first mode
    double stiffnessLinear = 0.0, stiffnessSquare = 0.0;  ///< b1 per dioptre, b2 per dioptre squared
    double mode2Ratio = 3.9, mode2Damping = 0.06, mode2Share = 0.05;
    double loop_D = 0.0, slip_D = 0.5;  ///< Bouc-Wen half-width and slip scale
    double coil_ohm = 12.5, warming_C_per_W = 25.0, warming_s = 180.0;
    double step_s = 25e-6;  ///< of the integration, at most
    bool operator==(const LensParameters&) const = default;
};
/// The preset's parameters. `seed` not 0 varies each of them by up to 20 %, the same way for the same seed; the DAC,
/// the clip and the integration step are the driver's and stay. `dirty` has the 1 kHz DAC; set dacRate_Hz for another.
LensParameters lensParameters(LensPreset preset, std::uint64_t seed = 0);

/// A value: a copy goes on by itself. Time only goes forward. Whatever it is given it stays finite: parameters are
/// brought into what a lens could be, a drive that is not finite counts as none.
class LensEmulator {
public:
    /// At rest, no current.
    explicit LensEmulator(const LensParameters& parameters = lensParameters(LensPreset::datasheet),
                          double ambient_C = 30.0);

    /// From now on plays `drive` in volts at `rate`, x = 0 now. Beyond the clip the amplifier clips. With `asAt_C` the
    /// driver trims mean and swing of the drive as its own static calibration knows how, so that the power is that of a
    /// coil this warm; without, the drive is played as it is.
    void play(const Harmonics& drive, Hertz rate, std::optional<double> asAt_C = {});
    /// Holds the lens at a power as its driver's own calibration knows how (static, temperature-compensated). A lens
    /// with a loop is led there in a swing that dies out within 0.1 s, so that it forgets where it came from.
    void hold(Dioptre power);
    /// From now on the amplifier is told this current; as it is told sample by sample by a DAC that is not part of this
    /// model. Beyond the clip it clips; not finite is none.
    void drive(Ampere current);
    void setAmbient(double ambient_C);
    /// Longer than a second: the lens plays the last half second, and only its warmth knows of the rest.
    void advance(Second time);
    /// As warm at once as what it plays will make it in the end.
    void warmUp();

    Dioptre power() const;
    double temperature_C() const { return coil_C_; }
    double current_A() const { return current_A_; }
    /// In volts: the clip, and the rms of a sine up to it.
    DriveLimits limits() const;

private:
    /// What one step of a given length needs; the usual length is worked out once.
    struct Step {
        double length = 0.0, pole = 0.0, halfPole = 0.0;
    };
    struct Mode {
        double square = 0.0, drag = 0.0;  ///< omega^2, 2 zeta omega
        double x = 0.0, v = 0.0;
    };

    Step stepOf(double length) const;
    void step(const Step& step);
    void nextVoltage();
    double trimmed(double volt);
    double driveAt(double x) const;
    double tablePower(double current_A) const;
    double currentFor(double power) const;
    double meanSquareCurrent() const;
    void skip(double time);
    void advanceDriven(double time);
    bool still() const;

    LensParameters p_;
    Step usual_;
    Mode first_, second_;
    Harmonics drive_;
    double rate_Hz_ = 0.0;
    std::optional<double> held_D_;
    std::optional<double> driven_A_;  ///< told from outside
    std::optional<double> asAt_C_;    ///< trimmed for a coil this warm
    double trim_V_ = 0.0, swing_ = 1.0,
           trimmedFor_C_ = 0.0;                     ///< the last: the coil temperature they were worked out for
    double heldCurrent_A_ = 0.0, heldFor_C_ = 0.0;  ///< the coil temperature the current was worked out for
    double ambient_C_, coil_C_;
    double target_A_ = 0.0, current_A_ = 0.0;
    double table_D_ = 0.0;   ///< static power at the current
    double loop_ = 0.0;      ///< Bouc-Wen state, -1..1
    std::int64_t tick_ = 0;  ///< DAC values since play or hold
    double inTick_s_ = 0.0;  ///< time since the last of them
    double owed_s_ = 0.0;    ///< rest of a call too short for a step
};

/// Why a lens with these limits must not be driven so, in one sentence.
Result<void> playable(const Harmonics& drive, Hertz rate, const DriveLimits& limits);

/// Plays until the wave repeats, warm as it gets in the end, then samples like a photodiode: `samples` of one period,
/// averaged over `periods`, each with white noise of `noise_D` before averaging. Deterministic for a seed.
struct RecordOptions {
    int samples = 250, periods = 8;
    double noise_D = 0.02;
    Second settle = 0.25_s;
    std::uint64_t seed = 1;
};
/// Refuses drives beyond the limits, and what is no wave.
Result<LensRecord> recorded(LensEmulator& lens, const Harmonics& drive, Hertz rate, const RecordOptions& options = {});
/// The same as what calibration asks for. `lens` must outlive it; each record gets noise of its own.
RecordLens recorder(LensEmulator& lens, RecordOptions options = {});

}  // namespace ilf::devices
