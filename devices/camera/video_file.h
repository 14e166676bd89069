// A video file as a camera, and its first frame as a picture.
#pragma once

#include <filesystem>

#include "devices/camera/camera_source.h"

namespace ilf::devices {

/// Plays at its own rate in real time and holds its last frame. Refused with a sentence: missing, empty, a folder, not
/// a video, more than 100 megapixels. A file that is damaged on the way ends where the damage begins.
Result<std::unique_ptr<CameraSource>> openVideoFile(const std::filesystem::path& path);

/// The first frame, at once.
Result<Picture> firstFrame(const std::filesystem::path& path);

}  // namespace ilf::devices
