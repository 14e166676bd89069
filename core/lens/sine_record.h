// A record of the sine family as selection and fitting read it: offset, amplitude and the harmonics of the power.
#pragma once

#include "core/lens/record.h"

namespace ilf {

/// Harmonics kept of a recorded power; on the worst emulated lens the rest is below 0.014 D (scheduling 1.2).
inline constexpr std::size_t kRecordHarmonics = 16;

struct SineRecord {
    double offset = 0.0, amplitude = 0.0;  ///< u(x) = offset + amplitude sin(2 pi x), amplitude at least 0
    Harmonics power;                       ///< same x
    double late = 0.0;  ///< x at the record's sample 0 is -late: 0 when it began at its rising middle
};

/// Refuses other families, drives of several harmonics, rates other than `rate`, fewer than 8 samples and samples that
/// are no numbers; the sentence names the record.
Result<SineRecord> sineRecord(const LensRecord& record, Hertz rate);

/// Rates that differ by less than a millionth are one rate.
bool sameRate(Hertz a, Hertz b);

/// "60", "62.5", "0.07": a number as an operator would write it.
std::string shortly(double value);

}  // namespace ilf
