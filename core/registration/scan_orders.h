// Inside the diagnosis: which patterns a scan's pictures really show.
#pragma once

#include <optional>
#include <string>

#include "core/registration/gray_code.h"

namespace ilf {

/// How much of what is lit was decoded to places that follow each other as those of a projector's picture do: near 1
/// for a good scan, near 0 where bits were mixed up, however smooth their code is from pixel to pixel.
double readableShare(const DecodedScan& decoded);

/// Another reading of a scan's pictures under which they decode.
struct OtherReading {
    int lag = 0;         ///< pictures show what was to be shown this many patterns before
    std::string order;   ///< or they are in this order, in words
    double share = 0.0;  ///< readableShare() of a thinned scan
};

/// Tries lags of 1 to 3 patterns, white and black at the other end, rows before columns, inverses first and the least
/// significant bit first, on a thinned scan. Nothing where no reading decodes clearly more than the scan's own.
std::optional<OtherReading> otherReading(const Scan& scan);

}  // namespace ilf
