// A record of the sine family as selection and fitting read it: offset, amplitude and the harmonics of the power.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/lens/record.h"

namespace ilf {

/// Harmonics kept of a recorded power; on the worst emulated lens the rest is below 0.014 D (scheduling 1.2).
inline constexpr std::size_t kRecordHarmonics = 16;

struct SineRecord {
    double offset = 0.0, amplitude = 0.0;  ///< u(x) = offset + amplitude sin(2 pi x), amplitude at least 0
    Harmonics power;                       ///< same x
    double temperature_C = 30.0;           ///< when it was recorded
    double late = 0.0;  ///< x at the record's sample 0 is -late: 0 when it began at its rising middle
};

/// Refuses other families, drives of several harmonics, rates other than `rate`, fewer than 8 samples and samples that
/// are no numbers; the sentence names the record.
Result<SineRecord> sineRecord(const LensRecord& record, Hertz rate);

/// What of the records' temperatures their own drives explain, and what they do not. A coil warms with the mean square
/// of its drive, by as much again when the wave is played again: that is part of the record. The rest is the room.
struct Warmth {
    double resting_C = 30.0;               ///< of the lens with no drive, mean over the records
    double perSquare_C = 0.0;              ///< warmth for each mean square of the drive
    std::vector<double> warmerThanThat_C;  ///< the room during each record, against resting_C
};
Warmth warmth(std::span<const SineRecord> records);

/// Rates that differ by less than a millionth are one rate.
bool sameRate(Hertz a, Hertz b);

/// "60", "62.5", "0.07": a number as an operator would write it.
std::string shortly(double value);

}  // namespace ilf
