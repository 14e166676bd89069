#include "projects/picture_tiff.h"

#include <tiffio.h>

#include <algorithm>
#include <array>
#include <cstdarg>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <memory>
#include <vector>

#include "projects/picture_icc.h"

namespace ilf::projects {
namespace {

/// A file in memory, so that it can be put in place as a whole. libtiff reads its own directory back.
struct Bytes {
    std::string content;
    std::size_t at = 0;
};
Bytes& of(thandle_t handle) { return *static_cast<Bytes*>(handle); }

tmsize_t readBack(thandle_t handle, void* to, tmsize_t size) {
    Bytes& file = of(handle);
    const std::size_t left = file.content.size() - std::min(file.at, file.content.size());
    const std::size_t count = std::min(static_cast<std::size_t>(size), left);
    std::memcpy(to, file.content.data() + file.at, count);
    file.at += count;
    return static_cast<tmsize_t>(count);
}
tmsize_t write(thandle_t handle, void* from, tmsize_t size) {
    Bytes& file = of(handle);
    const auto count = static_cast<std::size_t>(size);
    file.content.resize(std::max(file.content.size(), file.at + count));
    std::memcpy(file.content.data() + file.at, from, count);
    file.at += count;
    return size;
}
toff_t seek(thandle_t handle, toff_t offset, int whence) {
    Bytes& file = of(handle);
    const std::size_t from = whence == SEEK_SET ? 0 : whence == SEEK_CUR ? file.at : file.content.size();
    file.at = from + static_cast<std::size_t>(offset);
    return file.at;
}
int close(thandle_t) { return 0; }
toff_t sizeOf(thandle_t handle) { return of(handle).content.size(); }

/// Keeps what libtiff complains of, instead of it going to standard error.
int keep(TIFF*, void* complaint, const char*, const char* format, va_list values) {
    std::array<char, 300> text{};
    std::vsnprintf(text.data(), text.size(), format, values);
    *static_cast<std::string*>(complaint) = text.data();
    return 1;
}

std::string described(const PictureFacts& facts) {
    std::string text;
    for (const auto& [key, value] : facts)
        text += (text.empty() ? "" : "; ") + key + ": " + value;
    return text;
}

bool allWritten(TIFF* tiff, const Picture& codes, const PictureFacts& facts, bool srgb) {
    const int channels = codes.channels();
    bool good =
        TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, codes.width()) == 1 &&
        TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, codes.height()) == 1 &&
        TIFFSetField(tiff, TIFFTAG_SAMPLESPERPIXEL, channels) == 1 &&
        TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, 16) == 1 &&
        TIFFSetField(tiff, TIFFTAG_SAMPLEFORMAT, SAMPLEFORMAT_UINT) == 1 &&
        TIFFSetField(tiff, TIFFTAG_ORIENTATION, ORIENTATION_TOPLEFT) == 1 &&
        TIFFSetField(tiff, TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG) == 1 &&
        TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, channels == 3 ? PHOTOMETRIC_RGB : PHOTOMETRIC_MINISBLACK) == 1 &&
        TIFFSetField(tiff, TIFFTAG_COMPRESSION, COMPRESSION_ADOBE_DEFLATE) == 1 &&
        TIFFSetField(tiff, TIFFTAG_PREDICTOR, PREDICTOR_HORIZONTAL) == 1 &&
        TIFFSetField(tiff, TIFFTAG_ROWSPERSTRIP, TIFFDefaultStripSize(tiff, 0)) == 1 &&
        TIFFSetField(tiff, TIFFTAG_IMAGEDESCRIPTION, described(facts).c_str()) == 1;
    if (srgb && channels == 3) {
        const std::string profile = srgbProfile();
        good = good &&
               TIFFSetField(tiff, TIFFTAG_ICCPROFILE, static_cast<std::uint32_t>(profile.size()), profile.data()) == 1;
    }
    std::vector<std::uint16_t> row;  // the predictor works in place
    for (int y = 0; good && y < codes.height(); ++y) {
        row.assign(codes.row(y), codes.row(y) + codes.stride());
        good = TIFFWriteScanline(tiff, row.data(), static_cast<std::uint32_t>(y)) == 1;
    }
    return good && TIFFFlush(tiff) == 1;
}

}  // namespace

Result<std::string> encodeTiff16(const Picture& codes, const PictureFacts& facts, bool srgb) {
    Bytes bytes;
    std::string complaint;
    const std::unique_ptr<TIFFOpenOptions, decltype(&TIFFOpenOptionsFree)> options(TIFFOpenOptionsAlloc(),
                                                                                   TIFFOpenOptionsFree);
    if (options) {
        TIFFOpenOptionsSetErrorHandlerExtR(options.get(), keep, &complaint);
        TIFFOpenOptionsSetWarningHandlerExtR(options.get(), keep, &complaint);
        TIFF* tiff = TIFFClientOpenExt("TIFF", "w", &bytes, readBack, write, seek, close, sizeOf, nullptr, nullptr,
                                       options.get());
        const bool good = tiff != nullptr && allWritten(tiff, codes, facts, srgb);
        if (tiff != nullptr) TIFFClose(tiff);
        if (good) return std::move(bytes.content);
    }
    return fail(Fault::cannotWrite, "The picture could not be encoded as TIFF" +
                                        (complaint.empty() ? std::string() : ": " + complaint) + ".");
}

}  // namespace ilf::projects
