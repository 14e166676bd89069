#include "app/open.h"

#include <filesystem>
#include <fstream>

#include "devices/camera/video_file.h"
#include "projects/pictures.h"

namespace ilf::app {
namespace fs = std::filesystem;
namespace {

/// A new project over `black` has this many pixels until a picture is opened.
constexpr Size kBlankSize{1280, 800};

bool startsLikeArchive(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    char start[2] = {};
    return file.read(start, 2) && start[0] == 'P' && start[1] == 'K';
}

/// AVI, MP4 and MOV, Matroska and WebM, MPEG and Ogg by their first bytes. Pictures never start like this, so that a
/// truncated picture is not mistaken for a very short video.
bool startsLikeVideo(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    std::string start(12, '\0');
    file.read(start.data(), 12);
    const auto has = [&](std::size_t at, std::string_view text) { return start.compare(at, text.size(), text) == 0; };
    return (has(0, "RIFF") && has(8, "AVI ")) || has(4, "ftyp") || has(4, "moov") || has(4, "mdat") || has(0, "OggS") ||
           has(0, "\x1A\x45\xDF\xA3") || has(0, std::string_view("\0\0\1\xBA", 4)) ||
           has(0, std::string_view("\0\0\1\xB3", 4));
}

Scene sceneOf(Picture picture, const fs::path& path, std::optional<double> focal) {
    Scene scene;
    scene.source = path.filename().string();
    scene.scale = focal ? PixelScale{*focal, PixelScale::Source::exif}
                        : PixelScale{focalPixels(picture.width(), kDefaultFieldOfView), PixelScale::Source::assumed};
    scene.picture = Box(std::move(picture));
    return scene;
}

}  // namespace

Result<OpenedScene> openScene(const std::string& path, const projects::ProjectExtras& extras) {
    auto picture = projects::readPicture(path);
    if (picture) {
        OpenedScene opened;
        opened.extras = extras.withOriginal(*picture);
        opened.note = picture->note;
        opened.scene = sceneOf(std::move(picture->picture), path, picture->focalPixels);
        return opened;
    }
    if (!startsLikeVideo(path)) return tl::unexpected(picture.error());
    auto frame = devices::firstFrame(path);
    if (!frame) return tl::unexpected(frame.error());
    OpenedScene opened;
    opened.extras = extras;
    opened.videoPath = path;
    opened.scene = sceneOf(*std::move(frame), path, std::nullopt);
    return opened;
}

Result<OpenedFile> openAny(const std::string& path) {
    std::error_code error;
    const bool project =
        fs::is_directory(path, error) || fs::path(path).filename() == "project.json" || startsLikeArchive(path);
    OpenedFile opened;
    if (project) {
        auto found = projects::openProject(path);
        if (!found) return tl::unexpected(found.error());
        opened.document = std::move(found->document);
        opened.extras = std::move(found->extras);
        opened.projectPath = fs::path(path).filename() == "project.json" ? fs::path(path).parent_path().string() : path;
        return opened;
    }
    auto scene = openScene(path);
    if (!scene) return tl::unexpected(scene.error());
    opened.document = newDocument(std::move(scene->scene));
    opened.document.name = fs::path(path).stem().string();
    opened.extras = std::move(scene->extras);
    opened.videoPath = std::move(scene->videoPath);
    opened.note = std::move(scene->note);
    return opened;
}

OpenedFile blankProject() {
    Scene scene;
    const auto pixels = static_cast<std::size_t>(kBlankSize.width) * static_cast<std::size_t>(kBlankSize.height) * 3;
    scene.picture = Box(Picture(kBlankSize, 3, std::vector<std::uint16_t>(pixels)));
    scene.source = "empty";
    scene.scale = {focalPixels(kBlankSize.width, kDefaultFieldOfView), PixelScale::Source::assumed};
    OpenedFile opened;
    opened.document = newDocument(std::move(scene));
    return opened;
}

}  // namespace ilf::app
