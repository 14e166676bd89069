// What may go wrong with an emulated device, asked for by tests and rehearsals: one kind of value for every device.
#pragma once

#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

namespace ilf::devices::emulators {

/// What `DeviceFault::after` and `times` count is said in brackets; a device passes over what it cannot have.
enum class Mishap : std::uint8_t {
    nack,             ///< a message is refused although nothing is wrong with it [messages]
    silence,          ///< a message is neither obeyed nor answered [messages]
    stall,            ///< the endpoint stalls until its halt is cleared; a serial line loses a byte [messages]
    unplug,           ///< the cable is pulled [bytes the host has sent, from when the fault was set]
    wrongMode,        ///< the device leaves its mode by itself: the projector shows video, the lens holds DC [messages]
    underrun,         ///< the device loses what is in its FIFO [transfers]
    overTemperature,  ///< the device is `amount` degrees Celsius warmer
    droppedTrigger,   ///< a vertical sync starts nothing [triggers]
    clockDrift,       ///< the device's clock runs `amount` parts per million slow: its periods are longer
    stuckFrame,       ///< the old picture stays when a new one is due [buffer swaps]
};

/// Begins after `after` of what its kind counts and strikes `times` times from then on.
struct DeviceFault {
    Mishap kind = Mishap::nack;
    std::uint64_t after = 0;
    std::uint64_t times = std::numeric_limits<std::uint64_t>::max();
    double amount = 0.0;
    bool operator==(const DeviceFault&) const = default;
};

/// The faults a device has now, and how far each has counted.
class FaultPlan {
public:
    FaultPlan() = default;
    explicit FaultPlan(const std::vector<DeviceFault>& faults) {
        for (const DeviceFault& fault : faults)
            entries_.push_back({fault, 0});
    }

    /// Counts one event; true when a fault of this kind spoils it.
    bool strikes(Mishap kind) {
        bool struck = false;
        for (auto& [fault, seen] : entries_) {
            if (fault.kind != kind) continue;
            struck = struck || (seen >= fault.after && seen - fault.after < fault.times);
            ++seen;
        }
        return struck;
    }
    /// How many of the next `events` pass before a fault of this kind strikes (all of them where none does), counting
    /// those.
    std::uint64_t passBefore(Mishap kind, std::uint64_t events) {
        std::uint64_t passing = events;
        for (auto& [fault, seen] : entries_) {
            if (fault.kind != kind || fault.times == 0) continue;
            const std::uint64_t left = fault.after > seen ? fault.after - seen : 0;
            passing = left < passing ? left : passing;
        }
        for (auto& [fault, seen] : entries_)
            if (fault.kind == kind) seen += passing;
        return passing;
    }
    bool has(Mishap kind) const {
        for (const auto& [fault, seen] : entries_)
            if (fault.kind == kind) return true;
        return false;
    }
    /// The sum of the faults of this kind, in its unit.
    double amount(Mishap kind) const {
        double sum = 0.0;
        for (const auto& [fault, seen] : entries_)
            if (fault.kind == kind) sum += fault.amount;
        return sum;
    }

private:
    std::vector<std::pair<DeviceFault, std::uint64_t>> entries_;
};

}  // namespace ilf::devices::emulators
