// The cameras plugged in, by names that stay the same when they are plugged in another order.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/base/result.h"

namespace ilf::devices {

struct CameraEntry {
    std::string id;                ///< stable: /dev/v4l/by-id/..., else by-path; an emulated one's id
    std::string name;              ///< for the operator
    std::filesystem::path device;  ///< /dev/videoN at this moment; empty for those that are none
    bool byPort = false;           ///< without serial number: the id tells the port, not the camera
    bool operator==(const CameraEntry&) const = default;
};

/// Cameras found under `v4l` (/dev/v4l), each once, then the simulated and the emulated camera. Of the several nodes of
/// one camera only the first gives pictures.
std::vector<CameraEntry> listCameras(const std::filesystem::path& v4l = "/dev/v4l");

/// The device node behind an id now. Refused with a sentence when that camera is not plugged in.
Result<std::filesystem::path> deviceOf(const std::string& id, const std::filesystem::path& v4l = "/dev/v4l");

}  // namespace ilf::devices
