// Pictures in files: PNG, JPEG, TIFF and WebP read and PNG written, with sentences for what is wrong with them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "core/base/box.h"
#include "core/base/image.h"
#include "core/base/result.h"
#include "core/base/tile_grid.h"

namespace ilf::projects {

/// More pixels than this are refused before anything is decoded.
inline constexpr std::int64_t kMaxPixels = 100'000'000;

struct PictureFile {
    Picture picture;
    /// f_px from the 35 mm equivalent focal length in a JPEG's EXIF data, for the picture as it is shown.
    std::optional<double> focalPixels;
    std::string note;        ///< what the operator should know ("Its transparency was laid over black."), or empty
    Box<std::string> bytes;  ///< the file as it was, for a project to keep
    std::string extension;   ///< of that content: ".png", ".jpg", ".tiff" or ".webp"
};

/// Reads a picture of 8 or 16 bits, grey or colour, turned upright. Refused with a sentence: missing, empty, truncated,
/// not a picture, more than 100 megapixels (whatever its header claims), a folder.
Result<PictureFile> readPicture(const std::filesystem::path& path);
/// The same for a file already in memory; `name` is for the sentences.
Result<PictureFile> decodePicture(Box<std::string> bytes, const std::string& name);

/// 0..255, one channel; other pictures are turned to grey, 16 bits are rounded to 8.
Result<Image<std::uint8_t>> readMask(const std::filesystem::path& path);
Result<Image<std::uint8_t>> decodeMask(std::string_view bytes, const std::string& name);

/// One channel of 16 bits, as it is in the file; colour and 8-bit pictures are refused, since their depth is unknown.
Result<Image<std::uint16_t>> readDepth16(const std::filesystem::path& path);
Result<Image<std::uint16_t>> decodeDepth16(std::string_view bytes, const std::string& name);

/// PNG files of 1 (grey), 3 (RGB) or 4 (RGBA) channels.
Result<std::string> encodePng(const Image<std::uint8_t>& image);
Result<std::string> encodePng16(const Image<std::uint16_t>& image);
/// As 8 bits where that loses nothing, else as 16.
Result<std::string> encodePicture(const Picture& picture);

/// Written atomically.
Result<void> writePng(const std::filesystem::path& path, const Image<std::uint8_t>& image);
Result<void> writePng16(const std::filesystem::path& path, const Image<std::uint16_t>& image);

}  // namespace ilf::projects
