#include "app/scan/scan.h"

#include <cmath>
#include <utility>

#include "app/words.h"
#include "core/base/as_text.h"
#include "devices/emulated_scene/emulated_camera.h"
#include "devices/scan/core_show.h"
#include "projects/scan_folder.h"

namespace ilf::app {
namespace {

using devices::ScanProgress;

Result<MapCheck> checkedOn(devices::PatternCamera& taker, const DenseMap& map, Pattern::Kind kind, Size projector) {
    const Pattern pattern = checkPattern(kind, projector);
    const auto pair = taker.pair(pattern);
    if (!pair) return tl::unexpected(pair.error());
    return mapCheck(map, pattern, pair->picture, pair->inverse);
}

std::string failedCheck(const MapCheck& columns, const MapCheck& rows) {
    if (columns.holds() && rows.holds()) return {};
    return "The map was made but does not hold: stripes shown anew are off by " +
           asText("%.1f", std::hypot(columns.rms_px, rows.rms_px)) + " pixels of the projector, and " +
           asText("%.0f %%", 100.0 * std::max(columns.beyond, rows.beyond)) +
           " of their edges by more than 4. Something moved since they were scanned: scan again.";
}

Registration registrationOf(const ScanOrder& order, const ScanOutcome& outcome, DenseMap map) {
    Registration found;
    found.map = PixelMap(Box(std::move(map)));
    found.camera = outcome.captured.mode;
    found.projector = order.rig.projector;
    found.method = Registration::Method::scan;
    found.rms_px = std::hypot(outcome.columns->rms_px, outcome.rows->rms_px);
    found.worst_px = std::max(outcome.columns->worst_px, outcome.rows->worst_px);
    found.points = outcome.decoded.count[static_cast<std::size_t>(PixelState::decoded)];
    found.taken = utcNow();
    found.projectorName = order.rig.name;
    found.provenance = provenanceOf(order);
    return found;
}

/// Of saved pictures one may say the order, or wait longer when taking them; a live scan has done both.
void ofLivePictures(ScanDiagnosis& diagnosis) {
    for (ScanFinding& finding : diagnosis.findings) {
        if (finding.fault == ScanFault::otherOrder || finding.fault == ScanFault::previousFrame)
            finding.what =
                "The camera gives previous frames, now and then: pictures show other patterns than those that "
                "were shown. Use a camera without a queue, or a machine that has less to do.";
    }
}

/// Decodes and diagnoses.
Result<void> evaluate(const ScanOrder& order, const devices::PatternCamera& taker,
                      const devices::CapturedScan& captured, ScanOutcome& outcome) {
    outcome.captured = captured;
    if (!order.keep.empty()) {
        if (const auto kept = projects::writeScan(order.keep, captured.scan); !kept) return kept;
    }
    taker.tell(ScanProgress::Step::check, 0, 3, "Decoding");
    auto decoded = decodedScan(captured.scan);
    if (!decoded) return tl::unexpected(decoded.error());
    outcome.decoded = *std::move(decoded);
    outcome.diagnosis = scanDiagnosis(captured.scan, outcome.decoded);
    ofLivePictures(outcome.diagnosis);
    if (!outcome.diagnosis.usable()) outcome.trouble = outcome.diagnosis.findings.front().what;
    return {};
}

void measureDepth(const ScanOrder& order, const DenseMap& map, ScanOutcome& outcome) {
    if (!order.rig.calibration) return;
    auto depth = triangulated(map, *order.rig.calibration);
    if (!depth) {
        outcome.noDepth = depth.error().what;
        return;
    }
    outcome.depth = *std::move(depth);
    outcome.depth->depth.source = "scan by " + outcome.captured.mode.device;
}

/// Makes the map and checks it while patterns can still be shown.
Result<void> mapAndCheck(const ScanOrder& order, devices::PatternCamera& taker, ScanOutcome& outcome) {
    auto map = denseMap(outcome.decoded);
    if (!map) {
        outcome.trouble = map.error().what;
        return {};
    }
    taker.tell(ScanProgress::Step::check, 1, 3, "Checking the map on other stripes");
    const auto columns = checkedOn(taker, *map, Pattern::Kind::column, order.rig.projector);
    if (!columns) return tl::unexpected(columns.error());
    const auto rows = checkedOn(taker, *map, Pattern::Kind::row, order.rig.projector);
    if (!rows) return tl::unexpected(rows.error());
    outcome.columns = *columns;
    outcome.rows = *rows;
    outcome.trouble = failedCheck(*columns, *rows);
    if (!outcome.trouble.empty()) return {};
    measureDepth(order, *map, outcome);
    outcome.registration = Box(registrationOf(order, outcome, *std::move(map)));
    return {};
}

}  // namespace

Result<std::unique_ptr<devices::CameraSource>> openedCamera(const ScanOrder& order) {
    if (devices::isEmulatedCamera(order.camera))
        return devices::openEmulatedCamera(order.camera, order.runtimeDirectory);
    return devices::openCameraSource(order.camera);
}

std::string provenanceOf(const ScanOrder& order) {
    if (devices::isEmulatedCamera(order.camera)) return "emulated";
    return order.camera == devices::kSimulatedCameraId ? "simulated" : "measured";
}

Result<ScanOutcome> scannedPictures(const ScanOrder& order, const devices::ScanWatch& watch,
                                    const std::stop_token& stop, const AlsoScanned& also) {
    const auto camera = openedCamera(order);
    if (!camera) return tl::unexpected(camera.error());
    devices::CoreShow show(order.runtimeDirectory, order.rig, order.rest, stop);
    ScanOutcome outcome;
    const auto after = [&](devices::PatternCamera& taker, const devices::CapturedScan& all) -> Result<void> {
        if (const auto done = evaluate(order, taker, all, outcome); !done || !outcome.trouble.empty()) return done;
        return also(taker, outcome);
    };
    devices::PatternCamera taker(**camera, show, order.wish, watch, stop);
    const auto captured = devices::capturedScan(taker, **camera, show, after);
    if (captured) return outcome;
    if (stop.stop_requested() || taker.black().empty()) return tl::unexpected(captured.error());
    outcome.captured = taker.facts();
    outcome.trouble = captured.error().what;
    outcome.white = taker.white();
    outcome.black = taker.black();
    outcome.moved = taker.moved();
    return outcome;
}

Result<ScanOutcome> scanned(const ScanOrder& order, const devices::ScanWatch& watch, const std::stop_token& stop) {
    return scannedPictures(order, watch, stop, [&](devices::PatternCamera& taker, ScanOutcome& outcome) {
        return mapAndCheck(order, taker, outcome);
    });
}

}  // namespace ilf::app
