// Plays a tape back to a driver, strictly: whatever differs from the tape is an error that names its line.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "devices/tape/tape.h"

namespace ilf::devices {

/// After the first difference every call gets the same error.
class TapePlayer {
public:
    explicit TapePlayer(Tape tape) : tape_(std::move(tape)) {}

    const Tape& tape() const { return tape_; }
    /// The next exchange, if it is of this kind at this address. A failure on the tape is returned as one.
    Result<std::vector<std::uint8_t>> next(const std::string& what, const std::string& where);
    /// The same for bytes towards the device, which must be those of the tape.
    Result<void> nextSent(const std::string& what, const std::string& where, std::span<const std::uint8_t> bytes);
    /// An error if some of the tape was not asked for.
    Result<void> finished() const;
    /// Why playing ended before its time, if it did.
    Result<void> soFar() const;

private:
    tl::unexpected<Error> differs(const TapeEntry* entry, const std::string& asked);
    const TapeEntry* current();

    Tape tape_;
    std::size_t at_ = 0;
    std::string difference_;
};

}  // namespace ilf::devices
