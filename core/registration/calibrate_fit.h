// The adjustment below calibrate.h: all numbers of one or two pinholes and the board's poses, fitted at once.
#pragma once

#include <array>
#include <vector>

#include "core/registration/board.h"

namespace ilf::fit {

/// One corner in one picture; `x`, `y` in the project's pixels.
struct Sighting {
    int corner = 0;
    double x = 0.0, y = 0.0;
};

/// Sightings by device (0: camera, 1: projector) and pose.
struct Problem {
    std::vector<Point3<ModelSpace>> corners;
    std::array<std::vector<std::vector<Sighting>>, 2> seen;
    std::array<double, 2> noise_px{1.0, 1.0};  ///< what a device's residuals are weighed by
    std::array<int, 2> terms{0, 0};            ///< of distortion that are estimated: 0 to 5, as k1 k2 p1 p2 k3

    int poses() const { return static_cast<int>(seen[0].size()); }
    bool withProjector() const { return !seen[1].empty(); }
};

/// fx, fy, cx, cy, k1, k2, p1, p2, k3.
using Lens = std::array<double, 9>;
/// A rotation vector and a translation.
using Motion = std::array<double, 6>;

struct Numbers {
    std::array<Lens, 2> lens{};
    Motion projectorFromCamera{};
    std::vector<Motion> cameraFromBoard;
};

struct Fitted {
    Numbers numbers;
    double cost = 0.0;  ///< squared residuals over squared noise, summed; large ones count linearly
    std::array<std::vector<double>, 2> pose_px;  ///< rms by device and pose; 0 where nothing was seen
    std::array<double, 2> rms_px{};
    std::array<int, 2> sightings{};
    /// One standard deviation of each number, where it was asked for.
    std::array<Lens, 2> lensDeviation{};
    Motion motionDeviation{};
};

/// Where OpenCV's calibrateCamera leaves the camera and the poses, and where a direct solution then puts the projector.
/// Throws cv::Exception where there is none.
Numbers started(const Problem& problem, Size camera);

/// Levenberg and Marquardt's steps to the least cost. `deviations`: they are worked out as well.
Fitted fitted(const Problem& problem, Numbers start, bool deviations);

}  // namespace ilf::fit
