// Pictures for others to read: 8-bit PNG, 16-bit TIFF or floating-point EXR.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "core/base/image.h"
#include "core/base/result.h"

namespace ilf::projects {

/// What each holds of linear light: sRGB codes of 8 or 16 bits (tagged as such), or the light itself.
enum class PictureFormat { png, tiff, exr };

/// By the ending of the name, in any case: .png, .tif, .tiff or .exr. Others are refused.
Result<PictureFormat> pictureFormat(const std::filesystem::path& path);
/// ".png", ".tiff" or ".exr".
const char* ending(PictureFormat format);

/// Linear radiance, 1 or 3 channels: sRGB-encoded in PNG and TIFF (clamped to 0..1), itself in EXR.
struct LightPicture {
    Radiance linear;
};
/// Codes that are already 16 bits: rounded to 8 in PNG, themselves in TIFF; in EXR the light they stand for.
struct CodePicture {
    Picture codes;
    bool srgb = true;  ///< false: codes are linear in light, as a projector's levels are
};
/// Signed differences of linear radiance: in EXR themselves; in PNG and TIFF their amount, linear, `white` being the
/// highest code.
struct DifferencePicture {
    Radiance difference;
    double white = 1.0;
};
using ExportPixels = std::variant<LightPicture, CodePicture, DifferencePicture>;
Size sizeOf(const ExportPixels& pixels);

/// What is known of a picture, in order: "eye" -> "left". Written beside the pixels: EXR attributes, the TIFF's
/// description, PNG texts. Keys are lower-case words of ASCII without colons; values without line breaks.
using PictureFacts = std::vector<std::pair<std::string, std::string>>;

/// Of the numbers in an EXR.
enum class ExrDepth {
    half,    ///< 16 bits, 11 of precision
    single,  ///< 32 bits: exactly what was computed
};

/// The whole file. Refused: pictures without pixels, and a library that fails.
Result<std::string> encodedExport(const ExportPixels& pixels, const PictureFacts& facts, PictureFormat format,
                                  ExrDepth depth = ExrDepth::single);

/// Written atomically.
Result<void> writeExport(const std::filesystem::path& path, const ExportPixels& pixels, const PictureFacts& facts,
                         PictureFormat format, ExrDepth depth = ExrDepth::single);

}  // namespace ilf::projects
