// Calibrations as files of their own, and those of other programs.
#pragma once

#include <filesystem>

#include "core/base/quantity.h"
#include "core/base/result.h"
#include "core/registration/pinhole.h"

namespace ilf::projects {

inline constexpr int kCalibrationVersion = 1;

/// Refused with a sentence: damaged text, another kind of file, newer versions, numbers that cannot be.
Result<ProcamCalibration> readCalibration(const std::filesystem::path& path);

/// Written atomically. Keys in an existing file that this version does not know stay.
Result<void> writeCalibration(const std::filesystem::path& path, const ProcamCalibration& calibration);

/// Reads what OpenCV's FileStorage wrote (XML, YAML or JSON) under the names of procam-calibration
/// (github.com/kamino410): img_shape (rows and columns of the camera's picture), cam_int, cam_dist, proj_int,
/// proj_dist, rotation (there spelt "roration") and translation, by default in millimetres, and rms. The file does not
/// tell the projector's raster. Centres of pixels, whole numbers there, are shifted by half a pixel.
Result<ProcamCalibration> importCalibration(const std::filesystem::path& path, Size projector, Metre unit = 1.0_mm);

}  // namespace ilf::projects
