#include "projects/map_file.h"

#include <zlib.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <optional>

#include "projects/map_formats.h"
#include "projects/pictures.h"
#include "projects/safe_file.h"

namespace ilf::projects {
namespace {

constexpr std::size_t kMaxFactBytes = 1000;
constexpr std::size_t kMostOfMap = std::size_t{1} << 30;
constexpr float kFarthest = 1e6F;

bool plainKey(const std::string& key) {
    const auto plain = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '-'; };
    return !key.empty() && std::isalpha(static_cast<unsigned char>(key[0])) != 0 &&
           std::all_of(key.begin(), key.end(), plain);
}

Result<void> checkedFacts(const MapFacts& facts) {
    for (const auto& [key, value] : facts) {
        if (!plainKey(key)) return fail(Fault::cannotWrite, "A map's fact cannot be called \"" + key + "\".");
        if (value.size() > kMaxFactBytes) return fail(Fault::cannotWrite, "A map's fact \"" + key + "\" is too long.");
    }
    return {};
}

Result<std::string> gzipped(const std::string& plain) {
    z_stream stream{};
    if (deflateInit2(&stream, Z_DEFAULT_COMPRESSION, Z_DEFLATED, 15 + 16, 8, Z_DEFAULT_STRATEGY) != Z_OK) {
        return fail(Fault::cannotWrite, "The map could not be compressed.");
    }
    std::string packed(deflateBound(&stream, static_cast<uLong>(plain.size())), '\0');
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(plain.data()));
    stream.avail_in = static_cast<uInt>(plain.size());
    stream.next_out = reinterpret_cast<Bytef*>(packed.data());
    stream.avail_out = static_cast<uInt>(packed.size());
    const bool done = deflate(&stream, Z_FINISH) == Z_STREAM_END;
    packed.resize(stream.total_out);
    deflateEnd(&stream);
    if (!done) return fail(Fault::cannotWrite, "The map could not be compressed.");
    return packed;
}

Result<std::string> unzipped(std::string_view packed, const std::string& name) {
    z_stream stream{};
    if (inflateInit2(&stream, 15 + 16) != Z_OK) return fail(Fault::badFile, name + " could not be unpacked.");
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data()));
    stream.avail_in = static_cast<uInt>(packed.size());
    std::string plain;
    int state = Z_OK;
    while (state == Z_OK && plain.size() < kMostOfMap) {
        const std::size_t before = plain.size();
        plain.resize(before + (std::size_t{4} << 20));
        stream.next_out = reinterpret_cast<Bytef*>(plain.data() + before);
        stream.avail_out = static_cast<uInt>(plain.size() - before);
        state = inflate(&stream, Z_NO_FLUSH);
        plain.resize(plain.size() - stream.avail_out);
    }
    inflateEnd(&stream);
    if (state != Z_STREAM_END) {
        return fail(Fault::badFile, name + " is damaged: its compressed data end too early or make no sense.");
    }
    return plain;
}

std::string sized(Size size) { return std::to_string(size.width) + " x " + std::to_string(size.height); }

Result<void> checkedNumbers(const Image<float>& points, const char* what, const std::string& name) {
    for (int y = 0; y < points.height(); ++y) {
        const float* row = points.row(y);
        for (std::size_t i = 0; i < points.stride(); ++i) {
            if (std::abs(row[i]) <= kFarthest) continue;  // false for NaN
            const std::string where = std::to_string(i / 2) + ", " + std::to_string(y);
            return fail(Fault::badFile, name + ": " + what + " has no usable point at pixel (" + where +
                                            "). Scan again, or save the map again.");
        }
    }
    return {};
}

Result<MapFile> checkedMap(MapFile file, const std::string& name) {
    const DenseMap& map = file.map;
    const auto wrong = [&](const std::string& what) { return fail(Fault::badFile, name + " " + what); };
    for (const Image<float>* points : {&map.projectorOfCamera, &map.cameraOfProjector}) {
        if (points->width() < 2 || points->height() < 2) return wrong("is no map: it has less than 2 x 2 points.");
    }
    if (map.confidence.size() != map.camera()) {
        return wrong("does not fit together: confidence has " + sized(map.confidence.size()) + " pixels, the picture " +
                     sized(map.camera()) + ".");
    }
    if (map.seen.size() != map.projector()) {
        return wrong("does not fit together: seen has " + sized(map.seen.size()) + " pixels, the raster " +
                     sized(map.projector()) + ".");
    }
    if (auto good = checkedNumbers(map.projectorOfCamera, "projector_of_camera", name); !good) {
        return tl::unexpected(good.error());
    }
    if (auto good = checkedNumbers(map.cameraOfProjector, "camera_of_projector", name); !good) {
        return tl::unexpected(good.error());
    }
    const auto& m = map.nearest.m;
    const bool finite = std::all_of(m.begin(), m.end(), [](double v) { return std::isfinite(v); });
    if (!finite || !std::isnormal(map.nearest.determinant())) {
        return wrong("has a homography (projector_from_camera) that cannot be turned around.");
    }
    return file;
}

std::optional<MapFormat> formatOf(const fs::path& path) {
    std::string name = path.filename().string();
    std::transform(name.begin(), name.end(), name.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    const auto ends = [&](const char* with) { return name.ends_with(with); };
    if (ends(".yml") || ends(".yaml")) return MapFormat::yaml;
    if (ends(".yml.gz") || ends(".yaml.gz")) return MapFormat::gzippedYaml;
    if (ends(".exr")) return MapFormat::exr;
    return std::nullopt;
}

}  // namespace

Result<std::string> encodeMap(const DenseMap& map, const MapFacts& facts, MapFormat format) {
    if (auto good = checkedFacts(facts); !good) return tl::unexpected(good.error());
    switch (format) {
    case MapFormat::yaml:
        return mapAsYaml(map, facts);
    case MapFormat::gzippedYaml:
        return mapAsYaml(map, facts).and_then(gzipped);
    case MapFormat::exr:
        return mapAsExr(map, facts);
    }
    return fail(Fault::unsupported, "There is no such kind of map file.");
}

Result<MapFile> decodeMap(std::string_view bytes, const std::string& name) {
    const auto check = [&](MapFile file) { return checkedMap(std::move(file), name); };
    if (bytes.empty()) return fail(Fault::badFile, name + " is empty.");
    if (bytes.starts_with("\x76\x2f\x31\x01")) return mapFromExr(bytes, name).and_then(check);
    if (bytes.starts_with("\x1f\x8b")) {
        return unzipped(bytes, name)
            .and_then([&](const std::string& text) { return mapFromYaml(text, name); })
            .and_then(check);
    }
    return mapFromYaml(std::string(bytes), name).and_then(check);
}

Result<void> writeMap(const fs::path& path, const DenseMap& map, const MapFacts& facts) {
    const auto format = formatOf(path);
    if (!format) {
        return fail(Fault::cannotWrite,
                    spoken(path) +
                        " needs a name that ends in .yml, .yml.gz or .exr: maps are written as one of them.");
    }
    return encodeMap(map, facts, *format).and_then([&](const std::string& bytes) {
        return writeAtomically(path, bytes);
    });
}

Result<MapFile> readMap(const fs::path& path) {
    return readWhole(path, kMostOfMap).and_then([&](const std::string& bytes) {
        return decodeMap(bytes, spoken(path));
    });
}

}  // namespace ilf::projects
