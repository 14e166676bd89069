// A scan from the first light to a registration that was checked: what the wizard and `illuminatedfocus scan` do.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "core/document/rig.h"
#include "core/registration/map_check.h"
#include "core/registration/scan_diagnosis.h"
#include "devices/scan/captured_scan.h"

namespace ilf::app {

struct ScanOrder {
    Rig rig;                                 ///< whose raster and rates; the core must play this rig
    Dioptre rest;                            ///< of the wearer's lenses
    std::filesystem::path runtimeDirectory;  ///< of the output core, which must run
    std::string camera;                      ///< id, as devices::listCameras gives it; "emulated:WORDS" goes as well
    devices::ScanWish wish;
    std::filesystem::path keep;  ///< folder for the pictures, as decode-scan reads them; empty: not kept
};

/// What a scan found. Pictures and findings are there also where there is no registration.
struct ScanOutcome {
    devices::CapturedScan captured;
    DecodedScan decoded;
    ScanDiagnosis diagnosis;
    std::optional<MapCheck> columns, rows;  ///< stripes shown anew; none: the map was not good enough to try
    Box<Registration> registration;         ///< empty: `trouble` says why
    std::string trouble;                    ///< one sentence; empty: registered and checked
};

/// Opens the camera (nobody else may have it), takes all pictures, decodes, diagnoses, and checks the map on stripes
/// shown anew. Blocks for tens of seconds: `stop` ends it soon. However it ends, light is steady and white, lenses at
/// rest, and safe light is held until the next TAKE. Nobody else may send to the core meanwhile.
Result<ScanOutcome> scanned(const ScanOrder& order, const devices::ScanWatch& watch, const std::stop_token& stop);

/// The order's camera; nobody else may have it open.
Result<std::unique_ptr<devices::CameraSource>> openedCamera(const ScanOrder& order);

/// "simulated", "emulated" or "measured": what may be said of light and camera of this order.
std::string provenanceOf(const ScanOrder& order);

}  // namespace ilf::app
