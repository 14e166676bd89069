#include "app/scan/pose_scan.h"

#include <algorithm>
#include <utility>

#include "app/words.h"

namespace ilf::app {

PosesOutcome calibratedBy(std::vector<BoardView> views, const Board& board, const std::string& provenance) {
    PosesOutcome outcome;
    outcome.views = std::move(views);
    if (outcome.views.empty()) return outcome;
    auto found = calibrated(outcome.views, board);
    if (!found) {
        outcome.refused = found.error().what;
        return outcome;
    }
    found->calibration.provenance = provenance;
    found->calibration.taken = utcNow();
    outcome.calibrated = Box(*std::move(found));
    return outcome;
}

Result<PosesOutcome> scannedPose(const ScanOrder& order, const Board& board, std::vector<BoardView> before,
                                 const std::string& name, const devices::ScanWatch& watch,
                                 const std::stop_token& stop) {
    std::vector<BoardView> views = std::move(before);
    auto scan =
        scannedPictures(order, watch, stop, [&](devices::PatternCamera& taker, ScanOutcome& outcome) -> Result<void> {
            taker.tell(devices::ScanProgress::Step::check, 1, 3, "Looking for the board");
            auto view = boardView(outcome.captured.scan.pictures.front(), outcome.decoded, board, name);
            if (view)
                views.push_back(*std::move(view));
            else
                outcome.trouble = view.error().what;
            return {};
        });
    if (!scan) return tl::unexpected(scan.error());
    // A board is one plane, and shall be.
    std::erase_if(scan->diagnosis.findings,
                  [](const ScanFinding& finding) { return finding.fault == ScanFault::flat; });
    PosesOutcome outcome = calibratedBy(std::move(views), board, provenanceOf(order));
    outcome.trouble = scan->trouble;
    outcome.scan = *std::move(scan);
    return outcome;
}

}  // namespace ilf::app
