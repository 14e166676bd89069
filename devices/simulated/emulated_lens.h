// The emulator as a device: told waves at times of a clock, and watched whether it settles and does what was predicted.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "devices/simulated/lens_emulator.h"

namespace ilf::devices {

/// Which lens the simulated devices have: a preset of the emulator, or none of them, "ideal": one that takes powers
/// instead of drives and follows them by itself (LensModel).
struct SimulatedLens {
    std::optional<LensPreset> preset;

    constexpr SimulatedLens() = default;  // ideal
    constexpr SimulatedLens(LensPreset one) : preset(one) {}
    bool operator==(const SimulatedLens&) const = default;
};
inline constexpr SimulatedLens kUsualLens = LensPreset::datasheet;
std::string_view word(SimulatedLens lens);
std::optional<SimulatedLens> simulatedLensFromWord(std::string_view word);
/// What a core that simulates this lens is started with.
std::vector<std::string> coreArguments(SimulatedLens lens);

/// Times are in nanoseconds and never go back. Watched at 32 points a sweep, as a photodiode would: a sweep that is the
/// same as the one before has settled, whatever the lens; whether it also does what was predicted is another question,
/// so that a wrong calibration shows and does not pass for a slow lens.
class EmulatedLens {
public:
    /// Rests at 0 D, settled.
    EmulatedLens(LensPreset preset, std::int64_t now_ns);

    /// Why it cannot play or hold this, in one sentence.
    Result<void> playable(const Waveform& wave) const;
    /// Precondition: `wave` is playable. Its sweep starts now.
    void play(const Waveform& wave, std::int64_t now_ns);
    void advance(std::int64_t now_ns);

    Dioptre power() const { return lens_.power(); }
    double temperature_C() const { return lens_.temperature_C(); }
    /// The largest change over the last sweep from the sweep before: a bound of what the lens still settles by when
    /// transients halve in a sweep. Before two sweeps were seen, 1 D: nobody knows.
    Dioptre unsettled() const;
    /// Root of the mean square, over the last sweep, of power against the wave's prediction.
    Dioptre offWave() const;
    /// How much the lens's clock has gained since its sweeps began.
    Second ahead() const { return Second::fromSi(ahead_s_); }

    /// As in a room this warm since long.
    void setAmbient(double ambient_C);
    void setDrift(double ppm) { drift_ = ppm * 1e-6; }

private:
    void pass(std::int64_t until_ns);
    void watch();
    std::int64_t watchNs(std::int64_t index) const;

    static constexpr std::size_t kWatched = 32;  // of a sweep; shaped waves have at most 5 harmonics of note

    LensPreset preset_;
    LensEmulator lens_;
    Waveform wave_;
    std::int64_t startedNs_, nowNs_;
    double drift_ = 0.0, ahead_s_ = 0.0;
    std::int64_t nextWatch_ = 1;  ///< counted from the wave's start, kWatched to a sweep
    std::int64_t watchedFrom_ = 1;
    std::array<double, kWatched> power_{}, change_{}, error_{};
};

}  // namespace ilf::devices
