// A scan from the first light to a registration that was checked: what the wizard and `illuminatedfocus scan` do.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "core/document/rig.h"
#include "core/registration/map_check.h"
#include "core/registration/scan_diagnosis.h"
#include "core/registration/triangulate.h"
#include "devices/scan/captured_scan.h"

namespace ilf::app {

struct ScanOrder {
    /// Whose raster and rates; the core must play this rig. Where it is calibrated the scan measures depth.
    Rig rig;
    Dioptre rest;                            ///< of the wearer's lenses
    std::filesystem::path runtimeDirectory;  ///< of the output core, which must run
    std::string camera;                      ///< id, as devices::listCameras gives it; "emulated:WORDS" goes as well
    devices::ScanWish wish;
    /// A folder that is not there yet for the pictures, as decode-scan reads them; empty: not kept.
    std::filesystem::path keep;
};

/// What a scan found. Pictures and findings are there also where there is no registration.
struct ScanOutcome {
    devices::CapturedScan captured;
    DecodedScan decoded;
    ScanDiagnosis diagnosis;
    std::optional<MapCheck> columns, rows;  ///< stripes shown anew; none: the map was not good enough to try
    Box<Registration> registration;         ///< empty: `trouble` says why
    std::string trouble;                    ///< one sentence; empty: registered and checked
    Image<std::uint8_t> white, black;       ///< where it ended before all pictures were taken; else empty
    Image<std::uint8_t> moved;              ///< white again, where something had moved; else empty
    std::optional<Triangulated> depth;      ///< of a registration by a calibrated rig; none: `noDepth` says why
    std::string noDepth;                    ///< one sentence; empty: measured, or the rig is not calibrated
};

/// Opens the camera (nobody else may have it), takes all pictures, decodes, diagnoses, and checks the map on stripes
/// shown anew. Blocks for tens of seconds: `stop` ends it soon. However it ends, light is steady and white, lenses at
/// rest, and safe light is held until the next TAKE. Nobody else may send to the core meanwhile. A scan that is refused
/// once white and black were seen is an outcome with that trouble.
Result<ScanOutcome> scanned(const ScanOrder& order, const devices::ScanWatch& watch, const std::stop_token& stop);

/// All pictures, decoded and diagnosed, and no map; then `also`, while patterns can still be shown, where the scan is
/// usable. Otherwise as `scanned`.
using AlsoScanned = std::function<Result<void>(devices::PatternCamera&, ScanOutcome&)>;
Result<ScanOutcome> scannedPictures(const ScanOrder& order, const devices::ScanWatch& watch,
                                    const std::stop_token& stop, const AlsoScanned& also);

/// The order's camera; nobody else may have it open.
Result<std::unique_ptr<devices::CameraSource>> openedCamera(const ScanOrder& order);

/// "simulated", "emulated" or "measured": what may be said of light and camera of this order.
std::string provenanceOf(const ScanOrder& order);

}  // namespace ilf::app
