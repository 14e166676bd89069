// Notes exchanges on a tape while they happen.
#pragma once

#include <filesystem>
#include <fstream>
#include <memory>
#include <mutex>
#include <span>
#include <string>

#include "devices/clock.h"
#include "devices/tape/tape.h"

namespace ilf::devices {

/// Shared by whoever speaks to one device; calls may come from any thread.
class TapeRecorder {
public:
    /// Kept in memory; a full one (64 MB) notes no more.
    explicit TapeRecorder(Clock clock) : clock_(std::move(clock)), begun_(clock_.now()) {}
    /// Written into a new file line by line and not kept: there is what a process had exchanged until it was killed.
    /// One that cannot be written any more notes no more.
    static Result<std::shared_ptr<TapeRecorder>> into(const std::filesystem::path& file, Clock clock);

    /// What is noted of a key first stays.
    void about(const std::string& key, const std::string& value);
    void succeeded(const std::string& what, const std::string& where, std::span<const std::uint8_t> bytes);
    void failed(const std::string& what, const std::string& where, std::span<const std::uint8_t> bytes,
                const Error& why);

    /// What was noted so far and is kept.
    Tape tape() const;
    /// Something could not be noted any more.
    bool full() const;

private:
    void note(TapeEntry entry);
    void write(const std::string& line);

    Clock clock_;
    std::chrono::nanoseconds begun_;
    mutable std::mutex mutex_;
    Tape tape_;
    std::size_t bytes_ = 0;
    bool full_ = false;
    std::ofstream file_;  ///< open: everything goes there
};

}  // namespace ilf::devices
