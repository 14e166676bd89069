// How a tunable lens follows its orders: the share of a change that is still missing decays exponentially. Simulated.
#pragma once

#include <cstdint>

#include "core/lens/waveform.h"

namespace ilf::devices {

/// Time constant of the settling. The data sheet's 25 ms to within 5 % read as first order: 25 ms / ln 20. (A lens
/// rings at about 60 Hz; the emulator does that, this ideal one does not.)
inline constexpr Second kLensTimeConstant = 8.3_ms;

/// Each harmonic c_k of the power approaches what was told, from t0 on, times in CLOCK_MONOTONIC nanoseconds:
///     c_k(t) = told_k + e missing_k,   e = exp(-(t - t0) / tau)
/// missing: what was missing at t0. A value: `told` gives the lens that follows a new wave.
class LensModel {
public:
    /// At rest, 0 D.
    LensModel() = default;

    LensModel told(const Waveform& wave, std::int64_t now_ns) const;
    const Waveform& wave() const { return wave_; }
    /// The sweeps start at this time and every 1 / rate after it.
    std::int64_t startedNs() const { return startedNs_; }

    Dioptre powerAt(std::int64_t now_ns) const;
    /// Bound of |power - told wave| from now on, whatever the phases.
    Dioptre errorAt(std::int64_t now_ns) const;
    /// When errorAt falls to `budget`.
    std::int64_t settledNs(Dioptre budget) const;
    /// The first start of a sweep at or after `now_ns`.
    std::int64_t nextSweepStartNs(std::int64_t now_ns) const;

private:
    Waveform wave_;
    Harmonics missing_;      ///< when the wave began
    Dioptre missingAtMost_;  ///< its largest value, whatever the phase
    std::int64_t startedNs_ = 0;
};

}  // namespace ilf::devices
