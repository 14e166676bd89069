// A tape: every exchange with one device, in order, as a text file that can be read, compared and played back.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "core/base/quantity.h"
#include "core/base/result.h"

namespace ilf::devices {

// One line each:
//
//     illuminatedfocus tape 1
//     about vendor 0451
//     0.001250 out 01 : C011020005 02...
//     0.002500 in 81 : C011...
//     2.003000 in 81 failed : DLPC350 (0451:6401) at 1-2 did not answer in time ...
//
// Times are seconds since the tape began. The words before the colon say what was asked and how it went, what follows
// is the bytes as hexadecimal digits (spaces are ignored) or the failure's sentence.

/// One exchange. `what` is the kind of call ("out", "in", "control-out", ...), `where` what it was addressed to
/// (endpoint, request), without line breaks.
struct TapeEntry {
    Second at;
    std::string what, where;
    bool failed = false;
    std::vector<std::uint8_t> bytes;  ///< what was sent or what came; of a failed one to send: what was to be sent
    std::string failure;              ///< why it failed, one sentence
    int line = 0;                     ///< in the file; 0: not from a file
};

struct Tape {
    std::vector<std::pair<std::string, std::string>> about;  ///< what the device is: key (one word), value
    std::vector<TapeEntry> entries;

    /// The value of a key; empty if there is none.
    std::string of(const std::string& key) const;
};

std::string tapeText(const Tape& tape);
/// Its lines one by one, for writing while it happens: the first; one about the device; one exchange.
std::string firstTapeLine();
std::string tapeLine(const std::string& key, const std::string& value);
std::string tapeLine(const TapeEntry& entry);
/// Errors (Fault::badFile) name the line.
Result<Tape> parsedTape(const std::string& text);
Result<void> saveTape(const Tape& tape, const std::filesystem::path& file);
Result<Tape> loadTape(const std::filesystem::path& file);

/// "C0 11 02" with at most `most` bytes, for messages.
std::string hexOf(const std::vector<std::uint8_t>& bytes, std::size_t most = 1 << 20);

}  // namespace ilf::devices
