#include "devices/simulated/lens_model.h"

#include <algorithm>
#include <cmath>

namespace ilf::devices {
namespace {

double seconds(std::int64_t ns) { return static_cast<double>(ns) * 1e-9; }

/// Share of a change that is still missing after `age`.
double decay(double age_s) { return std::exp(-std::max(0.0, age_s) / kLensTimeConstant.si()); }

Harmonics sum(Harmonics a, const Harmonics& b, double factor) {
    a.c.resize(std::max(a.c.size(), b.c.size()));
    for (std::size_t k = 0; k < b.c.size(); ++k)
        a.c[k] += factor * b.c[k];
    return a;
}

}  // namespace

LensModel LensModel::told(const Waveform& wave, std::int64_t now_ns) const {
    LensModel next;
    next.wave_ = wave;
    next.startedNs_ = now_ns;
    const Harmonics now = sum(wave_.power, missing_, decay(seconds(now_ns - startedNs_)));
    next.missing_ = sum(now, wave.power, -1.0);
    for (const auto& c : next.missing_.c)
        next.missingAtMost_ += Dioptre::fromSi(std::abs(c));
    return next;
}

Dioptre LensModel::powerAt(std::int64_t now_ns) const {
    const double t = seconds(now_ns - startedNs_);
    const double x = t * wave_.rate.si();
    return Dioptre::fromSi(wave_.power.at(x) + decay(t) * missing_.at(x));
}

Dioptre LensModel::errorAt(std::int64_t now_ns) const { return missingAtMost_ * decay(seconds(now_ns - startedNs_)); }

std::int64_t LensModel::settledNs(Dioptre budget) const {
    if (missingAtMost_ <= budget) return startedNs_;
    const double wait_s = kLensTimeConstant.si() * std::log(missingAtMost_ / budget);
    return startedNs_ + static_cast<std::int64_t>(std::ceil(wait_s * 1e9));
}

std::int64_t LensModel::nextSweepStartNs(std::int64_t now_ns) const {
    if (now_ns <= startedNs_) return startedNs_;
    const double period_ns = 1e9 / wave_.rate.si();
    const double sweeps = std::ceil(static_cast<double>(now_ns - startedNs_) / period_ns);
    return startedNs_ + static_cast<std::int64_t>(std::llround(sweeps * period_ns));
}

}  // namespace ilf::devices
