// Registering a camera with the projector, as the window shows it: what is seen, what was found, what may be done.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/base/box.h"
#include "core/base/geometry.h"
#include "core/base/image.h"
#include "core/registration/calibrate.h"
#include "core/registration/point_pairs.h"
#include "core/registration/scan_diagnosis.h"

namespace ilf::ui {

/// Ways to a registration, and to a calibration of camera and projector, with which a scan measures depth as well. All
/// are always at hand: where one is refused, the next may do.
enum class RegisterWay { scan, corners, pairs, board, calibration };

/// What of the camera the page shows.
enum class RegisterPicture {
    live,
    quality,  ///< of a scan: what was decoded where, and why not
    depth,    ///< of a scan with a calibration: the nearer, the brighter
    spread,   ///< of the same: how well each pixel's depth is known
};

/// What the operator says before light is shown.
struct RegisterSetup {
    bool anyway = false;  ///< scans also where the room's light says no
    bool asScene = true;  ///< the picture under white light becomes the scene's
    bool depth = true;    ///< and what the scan measured its depth
    bool operator==(const RegisterSetup&) const = default;
};

struct RegisterPair {
    PointPair at;
    double residual_px = 0.0;  ///< on the raster
    bool fitted = false;       ///< there were enough pairs for a residual
    bool used = true;          ///< not: so far off that it was left out
};

/// What a scan measured with the rig's calibration.
struct RegisterDepth {
    Metre nearest, farthest;  ///< from the camera; all but one in a hundred lie between
    Metre sigma;              ///< median of one standard deviation
    double share = 0.0;       ///< of what was decoded
    /// One standard deviation of all but one in a hundred.
    Metre surest, vaguest;
    Image<float> metres, spread;  ///< the picture's size; 0: no depth there
};

/// A registration that can be accepted.
struct RegisterFound {
    RegisterWay way = RegisterWay::scan;
    double rms_px = 0.0, worst_px = 0.0;  ///< on the raster
    int points = 0;
    std::string provenance;  ///< simulated, emulated, measured
    std::string note;        ///< one sentence; may be empty
    std::optional<RegisterDepth> depth;
    std::string noDepth;  ///< why there is none although the rig is calibrated; may be empty
};

/// One pose of a printed chessboard and how well it fits.
struct RegisterPose {
    std::string name;
    int cameraCorners = 0, projectorCorners = 0;  ///< of the board's, seen and placed on the raster
    bool fitted = false;                          ///< there is a calibration, so there are residuals
    bool used = true;                             ///< not: so far off that it was left out
    double camera_px = 0.0, projector_px = 0.0;   ///< rms
};

/// Poses of a printed chessboard so far, and what they make of camera and projector.
struct RegisterPoses {
    Board board;
    std::vector<RegisterPose> poses;
    std::vector<Point<CameraFrame>> corners;  ///< of the newest, row by row
    Box<Calibrated> found;                    ///< can be accepted; empty: `refused` says why
    std::string refused;
    int next = 1;  ///< number of the next pose
};

/// Two points that the operator laid a tape between.
struct RegisterTape {
    bool placing = false;  ///< clicks on the picture are its ends
    std::vector<Point<CameraFrame>> ends;
    Metre length;       ///< by the depth that was measured; 0: not known
    std::string scale;  ///< where metres come from: "board" or "tape"
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
        accepted,  ///< a registration, or a calibration, was written into the rig
    };
    State state = State::ready;
    RegisterWay way = RegisterWay::scan;
    std::string camera;       ///< its id
    bool emulated = false;    ///< it sees the emulated scene
    bool showsMarks = false;  ///< the projector shows its frame, or a numbered cross

    Image<std::uint8_t> picture;  ///< what is shown: live, the newest of a scan, or a scan's quality
    RegisterPicture shows = RegisterPicture::live;
    bool hasQuality = false, hasDepth = false;  ///< there is one to be shown
    std::vector<QualityColour> legend;
    std::vector<std::array<std::uint8_t, 3>>
        ramp;  ///< a depth picture's colours, from its least figure to its greatest

    std::string doing;      ///< "Stripes down, 4 of 10"
    int done = 0, all = 1;  ///< pictures
    std::optional<RegisterLight> light;
    std::vector<ScanFinding> findings;
    std::vector<std::string> remarks;
    double decodedShare = -1.0;  ///< of what is lit; below 0: nothing was scanned yet
    std::string trouble;         ///< the last thing that was refused, with what helps
    std::optional<RegisterFound> found;
    bool accepting = false;   ///< waits for the scene's picture under steady light
    bool calibrated = false;  ///< the rig is: a scan measures depth
    RegisterPoses calibration;
    RegisterTape tape;

    std::array<Point<CameraFrame>, 4> corners{};  ///< of the raster: upper left, then clockwise
    std::vector<RegisterPair> pairs;
    int worst = -1;                ///< the pair that fits worst
    Point<ProjectorFrame> target;  ///< where the numbered cross is
    bool targetsLeft = true;       ///< false: every place has its pair

    bool patterns() const { return state == State::working || state == State::stopping || showsMarks; }
};

}  // namespace ilf::ui
