#include "projects/depth_file.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <utility>
#include <vector>

#include "core/document/distance.h"
#include "projects/depth_formats.h"
#include "projects/json.h"
#include "projects/pictures.h"
#include "projects/safe_file.h"

namespace ilf::projects {

namespace {

constexpr std::size_t kMostOfDepth = std::size_t{1} << 30;
constexpr Metre kTumStep = 0.2_mm;

std::string sizeWords(Size size) { return std::to_string(size.width) + " x " + std::to_string(size.height); }

/// See `readDepth`.
Metre guessedStep(const Image<std::uint16_t>& raw) {
    constexpr std::uint16_t kFar = 10'000;
    std::size_t known = 0, far = 0;
    for (const std::uint16_t value : raw.pixels()) {
        known += value > 0;
        far += value > kFar;
    }
    return 20 * far > known ? kTumStep : 1.0_mm;
}

/// What is no distance becomes a hole.
Image<float> withHoles(const Image<float>& values) {
    std::vector<float> out(values.pixels().begin(), values.pixels().end());
    for (float& value : out) {
        if (!(std::isfinite(value) && value > 0.0F)) value = 0.0F;
    }
    return {values.size(), 1, std::move(out)};
}

/// The same pinhole at another resolution.
Pinhole scaled(const Pinhole& camera, Size size) {
    const double sx = static_cast<double>(size.width) / camera.size.width;
    const double sy = static_cast<double>(size.height) / camera.size.height;
    return {size, sx * camera.fx, sy * camera.fy, sx * camera.cx, sy * camera.cy, camera.distortion};
}

/// One view at two resolutions: the sides have the same proportion, to a pixel of the smaller.
bool sameView(Size a, Size b) {
    const double wide = static_cast<double>(a.width) * b.height, high = static_cast<double>(a.height) * b.width;
    return std::abs(wide - high) <= std::max(std::max(a.width, a.height), std::max(b.width, b.height));
}

/// Each pixel takes the value of the one it lies in: a mean across an edge would be a surface that is not there.
Image<float> resampled(const Image<float>& from, Size size) {
    if (from.empty() || from.size() == size) return from;
    std::vector<float> to;
    to.reserve(static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height));
    const auto source = [](int to_, int count, int of) {
        return static_cast<int>((2LL * to_ + 1) * of / (2LL * count));  // the pixel below the middle
    };
    for (int y = 0; y < size.height; ++y) {
        const float* row = from.row(source(y, size.height, from.height()));
        for (int x = 0; x < size.width; ++x)
            to.push_back(row[source(x, size.width, from.width())]);
    }
    return {size, 1, std::move(to)};
}

/// The file's values in metres, its step (0: none) and what had to be guessed.
struct Values {
    DepthPixels pixels;
    Metre step = 0.0_m;
    std::string note;
};

Result<Values> valuesOf(std::string_view bytes, const std::string& name, const DepthReading& reading) {
    const auto metric = [](DepthPixels pixels) { return Values{std::move(pixels), {}, {}}; };
    if (looksLikePfm(bytes)) return decodePfm(bytes, name).map(metric);
    if (looksLikeExr(bytes)) return decodeDepthExr(bytes, name).map(metric);
    auto raw = decodeDepth16(bytes, name);
    if (!raw) return tl::unexpected(raw.error());
    Values values;
    values.step = reading.step.value_or(guessedStep(*raw));
    if (!isFinite(values.step) || values.step < 1.0_um || values.step > 1.0_m) {
        return fail(Fault::outOfRange, "A step of the depth map must be 1 \u00b5m to 1 m.");
    }
    values.pixels.metres = depthOf(*raw, values.step).metres;
    if (!reading.step) {
        values.note = values.step == kTumStep
                          ? "One step was taken as 0.2 mm (1/5000 m), since 1 mm would put much of it beyond 10 m."
                          : "One step was taken as 1 mm, as most depth cameras write.";
    }
    return values;
}

}  // namespace

Result<DepthFile> decodeDepth(std::string_view bytes, const std::string& name, const DepthReading& reading) {
    auto values = valuesOf(bytes, name, reading);
    if (!values) return tl::unexpected(values.error());
    DepthFile file;
    file.note = values->note;
    const Size size = values->pixels.metres.size(), picture = reading.picture == Size{} ? size : reading.picture;
    const auto add = [&](const std::string& note) { file.note += (file.note.empty() ? "" : " ") + note; };
    if (size != picture) {
        const std::string both = name + " has " + sizeWords(size) + " pixels and the picture " + sizeWords(picture);
        if (!reading.intrinsics) {
            return fail(Fault::badFile, both + ": they must agree, or the camera's intrinsics must be given with it.");
        }
        if (!sameView(size, picture)) {
            return fail(Fault::badFile, both + ", in another proportion: it shows another view. Use the depth that was "
                                               "registered to this picture.");
        }
        add("It was resampled from " + sizeWords(size) + " to " + sizeWords(picture) + " pixels.");
    }
    MeasuredDepth& measured = file.measured;
    if (reading.intrinsics) {
        const Size known = reading.intrinsics->size;
        if (!sameView(known, picture)) {
            return fail(Fault::badFile, "The intrinsics are those of " + sizeWords(known) +
                                            " pixels and the picture "
                                            "has " +
                                            sizeWords(picture) +
                                            ", in another proportion: they are of another "
                                            "camera or mode.");
        }
        measured.camera = scaled(*reading.intrinsics, picture);
    } else {
        measured.camera = plainPinhole(picture, reading.focalPixels);
    }
    measured.metres = resampled(withHoles(values->pixels.metres), picture);
    if (!values->pixels.sigma.empty()) measured.sigma = resampled(withHoles(values->pixels.sigma), picture);
    measured.step = values->step;
    measured.source = name;
    measured.provenance = "measured";
    if (std::ranges::none_of(measured.metres.pixels(), [](float metres) { return metres > 0.0F; })) {
        return fail(Fault::badFile, name + " holds only holes: no pixel has a distance.");
    }
    return file;
}

Result<DepthFile> readDepth(const fs::path& path, const DepthReading& reading) {
    return readWhole(path, kMostOfDepth).and_then([&](const std::string& bytes) {
        return decodeDepth(bytes, spoken(path), reading);
    });
}

Result<Pinhole> readIntrinsics(const fs::path& path) {
    constexpr std::size_t kMostText = 1 << 20;
    const std::string file = spoken(path);
    const auto json =
        readWhole(path, kMostText).and_then([&](const std::string& text) { return Json::parse(text, file); });
    if (!json) return tl::unexpected(json.error());
    JsonReader whole(*json, file);
    JsonReader reader = whole.has("intrinsic") ? whole.object("intrinsic") : whole;
    Pinhole camera;
    camera.size = {reader.whole("width"), reader.whole("height")};
    const std::vector<double> m = reader.numbers("intrinsic_matrix", 9);
    std::vector<double> distortion(camera.distortion.size());
    if (reader.has("distortion")) distortion = reader.numbers("distortion", camera.distortion.size());
    if (reader.problem()) return tl::unexpected(*reader.problem());
    std::ranges::copy(distortion, camera.distortion.begin());
    camera.fx = m[0];
    camera.fy = m[4];
    camera.cx = m[6] + 0.5;
    camera.cy = m[7] + 0.5;
    if (camera.size.width <= 0 || camera.size.height <= 0 || !(camera.fx > 0.0) || !(camera.fy > 0.0)) {
        return fail(Fault::badFile, file + " holds no camera: width, height and both focal lengths must be more than "
                                           "0 (\"intrinsic_matrix\" column by column).");
    }
    return camera;
}

std::string intrinsicsText(const Pinhole& camera) {
    Json json;
    json.set("width", camera.size.width);
    json.set("height", camera.size.height);
    json.set("intrinsic_matrix",
             std::vector<double>{camera.fx, 0.0, 0.0, 0.0, camera.fy, 0.0, camera.cx - 0.5, camera.cy - 0.5, 1.0});
    if (camera.distortion != std::array<double, 5>{}) {
        json.set("distortion", std::vector<double>(camera.distortion.begin(), camera.distortion.end()));
    }
    return json.text();
}

Result<std::string> encodeDepthPng(const Image<float>& metres, Metre step) {
    std::vector<std::uint16_t> raw;
    raw.reserve(metres.pixels().size());
    for (const float value : metres.pixels()) {
        const double steps = std::round(static_cast<double>(value) / step.si());
        raw.push_back(steps >= 1.0 && steps <= 65535.0 ? static_cast<std::uint16_t>(steps) : std::uint16_t{0});
    }
    return encodePng16(Image<std::uint16_t>(metres.size(), 1, std::move(raw)));
}

Result<void> writeDepth(const fs::path& path, const MeasuredDepth& measured) {
    std::string ending = path.extension().string();
    std::ranges::transform(ending, ending.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    Result<std::string> bytes;
    if (ending == ".png") {
        bytes = encodeDepthPng(measured.metres, measured.step > 0.0_m ? measured.step : 0.1_mm);
    } else if (ending == ".pfm") {
        bytes = encodeDepthPfm(measured.metres);
    } else if (ending == ".exr") {
        bytes = encodeDepthExr(measured.metres, measured.sigma);
    } else {
        return fail(Fault::cannotWrite, spoken(path) + " must end in .png, .pfm or .exr to hold depth.");
    }
    return bytes.and_then([&](const std::string& whole) { return writeAtomically(path, whole); });
}

}  // namespace ilf::projects
