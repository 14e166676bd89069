#include "devices/emulated_rig/sampled_lens.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace ilf::devices {
namespace {

constexpr double kRoom_C = 30.0;  // where the presets' table is at home
constexpr std::int64_t kRemembered_ns = 500'000'000, kNotedEvery_ns = 500'000;

}  // namespace

SampledLens::SampledLens(LensPreset preset, std::int64_t now_ns)
    : lens_(lensParameters(preset), kRoom_C), now_ns_(now_ns) {
    lens_.drive({});
    lens_.advance(0.5_s);
    note();
}

void SampledLens::drive(std::int64_t time_ns, Ampere current) {
    advance(time_ns);
    told_ = current;
    lens_.drive(current);
    note();
}

void SampledLens::advance(std::int64_t time_ns) {
    if (time_ns <= now_ns_) return;
    // Noted at least every half millisecond, as far back as anything is remembered.
    for (std::int64_t next_ns = std::max(now_ns_, time_ns - kRemembered_ns); now_ns_ < time_ns;) {
        if (next_ns == now_ns_) next_ns = std::min(now_ns_ + kNotedEvery_ns, time_ns);
        lens_.advance(Second::fromSi(1e-9 * static_cast<double>(next_ns - now_ns_)));
        now_ns_ = next_ns;
        note();
    }
}

void SampledLens::warmer(double by_C) {
    lens_.setAmbient(kRoom_C + by_C);
    lens_.warmUp();
}

void SampledLens::note() {
    if (!past_.empty() && past_.back().time_ns == now_ns_) past_.pop_back();
    past_.push_back({now_ns_, lens_.power().si(), told_.si()});
    while (past_.front().time_ns < now_ns_ - kRemembered_ns)
        past_.pop_front();
}

std::vector<Dioptre> SampledLens::powers(std::int64_t from_ns, std::int64_t until_ns, std::size_t count) const {
    std::vector<Dioptre> made;
    made.reserve(count);
    const double step_ns =
        static_cast<double>(until_ns - from_ns) / static_cast<double>(std::max<std::size_t>(count, 1));
    for (std::size_t i = 0; i < count; ++i) {
        const double time_ns = static_cast<double>(from_ns) + step_ns * static_cast<double>(i);
        const auto later = std::ranges::lower_bound(past_, static_cast<std::int64_t>(time_ns), {}, &Point::time_ns);
        if (later == past_.begin() || later == past_.end()) {
            made.push_back(Dioptre::fromSi(later == past_.end() ? past_.back().power_D : past_.front().power_D));
            continue;
        }
        const Point &a = *std::prev(later), &b = *later;
        const double share = (time_ns - static_cast<double>(a.time_ns)) / static_cast<double>(b.time_ns - a.time_ns);
        made.push_back(Dioptre::fromSi(std::lerp(a.power_D, b.power_D, std::clamp(share, 0.0, 1.0))));
    }
    return made;
}

Ampere SampledLens::most(std::int64_t from_ns, std::int64_t until_ns) const {
    // What was told before holds until the next sample.
    auto point = std::ranges::upper_bound(past_, from_ns, {}, &Point::time_ns);
    if (point != past_.begin()) --point;
    double most = 0.0;
    for (; point != past_.end() && point->time_ns < until_ns; ++point)
        most = std::max(most, std::abs(point->current_A));
    return Ampere::fromSi(most);
}

}  // namespace ilf::devices
