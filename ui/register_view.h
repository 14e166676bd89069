// Registering a camera with the projector, as the window shows it: what is seen, what was found, what may be done.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/base/geometry.h"
#include "core/base/image.h"
#include "core/registration/point_pairs.h"
#include "core/registration/scan_diagnosis.h"

namespace ilf::ui {

/// Ways to a registration. All are always at hand: where one is refused, the next may do.
enum class RegisterWay { scan, corners, pairs, board };

/// What the operator says before light is shown.
struct RegisterSetup {
    bool anyway = false;  ///< scans also where the room's light says no
    bool asScene = true;  ///< the picture under white light becomes the scene's
    bool operator==(const RegisterSetup&) const = default;
};

struct RegisterPair {
    PointPair at;
    double residual_px = 0.0;  ///< on the raster
    bool fitted = false;       ///< there were enough pairs for a residual
    bool used = true;          ///< not: so far off that it was left out
};

/// A registration that can be accepted.
struct RegisterFound {
    RegisterWay way = RegisterWay::scan;
    double rms_px = 0.0, worst_px = 0.0;  ///< on the raster
    int points = 0;
    std::string provenance;  ///< simulated, emulated, measured
    std::string note;        ///< one sentence; may be empty
};

/// What the room's light was found to be.
struct RegisterLight {
    bool go = false;
    std::string what;  ///< one sentence
    double projectorShare = 0.0, contrast = 0.0, exposure_s = 0.0;
};

/// The camera no longer stands where it was registered.
struct BumpView {
    double moved_px = 0.0;  ///< median way of what is seen, camera pixels
};

/// Nothing of it is a device: the app shows light, takes pictures and says how far it is.
struct RegisterView {
    enum class State {
        ready,     ///< the camera's picture is live
        working,   ///< patterns are shown and pictures taken of them; the camera is the scan's
        stopping,  ///< cancelled: on the way to steady white light
        accepted,  ///< a registration was written into the rig
    };
    State state = State::ready;
    RegisterWay way = RegisterWay::scan;
    std::string camera;       ///< its id
    bool emulated = false;    ///< it sees the emulated scene
    bool showsMarks = false;  ///< the projector shows its frame, or a numbered cross

    Image<std::uint8_t> picture;  ///< what is shown: live, the newest of a scan, or a scan's quality
    bool quality = false;         ///< `picture` is the quality map
    bool hasQuality = false;      ///< there is one
    std::vector<QualityColour> legend;

    std::string doing;      ///< "Stripes down, 4 of 10"
    int done = 0, all = 1;  ///< pictures
    std::optional<RegisterLight> light;
    std::vector<ScanFinding> findings;
    std::vector<std::string> remarks;
    double decodedShare = -1.0;  ///< of what is lit; below 0: nothing was scanned yet
    std::string trouble;         ///< the last thing that was refused, with what helps
    std::optional<RegisterFound> found;

    std::array<Point<CameraFrame>, 4> corners{};  ///< of the raster: upper left, then clockwise
    std::vector<RegisterPair> pairs;
    int worst = -1;                ///< the pair that fits worst
    Point<ProjectorFrame> target;  ///< where the numbered cross is
    bool targetsLeft = true;       ///< false: every place has its pair

    bool patterns() const { return state == State::working || state == State::stopping || showsMarks; }
};

}  // namespace ilf::ui
