#include "devices/usb1208/phase_lock.h"

#include <algorithm>
#include <cmath>

#include "devices/usb1208/messages.h"

namespace ilf::devices {
namespace {

// Fitted before anything is done: 0.4 s at 60 Hz, which tells 1000 ppm from 100.
constexpr std::size_t kFirst = 24;
constexpr double kMostPpm = 200.0;
// What jitter of +-1 sample can make of the fitted drift, in samples a sweep.
constexpr double kFitNoise = 0.1;
// An edge further than this from where one can be is a stray: noise, or a cable touched.
constexpr double kStray = 0.03;
constexpr double kLostSweeps = 6.0;
// Filter gains: jitter is taken down to a seventh; a change of drift is learnt in about a second.
constexpr double kAlpha = 0.1, kBeta = 0.005;
constexpr double kSlipAt = 0.6, kTurnAt = 1.0;
constexpr double kSweepsBetweenSlips = 4.0;
// Aligning is a cross-fade, so it is asked for only where slipping would take long.
constexpr double kAlignAt = 2.5;
constexpr double kLockedWithin = 2.0;
constexpr int kLockedAfter = 24;
constexpr double kReportedSeconds = 2.0;

std::string fixed(double value, int digits) {
    const auto text = std::to_string(value);
    return text.substr(0, text.find('.') + 1 + static_cast<std::size_t>(digits));
}

}  // namespace

double PhaseLock::wrapped(double samples) const {
    const double sweep = setup_.samplesPerSweep;
    return samples - sweep * std::round(samples / sweep);
}

tl::unexpected<Error> PhaseLock::tooFar(double perSweep) const {
    const double sweep = setup_.samplesPerSweep;
    const double ours = usb1208::kSampleRateHz / sweep, its = usb1208::kSampleRateHz / (sweep + perSweep);
    return fail(Fault::unsupported, "The projector shows " + fixed(its, 3) +
                                        " pictures a second and the lenses sweep at " + fixed(ours, 3) +
                                        " Hz: that is too far apart to be kept in step by slipping "
                                        "samples. Set the projector's display to exactly " +
                                        fixed(ours, 2) + " Hz (not 59.94).");
}

Result<PhaseAdvice> PhaseLock::edge(double sample, double offset, std::int64_t moved) {
    const double sweep = setup_.samplesPerSweep;
    double sweeps = 0.0;
    if (last_) {
        const double periods = (sample - *last_) / sweep;
        sweeps = std::round(periods);
        if (sweeps < 1.0 || std::abs(periods - sweeps) > kStray * std::max(1.0, sweeps)) {
            ++counts_.strays;
            // If most are strays, the first one was: begin again.
            if (!following_ && counts_.strays > static_cast<std::int64_t>(first_.size())) {
                first_.clear();
                last_.reset();
                since_ = sample;
                counts_.strays = 0;
            }
            return PhaseAdvice{};
        }
        counts_.missing += static_cast<std::int64_t>(sweeps) - 1;
    }
    last_ = sample;
    ++counts_.edges;
    const double error = wrapped(offset - setup_.target);
    const double phase = error + static_cast<double>(moved);
    if (following_) return followed(sweeps, phase, error);
    if (first_.empty()) told_ = moved;
    const double before = first_.empty() ? phase : first_.back().phase;
    first_.push_back({sample, before + wrapped(phase - before)});
    if (first_.size() < kFirst) return PhaseAdvice{};
    return acquired();
}

/// Fits a line through the first edges and says how far the sweep is to be aligned.
Result<PhaseAdvice> PhaseLock::acquired() {
    double meanSample = 0.0, meanPhase = 0.0;
    const double count = static_cast<double>(first_.size());
    for (const auto& one : first_) {
        meanSample += one.sample / count;
        meanPhase += one.phase / count;
    }
    double above = 0.0, below = 0.0;
    for (const auto& one : first_) {
        above += (one.sample - meanSample) * (one.phase - meanPhase);
        below += (one.sample - meanSample) * (one.sample - meanSample);
    }
    const double sweep = setup_.samplesPerSweep;
    perSweep_ = above / below * sweep;
    if (std::abs(perSweep_) > kMostPpm * 1e-6 * sweep + kFitNoise) return tooFar(perSweep_);
    phase_ = meanPhase + perSweep_ / sweep * (first_.back().sample - meanSample);
    following_ = true;
    first_.clear();
    const double off = wrapped(phase_ - static_cast<double>(told_));
    phase_ = static_cast<double>(told_) + off;
    if (std::abs(off) <= kAlignAt) return PhaseAdvice{};
    const int samples = static_cast<int>(std::lround(off));
    told_ += samples;
    return PhaseAdvice{PhaseAdvice::Kind::align, samples};
}

Result<PhaseAdvice> PhaseLock::followed(double sweeps, double phase, double error) {
    const double predicted = phase_ + perSweep_ * sweeps;
    const double news = wrapped(phase - predicted);
    phase_ = predicted + kAlpha * news;
    perSweep_ += kBeta * news / sweeps;
    if (std::abs(perSweep_) > 1.5 * kMostPpm * 1e-6 * setup_.samplesPerSweep) return tooFar(perSweep_);

    const auto kept =
        static_cast<std::size_t>(std::max(1.0, kReportedSeconds * usb1208::kSampleRateHz / setup_.samplesPerSweep));
    if (errors_.size() < kept) {
        errors_.push_back(error);
    } else {
        errors_[oldest_] = error;
        oldest_ = (oldest_ + 1) % kept;
    }
    settled_ = std::abs(error) <= kLockedWithin ? settled_ + 1 : 0;
    if (settled_ >= kLockedAfter) locked_ = true;
    if (std::abs(phase_ - static_cast<double>(told_)) > 2.0 * kAlignAt) locked_ = false;

    sweepsSinceSlip_ += sweeps;
    if (sweepsSinceSlip_ < kSweepsBetweenSlips) return PhaseAdvice{};
    const double ahead = phase_ + perSweep_ * setup_.latencySweeps - static_cast<double>(told_);
    const int way = ahead > 0.0 ? 1 : -1;
    if (std::abs(ahead) < (way == -lastSlip_ ? kTurnAt : kSlipAt)) return PhaseAdvice{};
    told_ += way;
    lastSlip_ = way;
    sweepsSinceSlip_ = 0.0;
    ++counts_.slips;
    return PhaseAdvice{PhaseAdvice::Kind::slip, way};
}

Result<void> PhaseLock::heard(double sample) {
    if (!since_) since_ = sample;
    const double sweeps = (sample - last_.value_or(*since_)) / setup_.samplesPerSweep;
    // The first one may take as long as finding out that none comes.
    if (sweeps <= (last_ ? kLostSweeps : 4.0 * kLostSweeps)) return {};
    return fail(Fault::device,
                last_ ? "The projector's trigger is lost: none came for " +
                            fixed(sweeps * setup_.samplesPerSweep / usb1208::kSampleRateHz * 1e3, 0) +
                            " ms. Check the cable from TRIG_OUT_2 to the DAC's first input."
                      : "No trigger comes from the projector. Check the cable from TRIG_OUT_2 to the DAC's "
                        "first input, and that the projector is in pattern mode.");
}

PhaseReport PhaseLock::report() const {
    PhaseReport report = counts_;
    report.locked = locked_;
    report.driftPpm = perSweep_ / setup_.samplesPerSweep * 1e6;
    double sum = 0.0, squares = 0.0, most = 0.0;
    for (const double error : errors_) {
        sum += error;
        squares += error * error;
        most = std::max(most, std::abs(error));
    }
    const Second sample = Second::fromSi(1.0 / usb1208::kSampleRateHz);
    if (!errors_.empty()) {
        const double count = static_cast<double>(errors_.size()), mean = sum / count;
        report.rms = std::sqrt(squares / count) * sample;
        report.jitter = std::sqrt(std::max(0.0, squares / count - mean * mean)) * sample;
    }
    report.most = most * sample;
    return report;
}

}  // namespace ilf::devices
