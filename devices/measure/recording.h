// What a scope, a sound card or the DAC box recorded: equally spaced volts of a trigger and of a photodiode, from a
// file.
#pragma once

#include <filesystem>
#include <vector>

#include "core/base/result.h"

namespace ilf::devices {

/// Two columns of one length. Without a trigger `trigger` is empty.
struct Recording {
    double samplesPerSecond = 0.0;
    std::vector<double> trigger, light;
    double seconds() const { return static_cast<double>(light.size()) / samplesPerSecond; }
};

/// By content: sound files (.wav, .flac: one channel is light, of two the first is the trigger; full scale is 1), else
/// text with commas, semicolons or tabs: seconds, then light, or trigger and light; lines before the first that begins
/// with a number are headings. Refused with a sentence: missing, more columns, times,
/// more than half a sample away from where an even spacing puts them, values that are not finite, fewer than 64
/// samples, more than 10^8.
Result<Recording> readRecording(const std::filesystem::path& path);

}  // namespace ilf::devices
