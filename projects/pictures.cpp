#include "projects/pictures.h"

#include <cmath>
#include <cstdlib>
#include <exception>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <utility>
#include <vector>

#include "projects/picture_header.h"
#include "projects/safe_file.h"

namespace ilf::projects {
namespace {

/// A file this large is not decoded; 100 megapixels of 16-bit RGB take 600 MB uncompressed.
constexpr std::size_t kMaxFileBytes = std::size_t{1} << 30;

/// OpenCV reads its limit from the environment when it is first used: a second guard behind our own look at the header.
void limitDecoder() {
    static const bool set = [] { return setenv("OPENCV_IO_MAX_IMAGE_PIXELS", "100000000", 1) == 0; }();
    static_cast<void>(set);
}

struct Decoded {
    cv::Mat mat;  ///< 8 or 16 bits, 1, 3 (BGR) or 4 (BGRA) channels, as stored
    PictureHeader header;
};

Result<Decoded> decoded(std::string_view bytes, const std::string& name) {
    if (bytes.empty()) return fail(Fault::badFile, name + " is empty: 0 bytes.");
    const auto header = pictureHeader(bytes);
    if (!header) {
        return fail(Fault::badFile, name + " is not a picture that can be read. Use PNG, JPEG, TIFF or WebP.");
    }
    if (header->tooLarge) {
        return fail(Fault::badFile, name + " says it has more than 100 megapixels. Scale it down and try again.");
    }
    const std::string cut = name + " is damaged or cut short. Copy it again from where it came from.";
    if (header->truncated || (header->size && (header->size->width < 1 || header->size->height < 1))) {
        return fail(Fault::badFile, cut);
    }
    try {
        limitDecoder();
        const cv::Mat raw(1, static_cast<int>(bytes.size()), CV_8UC1, const_cast<char*>(bytes.data()));
        cv::Mat mat = cv::imdecode(raw, cv::IMREAD_UNCHANGED);
        if (mat.empty()) return fail(Fault::badFile, cut);
        if (mat.depth() != CV_8U && mat.depth() != CV_16U) {
            return fail(Fault::unsupported,
                        name + " holds floating-point or signed values. Save it with 8 or 16 bits.");
        }
        return Decoded{std::move(mat), *header};
    } catch (const std::exception&) {
        return fail(Fault::badFile, cut);
    }
}

/// As shown, from as stored (EXIF orientation 1..8).
cv::Mat upright(const cv::Mat& stored, int orientation) {
    cv::Mat turned = stored;
    if (orientation >= 5) cv::transpose(stored, turned);
    const bool flipX = orientation == 2 || orientation == 3 || orientation == 6 || orientation == 7;
    const bool flipY = orientation == 3 || orientation == 4 || orientation == 7 || orientation == 8;
    if (!flipX && !flipY) return turned;
    cv::Mat flipped;
    cv::flip(turned, flipped, flipX && flipY ? -1 : flipX ? 1 : 0);
    return flipped;
}

/// Laid over black: colour times coverage, in the encoded values, as viewers do it.
cv::Mat overBlack(const cv::Mat& bgra, bool& transparent) {
    const double full = bgra.depth() == CV_8U ? 255.0 : 65535.0;
    std::vector<cv::Mat> planes;
    cv::split(bgra, planes);
    double least = full;
    cv::minMaxLoc(planes[3], &least, nullptr);
    transparent = least < full;
    if (transparent) {
        for (std::size_t i = 0; i < 3; ++i)
            cv::multiply(planes[i], planes[3], planes[i], 1.0 / full);
    }
    planes.pop_back();
    cv::Mat bgr;
    cv::merge(planes, bgr);
    return bgr;
}

template <class T>
Image<T> imageOf(const cv::Mat& mat) {
    std::vector<T> pixels;
    const auto rowLength = static_cast<std::size_t>(mat.cols) * static_cast<std::size_t>(mat.channels());
    pixels.reserve(rowLength * static_cast<std::size_t>(mat.rows));
    for (int y = 0; y < mat.rows; ++y)
        pixels.insert(pixels.end(), mat.ptr<T>(y), mat.ptr<T>(y) + rowLength);
    return Image<T>({mat.cols, mat.rows}, mat.channels(), std::move(pixels));
}

std::string extensionOf(PictureHeader::Kind kind) {
    switch (kind) {
    case PictureHeader::Kind::png:
        return ".png";
    case PictureHeader::Kind::jpeg:
        return ".jpg";
    case PictureHeader::Kind::tiff:
        return ".tiff";
    case PictureHeader::Kind::webp:
        return ".webp";
    }
    return ".png";
}

/// The 35 mm equivalent is defined by the diagonal of the picture (CIPA DCG-001): that of 36 mm x 24 mm is 43.27 mm.
double focalPixelsOf(double focal35, Size size) {
    return focal35 * std::hypot(size.width, size.height) / std::hypot(36.0, 24.0);
}

template <class T>
Result<std::string> encoded(const Image<T>& image, int depth) {
    if (image.empty() || image.width() < 1 || image.height() < 1) {
        return fail(Fault::cannotWrite, "A picture without pixels cannot be written.");
    }
    try {
        cv::Mat mat(image.height(), image.width(), CV_MAKETYPE(depth, image.channels()),
                    const_cast<T*>(image.pixels().data()));
        cv::Mat turned;
        if (image.channels() == 3) cv::cvtColor(mat, turned, cv::COLOR_RGB2BGR);
        if (image.channels() == 4) cv::cvtColor(mat, turned, cv::COLOR_RGBA2BGRA);
        std::vector<std::uint8_t> bytes;
        // Level 3 is three times as fast as the default for 5 % more bytes.
        if (cv::imencode(".png", turned.empty() ? mat : turned, bytes, {cv::IMWRITE_PNG_COMPRESSION, 3})) {
            return std::string(bytes.begin(), bytes.end());
        }
    } catch (const std::exception&) {  // told below
    }
    return fail(Fault::cannotWrite, "The picture could not be encoded as PNG.");
}

/// What `read` gives for the bytes of a file.
template <class Read>
auto fromFile(const std::filesystem::path& path, const Read& read) {
    return readWhole(path, kMaxFileBytes).and_then([&](std::string bytes) {
        return read(std::move(bytes), spoken(path));
    });
}

}  // namespace

Result<PictureFile> decodePicture(Box<std::string> bytes, const std::string& name) {
    auto file = decoded(*bytes, name);
    if (!file) return tl::unexpected(file.error());
    PictureFile result;
    try {
        cv::Mat mat = upright(file->mat, file->header.orientation);
        bool transparent = false;
        if (mat.channels() == 4) mat = overBlack(mat, transparent);
        if (transparent) result.note = "Its transparency was laid over black.";
        if (mat.depth() == CV_8U) {
            cv::Mat wide;
            mat.convertTo(wide, CV_16U, 257.0);
            mat = wide;
        }
        cv::Mat rgb;
        if (mat.channels() == 1) {
            cv::cvtColor(mat, rgb, cv::COLOR_GRAY2RGB);
        } else if (mat.channels() == 3) {
            cv::cvtColor(mat, rgb, cv::COLOR_BGR2RGB);
        } else {
            return fail(Fault::unsupported, name + " has " + std::to_string(mat.channels()) +
                                                " channels. Save it as grey, RGB or RGB with transparency.");
        }
        result.picture = imageOf<std::uint16_t>(rgb);
    } catch (const std::exception&) {
        return fail(Fault::badFile, name + " could not be converted; there may not be enough memory for it.");
    }
    if (file->header.focal35) result.focalPixels = focalPixelsOf(*file->header.focal35, result.picture.size());
    result.extension = extensionOf(file->header.kind);
    result.bytes = std::move(bytes);
    return result;
}

Result<PictureFile> readPicture(const std::filesystem::path& path) {
    return fromFile(path, [](std::string bytes, const std::string& name) {
        return decodePicture(Box<std::string>(std::move(bytes)), name);
    });
}

Result<Image<std::uint8_t>> decodeMask(std::string_view bytes, const std::string& name) {
    auto file = decoded(bytes, name);
    if (!file) return tl::unexpected(file.error());
    try {
        cv::Mat grey = file->mat;
        if (grey.channels() == 4) cv::cvtColor(file->mat, grey, cv::COLOR_BGRA2GRAY);
        if (grey.channels() == 3) cv::cvtColor(file->mat, grey, cv::COLOR_BGR2GRAY);
        cv::Mat bytes8 = grey;
        if (grey.depth() == CV_16U) grey.convertTo(bytes8, CV_8U, 1.0 / 257.0);
        return imageOf<std::uint8_t>(bytes8);
    } catch (const std::exception&) {
        return fail(Fault::badFile, name + " could not be turned into a mask.");
    }
}

Result<Image<std::uint8_t>> readMask(const std::filesystem::path& path) {
    return fromFile(path, [](const std::string& bytes, const std::string& name) { return decodeMask(bytes, name); });
}

Result<Image<std::uint16_t>> decodeDepth16(std::string_view bytes, const std::string& name) {
    auto file = decoded(bytes, name);
    if (!file) return tl::unexpected(file.error());
    if (file->mat.type() != CV_16UC1) {
        return fail(Fault::badFile, name + " is no depth map: it must be a PNG or TIFF of one channel with 16 bits.");
    }
    return imageOf<std::uint16_t>(file->mat);
}

Result<Image<std::uint16_t>> readDepth16(const std::filesystem::path& path) {
    return fromFile(path, [](const std::string& bytes, const std::string& name) { return decodeDepth16(bytes, name); });
}

Result<std::string> encodePng(const Image<std::uint8_t>& image) { return encoded(image, CV_8U); }
Result<std::string> encodePng16(const Image<std::uint16_t>& image) { return encoded(image, CV_16U); }

Result<std::string> encodePicture(const Picture& picture) {
    std::vector<std::uint8_t> bytes;
    bytes.reserve(picture.pixels().size());
    for (const std::uint16_t v : picture.pixels()) {
        if (v % 257 != 0) return encodePng16(picture);
        bytes.push_back(static_cast<std::uint8_t>(v / 257));
    }
    return encodePng(Image<std::uint8_t>(picture.size(), picture.channels(), std::move(bytes)));
}

Result<void> writePng(const std::filesystem::path& path, const Image<std::uint8_t>& image) {
    return encodePng(image).and_then([&](const std::string& bytes) { return writeAtomically(path, bytes); });
}
Result<void> writePng16(const std::filesystem::path& path, const Image<std::uint16_t>& image) {
    return encodePng16(image).and_then([&](const std::string& bytes) { return writeAtomically(path, bytes); });
}

}  // namespace ilf::projects
