// Depth in files: 16-bit PNG, PFM and EXR, alone or as the depth half of an RGB-D pair, read and written.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "core/base/result.h"
#include "core/document/viewer_pose.h"

namespace ilf::projects {

/// How a file of depth is to be read.
struct DepthReading {
    Size picture;              ///< the depth must cover it, pixel by pixel; 0 x 0: the file's own size
    double focalPixels = 0.0;  ///< of the picture, used where there are no intrinsics
    /// Of a file of whole numbers: the length of one step. Absent: guessed from its values, and the note says so.
    std::optional<Metre> step;
    /// Of the pair's camera, at the resolution of the depth or of the picture. With them, a depth of another resolution
    /// of the same view is resampled; without, it is refused.
    std::optional<Pinhole> intrinsics;
};

struct DepthFile {
    MeasuredDepth measured;
    std::string note;  ///< what was guessed or changed, for the operator; or empty
};

/// A file by its content, not its name: PNG or TIFF of 16 bits (0: a hole), PFM of one channel (metres; either byte
/// order; bottom row first), EXR (channel Z, else Y, else the only one; metres; channel "sigma": one standard
/// deviation). Zero, negative, infinite and NaN values are holes. Refused with a sentence: what is no depth, what holds
/// only holes, another size than the picture's without intrinsics, and another view of it.
///
/// Guess of the step: 1 mm, as most cameras write; 0.2 mm (the TUM RGB-D benchmark's 1/5000 m) where 1 mm would put a
/// twentieth of all pixels beyond 10 m.
Result<DepthFile> readDepth(const std::filesystem::path& path, const DepthReading& reading);
Result<DepthFile> decodeDepth(std::string_view bytes, const std::string& name, const DepthReading& reading);

/// Open3D's `camera_primesense.json`: width, height and "intrinsic_matrix", nine numbers column by column, whose pixel
/// centres are whole numbers: cx and cy become ours, half a pixel more. Also inside "intrinsic", as in its camera
/// poses, and with our own addition "distortion" (k1, k2, p1, p2, k3).
Result<Pinhole> readIntrinsics(const std::filesystem::path& path);
std::string intrinsicsText(const Pinhole& camera);

/// Metres and, where known, sigma, exactly: as EXR of 32 bits, channels Z and sigma.
Result<std::string> encodeDepthExr(const Image<float>& metres, const Image<float>& sigma);
/// Metres as PFM, little-endian, bottom row first; holes are 0.
std::string encodeDepthPfm(const Image<float>& metres);
/// Whole steps as a PNG of 16 bits; what is farther than 65535 steps or less than one is a hole.
Result<std::string> encodeDepthPng(const Image<float>& metres, Metre step);

/// By the ending of the name: .png (steps of the map's own, else 0.1 mm), .pfm or .exr. Written atomically.
Result<void> writeDepth(const std::filesystem::path& path, const MeasuredDepth& measured);

}  // namespace ilf::projects
