// A registration by a chessboard that the projector shows: one picture of it and one of its inverse.
#pragma once

#include <stop_token>

#include "app/scan/scan.h"
#include "core/registration/point_pairs.h"

namespace ilf::app {

/// Blocks for some seconds; ends in steady white light, as a scan does, and under the same conditions.
Result<PairedRegistration> scannedBoard(const ScanOrder& order, const devices::ScanWatch& watch,
                                        const std::stop_token& stop);

}  // namespace ilf::app
