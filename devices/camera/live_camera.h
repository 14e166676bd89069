// A camera on V4L2, opened by its stable id.
#pragma once

#include <filesystem>

#include "devices/camera/camera_source.h"

namespace ilf::devices {

Result<std::unique_ptr<CameraSource>> openLiveCamera(const std::string& id,
                                                     const std::filesystem::path& v4l = "/dev/v4l");

}  // namespace ilf::devices
