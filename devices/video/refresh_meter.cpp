#include "devices/video/refresh_meter.h"

#include <cmath>

namespace ilf::devices {
namespace {

constexpr std::size_t kWindow = 120;
constexpr std::size_t kFewest = 8;
constexpr double kKnown = 150e-6;
// Over more frames than this the count of frames between two swaps could be off by one.
constexpr double kLongestGap = 1000;
// Crystals are good to 100 ppm; modes named 60 Hz may be 59.8.
constexpr double kMostOffNominal = 0.02;

}  // namespace

void RefreshMeter::saw(std::chrono::nanoseconds at, std::optional<std::int64_t> count) {
    if (!waits()) return;
    const double at_s = std::chrono::duration<double>(at).count();
    if (samples_.empty()) {
        samples_.push_back({at_s, 0});
        lastCount_ = count;
        return;
    }
    const double rate = rate_ > 0.0_Hz ? rate_.si() : nominal_.si();
    const Sample& last = samples_.back();
    const double frames = (at_s - last.at_s) * rate;
    const double counted = count && lastCount_ ? static_cast<double>(*count - *lastCount_) : std::round(frames);

    if (seen_ < kFirstSwaps - 1) {
        ++seen_;
        together_ += std::abs(frames - 1.0) < 0.2 ? 1 : 0;
        // Half of them, since other programs may make a swap miss its frame.
        if (seen_ == kFirstSwaps - 1 && together_ * 2 < seen_) {
            nominal_ = rate_ = 0.0_Hz;
            return;
        }
    }
    const bool countable = count || frames < kLongestGap;
    if (counted < 1) return;
    const double frame = last.frame + counted;
    if (!countable) samples_.clear();
    samples_.push_back({at_s, frame});
    lastCount_ = count;
    if (samples_.size() > kWindow) samples_.pop_front();
    if (seen_ >= kFirstSwaps - 1) fit();
}

void RefreshMeter::fit() {
    const auto n = static_cast<double>(samples_.size());
    if (samples_.size() < kFewest) return;
    double meanFrame = 0, meanAt_s = 0;
    for (const Sample& s : samples_) {
        meanFrame += s.frame / n;
        meanAt_s += (s.at_s - samples_.front().at_s) / n;
    }
    meanAt_s += samples_.front().at_s;
    double xx = 0, xy = 0, yy = 0;
    for (const Sample& s : samples_) {
        const double x = s.frame - meanFrame, y = s.at_s - meanAt_s;
        xx += x * x;
        xy += x * y;
        yy += y * y;
    }
    const double period_s = xy / xx;
    const double scatter = std::max(0.0, yy - period_s * xy) / (n - 2);
    const bool known = std::sqrt(scatter / xx) < kKnown * period_s;
    const bool likely = std::abs(1.0 / (period_s * nominal_.si()) - 1.0) < kMostOffNominal;
    if (known && likely) rate_ = Hertz::fromSi(1.0 / period_s);
}

}  // namespace ilf::devices
