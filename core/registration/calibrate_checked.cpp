#include <algorithm>
#include <cmath>

#include "core/registration/calibrate.h"

namespace ilf {

namespace {

Result<void> checked(const Pinhole& p, const std::string& device) {
    if (p.size.width < 1 || p.size.height < 1 || p.size.width > 100000 || p.size.height > 100000) {
        return fail(Fault::outOfRange, "The " + device + "'s frame must be 1 to 100000 pixels wide and high.");
    }
    const bool finite = std::isfinite(p.cx) && std::isfinite(p.cy) &&
                        std::ranges::all_of(p.distortion, [](double d) { return std::isfinite(d); });
    if (!finite || !(p.fx > 0.0 && p.fy > 0.0 && std::isfinite(p.fx) && std::isfinite(p.fy))) {
        return fail(Fault::outOfRange,
                    "The " + device + "'s focal lengths must be above 0, and all of its numbers finite.");
    }
    return {};
}

/// Rows of unit length at right angles, right-handed, to what files with seven digits keep.
bool isRotation(const std::array<double, 9>& r) {
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < 3; ++j) {
            const double dot = r[3 * i] * r[3 * j] + r[3 * i + 1] * r[3 * j + 1] + r[3 * i + 2] * r[3 * j + 2];
            if (!(std::abs(dot - (i == j ? 1.0 : 0.0)) < 1e-5)) return false;
        }
    }
    return r[0] * (r[4] * r[8] - r[5] * r[7]) - r[1] * (r[3] * r[8] - r[5] * r[6]) +
               r[2] * (r[3] * r[7] - r[4] * r[6]) >
           0.0;
}

}  // namespace

Result<void> checked(const ProcamCalibration& c) {
    if (const auto good = checked(c.camera, "camera"); !good) return good;
    if (const auto good = checked(c.projector, "projector"); !good) return good;
    if (!isRotation(c.projectorFromCamera.rotation)) {
        return fail(Fault::outOfRange,
                    "The rotation between camera and projector is not one: its rows must have length "
                    "1 and stand at right angles.");
    }
    const auto& t = c.projectorFromCamera.translation;
    if (!std::ranges::all_of(t, [](double metres) { return std::abs(metres) <= 1000.0; })) {
        return fail(Fault::outOfRange, "Camera and projector must stand within 1000 m of each other.");
    }
    if (!(c.cameraRms_px >= 0.0 && c.cameraRms_px < 1e4 && c.projectorRms_px >= 0.0 && c.projectorRms_px < 1e4)) {
        return fail(Fault::outOfRange, "Residuals must be 0 to 10000 pixels.");
    }
    if (c.poses < 0) return fail(Fault::outOfRange, "A calibration rests on 0 poses of the board or more.");
    return {};
}

}  // namespace ilf
