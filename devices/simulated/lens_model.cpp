#include "devices/simulated/lens_model.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace ilf::devices {
namespace {

Dioptre mean(const Waveform& w) { return 0.5 * (w.low + w.high); }
Dioptre amplitude(const Waveform& w) { return 0.5 * (w.high - w.low); }

double seconds(std::int64_t ns) { return static_cast<double>(ns) * 1e-9; }

/// Share of a change that is still missing after `age`.
double decay(double age_s) { return std::exp(-std::max(0.0, age_s) / kLensTimeConstant.si()); }

double phase(const Waveform& w, double t_s) { return 2.0 * std::numbers::pi * (t_s - w.tLow.si()) * w.rate.si(); }

}  // namespace

LensModel LensModel::told(const Waveform& wave, std::int64_t now_ns) const {
    const double left = decay(seconds(now_ns - startedNs_));
    LensModel next;
    next.wave_ = wave;
    next.startedNs_ = now_ns;
    next.missingMean_ = mean(wave_) + left * missingMean_ - mean(wave);
    const Dioptre amplitudeNow = amplitude(wave_) + left * missingAmplitude_;
    next.missingAmplitude_ = amplitudeNow - amplitude(wave);
    // The new wave starts at a phase of its own: the old one has to die out while the new one grows.
    next.missing_ = abs(next.missingMean_) + amplitudeNow + amplitude(wave);
    return next;
}

Dioptre LensModel::powerAt(std::int64_t now_ns) const {
    const double t = seconds(now_ns - startedNs_);
    const double left = decay(t);
    return mean(wave_) + left * missingMean_ -
           (amplitude(wave_) + left * missingAmplitude_) * std::cos(phase(wave_, t));
}

Dioptre LensModel::errorAt(std::int64_t now_ns) const { return missing_ * decay(seconds(now_ns - startedNs_)); }

std::int64_t LensModel::settledNs(Dioptre budget) const {
    if (missing_ <= budget) return startedNs_;
    const double wait_s = kLensTimeConstant.si() * std::log(missing_ / budget);
    return startedNs_ + static_cast<std::int64_t>(std::ceil(wait_s * 1e9));
}

std::int64_t LensModel::nextSweepStartNs(std::int64_t now_ns) const {
    if (now_ns <= startedNs_) return startedNs_;
    const double period_ns = 1e9 / wave_.rate.si();
    const double sweeps = std::ceil(static_cast<double>(now_ns - startedNs_) / period_ns);
    return startedNs_ + static_cast<std::int64_t>(std::llround(sweeps * period_ns));
}

}  // namespace ilf::devices
