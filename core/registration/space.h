// Points and rigid motions in the room that know the space they live in.
#pragma once

#include <array>

namespace ilf {

/// Spaces of three-dimensional points, metres: x right, y down, z forward, away from the device (OpenCV's axes).
struct CameraSpace {};     ///< origin at the camera's pinhole
struct ProjectorSpace {};  ///< origin at the projector's pinhole
struct ViewerSpace {};     ///< origin midway between the wearer's pupils, z along the lenses' axes
struct ModelSpace {};      ///< of a glTF scene or a board: its own axes

template <class Space>
struct Point3 {
    double x = 0.0, y = 0.0, z = 0.0;
    bool operator==(const Point3&) const = default;
};

/// A rigid motion that says both ends: `Pose<CameraSpace, ModelSpace> cameraFromModel`.
template <class To, class From>
struct Pose {
    std::array<double, 9> rotation{1, 0, 0, 0, 1, 0, 0, 0, 1};  ///< row-major, orthonormal, determinant 1
    std::array<double, 3> translation{0, 0, 0};                 ///< metres
    bool operator==(const Pose&) const = default;

    Point3<To> operator()(const Point3<From>& p) const {
        const auto& r = rotation;
        return {r[0] * p.x + r[1] * p.y + r[2] * p.z + translation[0],
                r[3] * p.x + r[4] * p.y + r[5] * p.z + translation[1],
                r[6] * p.x + r[7] * p.y + r[8] * p.z + translation[2]};
    }
    Pose<From, To> inverted() const {
        const auto& r = rotation;
        const auto& t = translation;
        Pose<From, To> back;
        back.rotation = {r[0], r[3], r[6], r[1], r[4], r[7], r[2], r[5], r[8]};
        for (std::size_t i = 0; i < 3; ++i)
            back.translation[i] = -(r[i] * t[0] + r[3 + i] * t[1] + r[6 + i] * t[2]);
        return back;
    }
    template <class Before>
    Pose<To, Before> operator*(const Pose<From, Before>& first) const {
        Pose<To, Before> both;
        for (std::size_t i = 0; i < 3; ++i) {
            for (std::size_t j = 0; j < 3; ++j) {
                both.rotation[3 * i + j] = rotation[3 * i] * first.rotation[j] +
                                           rotation[3 * i + 1] * first.rotation[3 + j] +
                                           rotation[3 * i + 2] * first.rotation[6 + j];
            }
            both.translation[i] = rotation[3 * i] * first.translation[0] + rotation[3 * i + 1] * first.translation[1] +
                                  rotation[3 * i + 2] * first.translation[2] + translation[i];
        }
        return both;
    }
};

}  // namespace ilf
