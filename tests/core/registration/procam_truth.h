// A camera, a projector and a board whose truth is known, projected by formulas of their own: nothing here uses the
// code under test but its values.
#pragma once

#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "core/registration/calibrate.h"

namespace ilf::truth {

/// A lens as the textbook writes it (OpenCV's calib3d page), pixels with their centres at + 0.5.
struct Lens {
    Size size;
    double fx, fy, cx, cy, k1 = 0, k2 = 0, p1 = 0, p2 = 0, k3 = 0;

    std::array<double, 2> pixel(double X, double Y, double Z) const {
        const double x = X / Z, y = Y / Z, r2 = x * x + y * y;
        const double radial = 1 + k1 * r2 + k2 * r2 * r2 + k3 * r2 * r2 * r2;
        const double xd = x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x * x);
        const double yd = y * radial + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y;
        return {fx * xd + cx, fy * yd + cy};
    }
    Pinhole pinhole() const { return {size, fx, fy, cx, cy, {k1, k2, p1, p2, k3}}; }
};

using Turn = std::array<double, 9>;

inline Turn turned(double aboutX_deg, double aboutY_deg, double aboutZ_deg) {
    const double k = 3.14159265358979323846 / 180.0;
    const double a = aboutX_deg * k, b = aboutY_deg * k, c = aboutZ_deg * k;
    const double ca = std::cos(a), sa = std::sin(a), cb = std::cos(b), sb = std::sin(b), cc = std::cos(c),
                 sc = std::sin(c);
    return {cc * cb,
            cc * sb * sa - sc * ca,
            cc * sb * ca + sc * sa,
            sc * cb,
            sc * sb * sa + cc * ca,
            sc * sb * ca - cc * sa,
            -sb,
            cb * sa,
            cb * ca};
}

/// A table-top rig: the projector 25 cm to the right and below, a little turned in, its axis through the raster's lower
/// edge.
struct Procam {
    Lens camera{{1280, 1024}, 1500.0, 1504.0, 652.0, 498.0, -0.21, 0.14, 0.0006, -0.0004, 0.0};
    Lens projector{{1024, 768}, 1650.0, 1646.0, 519.0, 742.0, -0.05, 0.04, 0.0, 0.0, 0.0};
    Pose<ProjectorSpace, CameraSpace> projectorFromCamera{turned(4.0, 13.0, 1.0), {-0.25, -0.15, 0.03}};

    ProcamCalibration calibration() const {
        ProcamCalibration c;
        c.camera = camera.pinhole();
        c.projector = projector.pinhole();
        c.projectorFromCamera = projectorFromCamera;
        c.poses = 5;
        c.scale = "board";
        c.provenance = "simulated";
        return c;
    }
};

inline const Board kBoard{9, 7, 55.0_mm};

struct BoardAt {
    double x_deg, y_deg, z_deg, x, y, z;  ///< angles, and where the board's middle is, metres
};

/// As an operator is told to hold it: five tilts about a metre away.
inline std::vector<BoardAt> fivePoses() {
    return {{0, 0, 2, 0.00, 0.00, 0.95},
            {32, 4, -5, 0.04, -0.02, 1.00},
            {-30, 8, 6, -0.05, 0.03, 0.95},
            {5, 33, 3, -0.03, -0.03, 1.05},
            {-8, -34, -8, 0.05, 0.02, 0.98}};
}

inline Pose<CameraSpace, ModelSpace> poseOf(const BoardAt& at, const Board& board) {
    Pose<CameraSpace, ModelSpace> pose;
    pose.rotation = turned(at.x_deg, at.y_deg, at.z_deg);
    const double w = 0.5 * (board.columns - 1) * board.square.si(), h = 0.5 * (board.rows - 1) * board.square.si();
    const auto middle = pose(Point3<ModelSpace>{w, h, 0});
    pose.translation = {at.x - middle.x, at.y - middle.y, at.z - middle.z};
    return pose;
}

/// The corners as a camera and a scan with this noise (one standard deviation of x and of y) would give them.
inline BoardView viewOf(const Procam& procam, const BoardAt& at, const Board& board, double camera_px,
                        double projector_px, std::mt19937& random) {
    std::normal_distribution<double> noise(0.0, 1.0);
    const auto pose = poseOf(at, board);
    BoardView view;
    view.camera = procam.camera.size;
    view.projector = procam.projector.size;
    for (int row = 0; row < board.rows; ++row) {
        for (int column = 0; column < board.columns; ++column) {
            const auto p = pose({column * board.square.si(), row * board.square.si(), 0.0});
            const auto q = procam.projectorFromCamera(p);
            const auto c = procam.camera.pixel(p.x, p.y, p.z);
            const auto r = procam.projector.pixel(q.x, q.y, q.z);
            view.inCamera.push_back({c[0] + camera_px * noise(random), c[1] + camera_px * noise(random)});
            view.onProjector.push_back(
                Point<ProjectorFrame>{r[0] + projector_px * noise(random), r[1] + projector_px * noise(random)});
        }
    }
    return view;
}

inline std::vector<BoardView> viewsOf(const Procam& procam, const std::vector<BoardAt>& poses, double noise_px,
                                      unsigned seed) {
    std::mt19937 random(seed);
    std::vector<BoardView> views;
    for (const BoardAt& at : poses) {
        views.push_back(viewOf(procam, at, kBoard, noise_px, noise_px, random));
        views.back().name = "pose " + std::to_string(views.size());
    }
    return views;
}

/// Slopes of a pixel's ray, by fixed-point iteration of the textbook's formula, to 1e-9.
inline std::array<double, 2> slopes(const Lens& lens, double px, double py) {
    double x = (px - lens.cx) / lens.fx, y = (py - lens.cy) / lens.fy;
    for (int i = 0; i < 14; ++i) {
        const auto at = lens.pixel(x, y, 1.0);
        x += (px - at[0]) / lens.fx, y += (py - at[1]) / lens.fy;
    }
    return {x, y};
}

/// A scan of the plane z = depth + slopeX x + slopeY y (metres, camera's space), with noise on the raster; `truth` gets
/// each pixel's depth.
inline DecodedScan scanOf(const Procam& procam, double depth, double slopeX, double slopeY, double noise_px,
                          unsigned seed, std::vector<double>& truth) {
    std::mt19937 random(seed);
    std::normal_distribution<double> noise(0.0, noise_px > 0.0 ? noise_px : 1.0);
    const Size size = procam.camera.size;
    const auto count = static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height);
    std::vector<float> places(2 * count, std::numeric_limits<float>::quiet_NaN());
    std::vector<std::uint8_t> confidence(count, 0), state(count, 1);
    truth.assign(count, 0.0);
    for (int y = 0; y < size.height; ++y) {
        for (int x = 0; x < size.width; ++x) {
            const auto [a, b] = slopes(procam.camera, x + 0.5, y + 0.5);
            const double z = depth / (1.0 - slopeX * a - slopeY * b);
            const auto q = procam.projectorFromCamera(Point3<CameraSpace>{a * z, b * z, z});
            auto p = procam.projector.pixel(q.x, q.y, q.z);
            if (noise_px > 0.0) p[0] += noise(random), p[1] += noise(random);
            if (p[0] < 0.0 || p[1] < 0.0 || p[0] > procam.projector.size.width || p[1] > procam.projector.size.height)
                continue;
            const auto at =
                static_cast<std::size_t>(y) * static_cast<std::size_t>(size.width) + static_cast<std::size_t>(x);
            places[2 * at] = static_cast<float>(p[0]), places[2 * at + 1] = static_cast<float>(p[1]);
            confidence[at] = 255, state[at] = 0;
            truth[at] = z;
        }
    }
    DecodedScan scan;
    scan.projector = procam.projector.size;
    scan.projectorOfCamera = Image<float>(size, 2, std::move(places));
    scan.confidence = Image<std::uint8_t>(size, 1, std::move(confidence));
    scan.state = Image<std::uint8_t>(size, 1, std::move(state));
    return scan;
}

}  // namespace ilf::truth
