// What is wrong with a scan, in the operator's words, and where: one finding for each cause, and a picture of quality.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "core/base/image.h"
#include "core/registration/gray_code.h"

namespace ilf {

enum class ScanFault {
    tooDark,        ///< the projector's light is hardly above noise
    saturated,      ///< the sensor's range ends below the light
    moved,          ///< camera, projector or scene moved while pictures were taken
    wrongScreen,    ///< nothing the camera sees follows the patterns
    otherOrder,     ///< the pictures show the patterns, in another order
    ambientLight,   ///< other light is stronger than the projector's
    previousFrame,  ///< pictures show what the projector showed 1 to 3 patterns before
    glossy,         ///< places see two parts of the raster: gloss, or light thrown from surface to surface
    flat,           ///< one plane: good for a map, too little for a calibration
    fewPixels,      ///< too little of the picture was decoded for a map
};
/// The word files and programs use: "too-dark", "previous-frame", ...
const char* word(ScanFault fault);

struct ScanFinding {
    enum class Weight {
        note,     ///< good to know
        warning,  ///< the map can be used, with care
        failure,  ///< do not use the map
    };
    ScanFault fault;
    Weight weight;
    std::string what;             ///< one sentence: what, where, what would help
    PixelRect<CameraFrame> area;  ///< where it is worst; empty: everywhere
    bool operator==(const ScanFinding&) const = default;
};

struct ScanDiagnosis {
    std::vector<ScanFinding> findings;  ///< the cause to see to first comes first
    int lit = 0;                        ///< pixels with light of the projector's, told apart or not
    double decodedShare = 0.0;          ///< decoded pixels among those lit
    double medianContrast = 0.0;        ///< of lit pixels, white above black, 0..255
    double projectorShare = 0.0;        ///< of lit pixels' white, what is the projector's: median
    bool usable() const;                ///< no finding is a failure
};

/// Precondition: `decoded` is decodedScan(scan).
ScanDiagnosis scanDiagnosis(const Scan& scan, const DecodedScan& decoded);

/// RGB, camera's size, in colours that also colour-blind people tell apart (Okabe and Ito's).
Image<std::uint8_t> qualityMap(const DecodedScan& decoded);
struct QualityColour {
    std::array<std::uint8_t, 3> rgb;
    std::string words;
};
std::vector<QualityColour> qualityLegend();

}  // namespace ilf
