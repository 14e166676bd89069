#include "projects/picture_export.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "core/base/srgb.h"
#include "projects/picture_exr.h"
#include "projects/picture_png_texts.h"
#include "projects/picture_tiff.h"
#include "projects/pictures.h"
#include "projects/safe_file.h"

namespace ilf::projects {
namespace {

template <class To, class From, class Map>
Image<To> mapped(const Image<From>& image, const Map& map) {
    std::vector<To> pixels(image.pixels().size());
    std::transform(image.pixels().begin(), image.pixels().end(), pixels.begin(), map);
    return Image<To>(image.size(), image.channels(), std::move(pixels));
}

/// A share of the highest code; NaN is 0.
std::uint16_t code16(double share) {
    return static_cast<std::uint16_t>(share > 0.0 ? std::lround(65535.0 * std::min(share, 1.0)) : 0);
}

const Radiance& imageOf(const LightPicture& picture) { return picture.linear; }
const Picture& imageOf(const CodePicture& picture) { return picture.codes; }
const Radiance& imageOf(const DifferencePicture& picture) { return picture.difference; }

struct Codes {
    Picture codes;
    bool srgb;
};

Codes codesOf(const LightPicture& picture) {
    return {
        mapped<std::uint16_t>(picture.linear,
                              [](float v) { return code16(v > 0.0F ? srgbFromLinear(static_cast<double>(v)) : 0.0); }),
        true};
}
Codes codesOf(const CodePicture& picture) { return {picture.codes, picture.srgb}; }
Codes codesOf(const DifferencePicture& picture) {
    return {mapped<std::uint16_t>(picture.difference,
                                  [&](float v) { return code16(std::abs(static_cast<double>(v)) / picture.white); }),
            false};
}

Radiance valuesOf(const LightPicture& picture) { return picture.linear; }
Radiance valuesOf(const CodePicture& picture) {
    if (picture.srgb) return toLinear(picture.codes);
    return mapped<float>(picture.codes, [](std::uint16_t v) { return static_cast<float>(v) / 65535.0F; });
}
Radiance valuesOf(const DifferencePicture& picture) { return picture.difference; }

/// Straight to 8 bits where there is light: rounded once.
Image<std::uint8_t> bytesOf(const ExportPixels& pixels, const Codes& codes) {
    const auto* light = std::get_if<LightPicture>(&pixels);
    return light != nullptr ? toSrgb8(light->linear) : toBytes(codes.codes);
}

PictureFacts withEncoding(PictureFacts facts, const char* encoding) {
    facts.emplace_back("encoding", encoding);
    return facts;
}

}  // namespace

Result<PictureFormat> pictureFormat(const std::filesystem::path& path) {
    std::string end = path.extension().string();
    std::transform(end.begin(), end.end(), end.begin(),
                   [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
    if (end == ".png") return PictureFormat::png;
    if (end == ".tif" || end == ".tiff") return PictureFormat::tiff;
    if (end == ".exr") return PictureFormat::exr;
    return fail(Fault::unsupported, spoken(path) + " does not end as a picture that can be written: use .png (8 bits), "
                                                   ".tif or .tiff (16 bits) or .exr (linear light).");
}

const char* ending(PictureFormat format) {
    switch (format) {
    case PictureFormat::png:
        return ".png";
    case PictureFormat::tiff:
        return ".tiff";
    case PictureFormat::exr:
        return ".exr";
    }
    return "";
}

Size sizeOf(const ExportPixels& pixels) {
    return std::visit([](const auto& picture) { return imageOf(picture).size(); }, pixels);
}

Result<std::string> encodedExport(const ExportPixels& pixels, const PictureFacts& facts, PictureFormat format,
                                  ExrDepth depth) {
    const bool empty = std::visit([](const auto& picture) { return imageOf(picture).pixels().empty(); }, pixels);
    if (empty) return fail(Fault::cannotWrite, "A picture without pixels cannot be written.");
    if (format == PictureFormat::exr) {
        const Radiance values = std::visit([](const auto& picture) { return valuesOf(picture); }, pixels);
        return encodeExr(values, withEncoding(facts, "linear"), depth);
    }
    const Codes codes = std::visit([](const auto& picture) { return codesOf(picture); }, pixels);
    const PictureFacts all = withEncoding(facts, codes.srgb ? "sRGB" : "linear");
    if (format == PictureFormat::tiff) return encodeTiff16(codes.codes, all, codes.srgb);
    return encodePng(bytesOf(pixels, codes)).map([&](const std::string& png) {
        return withFacts(png, all, codes.srgb);
    });
}

Result<void> writeExport(const std::filesystem::path& path, const ExportPixels& pixels, const PictureFacts& facts,
                         PictureFormat format, ExrDepth depth) {
    return encodedExport(pixels, facts, format, depth).and_then([&](const std::string& bytes) {
        return writeAtomically(path, bytes);
    });
}

}  // namespace ilf::projects
