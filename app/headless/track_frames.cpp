#include "app/headless/track_frames.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <memory>
#include <vector>

#include "core/base/srgb.h"
#include "devices/camera/video_file.h"
#include "devices/emulated_scene/emulated_camera.h"
#include "devices/emulated_scene/marker_film.h"
#include "projects/pictures.h"

namespace ilf::app {
namespace {

namespace fs = std::filesystem;
using Next = Result<std::optional<devices::Frame>>;

Result<TrackFrames> emulated(const TrackOptions& options) {
    const auto colon = options.source.find(':');
    const auto wish =
        devices::sceneWishFrom(colon == std::string::npos ? std::string() : options.source.substr(colon + 1));
    if (!wish) return tl::unexpected(wish.error());
    auto made = devices::MarkerFilm::of(*wish);
    if (!made) return tl::unexpected(made.error());
    const std::shared_ptr<const devices::MarkerFilm> film = *std::move(made);
    TrackFrames frames;
    frames.next = [film, options, number = 0]() mutable -> Next {
        const Second time = Second::fromSi(number / options.rate_Hz);
        if (time.si() > options.seconds) return std::optional<devices::Frame>();
        return film->at(time, static_cast<std::uint64_t>(++number));
    };
    frames.truth = [film](Second time) { return film->truth(time); };
    return frames;
}

Result<TrackFrames> folder(const TrackOptions& options) {
    std::vector<fs::path> files;
    std::error_code error;
    for (const auto& entry : fs::directory_iterator(options.source, error)) {
        auto extension = entry.path().extension().string();
        std::ranges::transform(extension, extension.begin(),
                               [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
        if (extension == ".png" || extension == ".jpg" || extension == ".jpeg" || extension == ".tif" ||
            extension == ".tiff")
            files.push_back(entry.path());
    }
    if (files.empty())
        return fail(Fault::notFound,
                    "There are no pictures (.png, .jpg, .tif) in \"" + options.source + "\" to follow anything in.");
    std::ranges::sort(files);
    TrackFrames frames;
    frames.next = [files, rate = options.rate_Hz, i = std::size_t{0}]() mutable -> Next {
        if (i == files.size()) return std::optional<devices::Frame>();
        const auto file = projects::readPicture(files[i]);
        if (!file) return tl::unexpected(file.error());
        const Second time = Second::fromSi(static_cast<double>(i) / rate);
        return devices::Frame{toBytes(file->picture), time, ++i, 0.0};
    };
    return frames;
}

Result<TrackFrames> video(const TrackOptions& options) {
    auto opened = devices::openVideoFile(options.source);
    if (!opened) return tl::unexpected(opened.error());
    const std::shared_ptr<devices::CameraSource> source = *std::move(opened);
    TrackFrames frames;
    frames.next = [source, began = std::optional<Second>()]() mutable -> Next {
        auto frame = source->read();
        if (!frame || !*frame) return frame;
        if (!began) began = (*frame)->time;
        (*frame)->time = (*frame)->time - *began;
        return frame;
    };
    return frames;
}

}  // namespace

Result<TrackFrames> trackFrames(const TrackOptions& options) {
    if (devices::isEmulatedCamera(options.source)) return emulated(options);
    std::error_code error;
    if (fs::is_directory(options.source, error)) return folder(options);
    return video(options);
}

}  // namespace ilf::app
