#include "devices/emulated_rig/received_sweeps.h"

#include <algorithm>
#include <utility>

namespace ilf::devices {
namespace {

constexpr std::int64_t kRemembered_ns = 400'000'000;
// A trigger may be set to come some 20 us before its light or after it (devices.md 1.3).
constexpr std::int64_t kBeside_ns = 100'000;

}  // namespace

void ReceivedSweeps::light(emulators::LightSlot slot) {
    light_.push_back(std::move(slot));
    while (light_.front().end_ns < light_.back().end_ns - kRemembered_ns)
        light_.pop_front();
}

void ReceivedSweeps::trigger(std::int64_t time_ns) {
    ++triggerCount_;
    triggers_.push_back(time_ns);
    while (triggers_.front() < time_ns - kRemembered_ns)
        triggers_.pop_front();
}

void ReceivedSweeps::sync(std::int64_t time_ns) {
    ++syncCount_;
    syncs_.push_back(time_ns);
    while (syncs_.front() < time_ns - kRemembered_ns)
        syncs_.pop_front();
}

void ReceivedSweeps::forget() {
    light_.clear();
    triggers_.clear();
    syncs_.clear();
}

std::optional<ReceivedSweep> ReceivedSweeps::newest() const {
    if (syncs_.size() < 2) return std::nullopt;
    const std::int64_t known_ns = syncs_.back();
    std::int64_t from_ns = syncs_[syncs_.size() - 2], until_ns = known_ns;
    // Triggers count while they come: the last but three syncs would have seen one.
    const auto after = std::ranges::upper_bound(triggers_, known_ns + kBeside_ns);
    const std::int64_t lately_ns = syncs_[syncs_.size() - std::min<std::size_t>(syncs_.size(), 4)];
    if (after - triggers_.begin() >= 2 && *std::prev(after) >= lately_ns - kBeside_ns) {
        until_ns = *std::prev(after);
        from_ns = *std::prev(after, 2);
    }
    ReceivedSweep sweep{from_ns, until_ns, {}};
    for (const auto& slot : light_)
        if (slot.start_ns >= from_ns - kBeside_ns && slot.start_ns < until_ns - kBeside_ns) sweep.light.push_back(slot);
    return sweep;
}

}  // namespace ilf::devices
