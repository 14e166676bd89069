// Notes exchanges on a tape while they happen.
#pragma once

#include <mutex>
#include <span>
#include <string>

#include "devices/clock.h"
#include "devices/tape/tape.h"

namespace ilf::devices {

/// Shared by whoever speaks to one device; calls may come from any thread. A full recorder (64 MB) notes no more.
class TapeRecorder {
public:
    explicit TapeRecorder(Clock clock) : clock_(std::move(clock)), begun_(clock_.now()) {}

    void about(const std::string& key, const std::string& value);
    void succeeded(const std::string& what, const std::string& where, std::span<const std::uint8_t> bytes);
    void failed(const std::string& what, const std::string& where, std::span<const std::uint8_t> bytes,
                const Error& why);

    /// What was noted so far.
    Tape tape() const;
    /// Something could not be noted any more.
    bool full() const;

private:
    void note(TapeEntry entry);

    Clock clock_;
    std::chrono::nanoseconds begun_;
    mutable std::mutex mutex_;
    Tape tape_;
    std::size_t bytes_ = 0;
    bool full_ = false;
};

}  // namespace ilf::devices
