#include "projects/picture_header.h"

#include <cstdint>

#include "projects/pictures.h"

namespace ilf::projects {
namespace {

/// Reads numbers out of untrusted bytes; what lies outside reads as 0 and is remembered.
class Bytes {
public:
    Bytes(std::string_view bytes, bool bigEndian) : bytes_(bytes), big_(bigEndian) {}
    bool well() const { return well_; }
    std::uint64_t number(std::uint64_t at, int width) {
        if (at > bytes_.size() || bytes_.size() - at < static_cast<std::uint64_t>(width)) {
            well_ = false;
            return 0;
        }
        std::uint64_t value = 0;
        for (int i = 0; i < width; ++i) {
            const auto byte =
                static_cast<std::uint8_t>(bytes_[at + static_cast<std::uint64_t>(big_ ? i : width - 1 - i)]);
            value = value << 8 | byte;
        }
        return value;
    }

private:
    std::string_view bytes_;
    bool big_;
    bool well_ = true;
};

void setSize(PictureHeader& header, std::uint64_t width, std::uint64_t height) {
    constexpr std::uint64_t kMaxSide = 1U << 20;
    if (width > kMaxSide || height > kMaxSide || width * height > static_cast<std::uint64_t>(kMaxPixels)) {
        header.tooLarge = true;
        return;
    }
    header.size = Size{static_cast<int>(width), static_cast<int>(height)};
}

/// PNG: signature, then chunks of length, type, data, checksum; IHDR comes first and IEND last.
PictureHeader pngHeader(std::string_view bytes) {
    PictureHeader header;
    Bytes at(bytes, true);
    setSize(header, at.number(16, 4), at.number(20, 4));
    std::uint64_t position = 8;
    for (;;) {
        const std::uint64_t length = at.number(position, 4);
        if (!at.well() || position + 12 + length > bytes.size()) {
            header.truncated = true;
            return header;
        }
        if (bytes.substr(position + 4, 4) == "IEND") return header;
        position += 12 + length;
    }
}

/// One entry of a TIFF directory (EXIF data is a small TIFF file): tag, type, count, value or offset.
std::optional<std::uint64_t> tiffValue(std::string_view tiff, bool big, std::uint64_t directory, std::uint64_t tag) {
    Bytes at(tiff, big);
    const std::uint64_t entries = at.number(directory, 2);
    for (std::uint64_t i = 0; i < entries && at.well(); ++i) {
        const std::uint64_t entry = directory + 2 + 12 * i;
        if (at.number(entry, 2) != tag) continue;
        const std::uint64_t value = at.number(entry + 2, 2) == 3 ? at.number(entry + 8, 2) : at.number(entry + 8, 4);
        if (at.well()) return value;
    }
    return std::nullopt;
}

void readExif(PictureHeader& header, std::string_view tiff) {
    const bool big = tiff.starts_with("MM");
    if (!big && !tiff.starts_with("II")) return;
    Bytes at(tiff, big);
    const std::uint64_t first = at.number(4, 4);
    if (!at.well()) return;
    const auto orientation = tiffValue(tiff, big, first, 0x0112);
    if (orientation && *orientation >= 1 && *orientation <= 8) header.orientation = static_cast<int>(*orientation);
    const auto exif = tiffValue(tiff, big, first, 0x8769);
    if (!exif) return;
    const auto focal = tiffValue(tiff, big, *exif, 0xA405);
    if (focal && *focal > 0 && *focal < 10000) header.focal35 = static_cast<double>(*focal);
}

/// JPEG: segments FF xx, length, data, up to the start of scan; the scan runs to FF D9.
PictureHeader jpegHeader(std::string_view bytes) {
    PictureHeader header;
    header.kind = PictureHeader::Kind::jpeg;
    Bytes at(bytes, true);
    std::uint64_t position = 2;
    for (;;) {
        while (at.number(position, 1) == 0xFF && at.number(position + 1, 1) == 0xFF)
            ++position;  // fill bytes
        const std::uint64_t marker = at.number(position + 1, 1);
        const std::uint64_t length = at.number(position + 2, 2);
        if (!at.well() || length < 2 || at.number(position, 1) != 0xFF) {
            header.truncated = true;
            return header;
        }
        const bool frame = marker >= 0xC0 && marker <= 0xCF && marker != 0xC4 && marker != 0xC8 && marker != 0xCC;
        if (frame) setSize(header, at.number(position + 7, 2), at.number(position + 5, 2));
        if (marker == 0xE1 && bytes.substr(position + 4, 6) == std::string_view("Exif\0\0", 6)) {
            readExif(header, bytes.substr(position + 10, length - 8));
        }
        if (marker == 0xDA) break;
        position += 2 + length;
    }
    header.truncated = bytes.find("\xFF\xD9", position) == std::string_view::npos;
    return header;
}

PictureHeader tiffHeader(std::string_view bytes) {
    PictureHeader header;
    header.kind = PictureHeader::Kind::tiff;
    const bool big = bytes.starts_with("MM");
    Bytes at(bytes, big);
    const std::uint64_t directory = at.number(4, 4);
    const auto width = tiffValue(bytes, big, directory, 256), height = tiffValue(bytes, big, directory, 257);
    if (width && height) {
        setSize(header, *width, *height);
    } else {
        header.truncated = true;  // the directory often stands at the end of the file
    }
    return header;
}

/// WebP: RIFF of VP8X (extended), VP8L (lossless) or VP8 (lossy).
PictureHeader webpHeader(std::string_view bytes) {
    PictureHeader header;
    header.kind = PictureHeader::Kind::webp;
    Bytes at(bytes, false);
    header.truncated = at.number(4, 4) + 8 > bytes.size();
    const std::string_view chunk = bytes.substr(12, 4);
    if (chunk == "VP8X") setSize(header, at.number(24, 3) + 1, at.number(27, 3) + 1);
    if (chunk == "VP8L") {
        const std::uint64_t packed = at.number(21, 4);
        setSize(header, (packed & 0x3FFF) + 1, (packed >> 14 & 0x3FFF) + 1);
    }
    if (chunk == "VP8 ") setSize(header, at.number(26, 2) & 0x3FFF, at.number(28, 2) & 0x3FFF);
    if (!at.well()) header.truncated = true;
    return header;
}

}  // namespace

std::optional<PictureHeader> pictureHeader(std::string_view bytes) {
    using namespace std::string_view_literals;
    if (bytes.starts_with("\x89PNG\r\n\x1A\n"sv)) return pngHeader(bytes);
    if (bytes.starts_with("\xFF\xD8\xFF"sv)) return jpegHeader(bytes);
    if (bytes.starts_with("II*\0"sv) || bytes.starts_with("MM\0*"sv)) return tiffHeader(bytes);
    if (bytes.starts_with("RIFF"sv) && bytes.size() >= 16 && bytes.substr(8, 4) == "WEBP") return webpHeader(bytes);
    return std::nullopt;
}

}  // namespace ilf::projects
