// What the first bytes of a picture file say: its kind, size, focal length, which way is up, and whether it ends early.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "core/base/geometry.h"

namespace ilf::projects {

struct PictureHeader {
    enum class Kind { png, jpeg, tiff, webp };
    Kind kind = Kind::png;
    std::optional<Size> size;       ///< as stored; nothing when the header does not say
    bool tooLarge = false;          ///< it claims more than 100 megapixels, or sides beyond 2^20
    bool truncated = false;         ///< the end of the picture is missing
    int orientation = 1;            ///< EXIF 0x0112, 1..8; JPEG only
    std::optional<double> focal35;  ///< EXIF 0xA405: 35 mm equivalent focal length, in mm; JPEG only
};

/// Nothing when the bytes are no PNG, JPEG, TIFF or WebP. Every offset in the file is checked before it is followed.
std::optional<PictureHeader> pictureHeader(std::string_view bytes);

}  // namespace ilf::projects
