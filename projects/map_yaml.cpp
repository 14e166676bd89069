#include <algorithm>
#include <opencv2/core.hpp>
#include <opencv2/core/persistence.hpp>
#include <vector>

#include "projects/map_formats.h"
#include "projects/pictures.h"

namespace ilf::projects {
namespace {

const char* const kMapFormat = "illuminatedfocus-map";
constexpr int kVersion = 1;
const char* const kConvention = "pixel (i, j) has its centre at (i + 0.5, j + 0.5)";

template <class T>
cv::Mat matrixOf(const Image<T>& image) {
    auto* pixels = const_cast<T*>(image.pixels().data());  // FileStorage reads, and never writes, what it saves
    return {image.height(), image.width(), CV_MAKETYPE(cv::DataType<T>::depth, image.channels()), pixels};
}

template <class T>
Result<Image<T>> imageFrom(const cv::FileStorage& file, const char* key, int channels, const std::string& name) {
    cv::Mat matrix;
    file[key] >> matrix;
    if (matrix.empty()) {
        return fail(Fault::badFile, name + " has no \"" + key + "\": it is no scanned map, or not a whole one.");
    }
    const bool fits = matrix.dims == 2 && matrix.type() == CV_MAKETYPE(cv::DataType<T>::depth, channels) &&
                      static_cast<std::int64_t>(matrix.total()) <= kMaxPixels;
    if (!fits) return fail(Fault::badFile, name + ": \"" + key + "\" is a matrix of another kind than a map has.");
    const cv::Mat whole = matrix.isContinuous() ? matrix : matrix.clone();
    const T* first = whole.ptr<T>();
    return Image<T>({whole.cols, whole.rows}, channels,
                    std::vector<T>(first, first + whole.total() * static_cast<std::size_t>(channels)));
}

Result<MapFile> read(const cv::FileStorage& file, const std::string& name) {
    if (static_cast<std::string>(file["format"]) != kMapFormat) {
        return fail(Fault::badFile, name + " is no scanned map: its \"format\" is not " + kMapFormat + ".");
    }
    if (static_cast<int>(file["version"]) > kVersion) {
        return fail(Fault::badFile, name + " was written by a newer version. Update this program, or scan again.");
    }
    MapFile result;
    auto forth = imageFrom<float>(file, "projector_of_camera", 2, name);
    if (!forth) return tl::unexpected(forth.error());
    auto sure = imageFrom<std::uint8_t>(file, "confidence", 1, name);
    if (!sure) return tl::unexpected(sure.error());
    auto back = imageFrom<float>(file, "camera_of_projector", 2, name);
    if (!back) return tl::unexpected(back.error());
    auto seen = imageFrom<std::uint8_t>(file, "seen", 1, name);
    if (!seen) return tl::unexpected(seen.error());
    const auto plane = imageFrom<double>(file, "projector_from_camera", 1, name);
    if (!plane) return tl::unexpected(plane.error());
    if (plane->size() != Size{3, 3}) return fail(Fault::badFile, name + ": \"projector_from_camera\" is not 3 x 3.");
    result.map = {*std::move(forth), *std::move(sure), *std::move(back), *std::move(seen), {}};
    std::copy(plane->pixels().begin(), plane->pixels().end(), result.map.nearest.m.begin());
    const cv::FileNode facts = file["facts"];
    for (const cv::FileNode& fact : facts)
        if (fact.isString()) result.facts[fact.name()] = static_cast<std::string>(fact);
    return result;
}

}  // namespace

Result<std::string> mapAsYaml(const DenseMap& map, const MapFacts& facts) {
    try {
        using Storage = cv::FileStorage;
        Storage file("map.yml", Storage::WRITE | Storage::MEMORY | Storage::FORMAT_YAML | Storage::BASE64);
        file << "format" << kMapFormat << "version" << kVersion << "convention" << kConvention;
        file << "facts"
             << "{";
        for (const auto& [key, value] : facts)
            file << key << value;
        file << "}";
        const cv::Mat plane(3, 3, CV_64F, const_cast<double*>(map.nearest.m.data()));
        file << "projector_from_camera" << plane;
        file << "projector_of_camera" << matrixOf(map.projectorOfCamera) << "confidence" << matrixOf(map.confidence);
        file << "camera_of_projector" << matrixOf(map.cameraOfProjector) << "seen" << matrixOf(map.seen);
        return file.releaseAndGetString();
    } catch (const cv::Exception& e) {
        return fail(Fault::cannotWrite, "The map could not be written as YAML: " + e.err + ".");
    }
}

Result<MapFile> mapFromYaml(const std::string& text, const std::string& name) {
    // Anything but YAML of OpenCV's would be tried as XML or JSON, too.
    if (!text.starts_with("%YAML")) {
        return fail(Fault::badFile, name + " is no scanned map: it is neither YAML of OpenCV's kind nor OpenEXR.");
    }
    try {
        const cv::FileStorage file(text, cv::FileStorage::READ | cv::FileStorage::MEMORY);
        if (!file.isOpened()) return fail(Fault::badFile, name + " cannot be read as YAML.");
        return read(file, name);
    } catch (const std::exception&) {  // of OpenCV's reader, or out of memory for a size that is claimed
        return fail(Fault::badFile, name + " is damaged: it cannot be read as YAML of OpenCV's kind.");
    }
}

}  // namespace ilf::projects
