#include "app/window/frame_times.h"

#include <algorithm>
#include <ctime>
#include <nlohmann/json.hpp>
#include <numeric>

namespace ilf::app {
namespace {

/// An afternoon of frames is enough, and memory must not grow for ever.
constexpr std::size_t kMostFrames = 1'000'000;
constexpr auto kSwap = static_cast<std::size_t>(FrameStage::swap);

double clock_ms(clockid_t which) {
    timespec now{};
    clock_gettime(which, &now);
    return static_cast<double>(now.tv_sec) * 1e3 + static_cast<double>(now.tv_nsec) * 1e-6;
}

double sumWithoutSwap(const std::array<double, kFrameStages.size()>& ms) {
    return std::accumulate(ms.begin(), ms.end(), 0.0) - ms[kSwap];
}

template <class Value>
nlohmann::json spread(const std::vector<const FrameTime*>& frames, const Value& value) {
    std::vector<double> sorted;
    for (const FrameTime* frame : frames)
        sorted.push_back(value(*frame));
    std::sort(sorted.begin(), sorted.end());
    const auto at = [&](double share) {
        if (sorted.empty()) return 0.0;
        return sorted[static_cast<std::size_t>(share * static_cast<double>(sorted.size() - 1) + 0.5)];
    };
    return {{"p50", at(0.5)}, {"p95", at(0.95)}, {"worst", at(1.0)}};
}

nlohmann::json summary(const std::vector<const FrameTime*>& frames) {
    nlohmann::json json{{"frames", frames.size()},
                        {"own_cpu_ms", spread(frames, [](const FrameTime& f) { return f.ownCpu_ms(); })},
                        {"own_wall_ms", spread(frames, [](const FrameTime& f) { return f.ownWall_ms(); })},
                        {"swap_wall_ms", spread(frames, [](const FrameTime& f) { return f.wall_ms[kSwap]; })}};
    for (std::size_t i = 0; i < kFrameStages.size(); ++i)
        json["stages_cpu_ms"][kFrameStages[i]] = spread(frames, [i](const FrameTime& f) { return f.cpu_ms[i]; });
    return json;
}

}  // namespace

double FrameTime::ownWall_ms() const { return sumWithoutSwap(wall_ms); }
double FrameTime::ownCpu_ms() const { return sumWithoutSwap(cpu_ms); }

void FrameTimes::begin(bool waited) {
    now_ = {};
    waited_ = waited;
    wall_ms_ = clock_ms(CLOCK_MONOTONIC);
    cpu_ms_ = clock_ms(CLOCK_THREAD_CPUTIME_ID);
}

void FrameTimes::lap(FrameStage stage) {
    const double wall = clock_ms(CLOCK_MONOTONIC), cpu = clock_ms(CLOCK_THREAD_CPUTIME_ID);
    const auto i = static_cast<std::size_t>(stage);
    const bool asleep = stage == FrameStage::input && waited_;
    now_.cpu_ms[i] += cpu - cpu_ms_;
    now_.wall_ms[i] += asleep ? cpu - cpu_ms_ : wall - wall_ms_;
    wall_ms_ = wall;
    cpu_ms_ = cpu;
}

void FrameTimes::end(bool gesture) {
    now_.gesture = gesture;
    last_ = now_;
    if (keeps_ && frames_.size() < kMostFrames) frames_.push_back(now_);
}

std::string FrameTimes::json(const std::map<std::string, std::uint64_t>& counts) const {
    std::vector<const FrameTime*> all, gestures;
    for (const FrameTime& frame : frames_) {
        all.push_back(&frame);
        if (frame.gesture) gestures.push_back(&frame);
    }
    return nlohmann::json{{"gestures", summary(gestures)}, {"all", summary(all)}, {"counts", counts}}.dump(2) + "\n";
}

}  // namespace ilf::app
