// Scanned maps in files that other programs read as well: OpenCV YAML or OpenEXR.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>

#include "core/base/result.h"
#include "core/registration/registration.h"

namespace ilf::projects {

/// What is known of a map besides its numbers, for whoever finds the file. Keys: letters, digits, '-' and '_', the
/// first a letter; values: at most 1000 bytes.
using MapFacts = std::map<std::string, std::string>;

/// Of a registration: when, with which devices, how good.
MapFacts factsOf(const Registration& registration);

struct MapFile {
    DenseMap map;
    MapFacts facts;
};

enum class MapFormat {
    yaml,         ///< cv::FileStorage reads its matrices, kept as Base64
    gzippedYaml,  ///< the same, compressed
    exr,          ///< two parts: "projector_of_camera" (X, Y, confidence) and "camera_of_projector" (X, Y, seen)
};

/// Names in both kinds of file: projector_of_camera (x, y on the raster), confidence, camera_of_projector (x, y in the
/// picture), seen, projector_from_camera (the homography, 3 x 3). Coordinates are this program's: pixel (i, j) has its
/// centre at (i + 0.5, j + 0.5); subtract 0.5 for OpenCV.
Result<std::string> encodeMap(const DenseMap& map, const MapFacts& facts, MapFormat format);
/// Told by content; `name` is for the sentences. Refused with a sentence: another kind of file, damaged, a matrix that
/// is missing or has another size or type, numbers that are not finite or farther than a million pixels away.
Result<MapFile> decodeMap(std::string_view bytes, const std::string& name);

/// Written atomically; the name says how: .yml, .yaml, .yml.gz, .yaml.gz or .exr.
Result<void> writeMap(const std::filesystem::path& path, const DenseMap& map, const MapFacts& facts = {});
Result<MapFile> readMap(const std::filesystem::path& path);

}  // namespace ilf::projects
