// The light an emulated projector gave, cut into sweeps at its triggers.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "devices/emulators/bit_planes.h"

namespace ilf::devices {

/// From its trigger to the next. In plain video, which triggers nothing, from one vertical sync to the next.
struct ReceivedSweep {
    std::int64_t trigger_ns = 0, end_ns = 0;
    std::vector<emulators::LightSlot> light;
    bool operator==(const ReceivedSweep&) const = default;
};

/// Remembers the last tenths of a second. Times are in nanoseconds and never go back; light is told when it has ended.
class ReceivedSweeps {
public:
    void light(emulators::LightSlot slot);
    void trigger(std::int64_t time_ns);
    /// All light that ended by this vertical sync, and all triggers by it, have been told.
    void sync(std::int64_t time_ns);
    /// There is no video any more: what was received says nothing about what comes.
    void forget();

    /// The newest that is whole; none before the second trigger or sync.
    std::optional<ReceivedSweep> newest() const;
    std::uint64_t syncs() const { return syncCount_; }
    std::uint64_t triggers() const { return triggerCount_; }

private:
    std::deque<emulators::LightSlot> light_;
    std::deque<std::int64_t> triggers_, syncs_;
    std::uint64_t syncCount_ = 0, triggerCount_ = 0;
};

}  // namespace ilf::devices
