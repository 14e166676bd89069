// Camera and projector calibrated by scans of a printed chessboard, pose after pose.
#pragma once

#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "app/scan/scan.h"
#include "core/registration/calibrate.h"

namespace ilf::app {

/// What the poses make of camera and projector. One of `calibrated` and `refused` says something where there are views.
struct PosesOutcome {
    std::optional<ScanOutcome> scan;  ///< of the newest pose; none: nothing was scanned
    std::vector<BoardView> views;     ///< with the newest, where the board was found in it
    Box<Calibrated> calibrated;
    std::string refused;  ///< why there is no calibration yet: one sentence
    std::string trouble;  ///< why the newest pose is not among the views: one sentence; empty: it is
};

/// Works the calibration out of these views.
PosesOutcome calibratedBy(std::vector<BoardView> views, const Board& board, const std::string& provenance);

/// Scans the board as it is held now, in addition to `before`, and works the calibration out. Blocks and ends as
/// `scanned`. `name`: of the pose, for the operator.
Result<PosesOutcome> scannedPose(const ScanOrder& order, const Board& board, std::vector<BoardView> before,
                                 const std::string& name, const devices::ScanWatch& watch, const std::stop_token& stop);

}  // namespace ilf::app
