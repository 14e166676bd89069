#include "projects/scan_folder.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cstdint>
#include <utility>

#include "core/base/parallel.h"
#include "projects/file_tree.h"
#include "projects/json.h"
#include "projects/pictures.h"
#include "projects/safe_file.h"

namespace ilf::projects {

namespace {

const char* const kManifest = "scan.json";
const char* const kScanFormat = "illuminatedfocus-scan";
constexpr int kVersion = 1;
constexpr Size kUsualProjector{1024, 768};
constexpr int kMostSide = 16384;

struct Wanted {
    fs::path file;
    Pattern pattern;
};

bool digit(char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; }

/// Numbers inside names count as numbers: shot_2 comes before shot_10.
bool namedBefore(const std::string& a, const std::string& b) {
    std::size_t i = 0, j = 0;
    while (i < a.size() && j < b.size()) {
        if (digit(a[i]) && digit(b[j])) {
            std::size_t endA = i, endB = j;
            while (endA < a.size() && digit(a[endA]))
                ++endA;
            while (endB < b.size() && digit(b[endB]))
                ++endB;
            while (i < endA && a[i] == '0')
                ++i;
            while (j < endB && b[j] == '0')
                ++j;
            if (endA - i != endB - j) return endA - i < endB - j;
            const int order = a.compare(i, endA - i, b, j, endB - j);
            if (order != 0) return order < 0;
            i = endA, j = endB;
        } else {
            if (a[i] != b[j]) return a[i] < b[j];
            ++i, ++j;
        }
    }
    return a.size() - i < b.size() - j;
}

bool isPicture(const fs::path& path) {
    std::string extension = path.extension().string();
    std::ranges::transform(extension, extension.begin(), [](unsigned char c) { return std::tolower(c); });
    constexpr std::array kKinds{".png", ".jpg", ".jpeg", ".tif", ".tiff", ".webp"};
    return std::ranges::find(kKinds, extension) != kKinds.end();
}

Result<std::vector<fs::path>> picturesIn(const fs::path& folder) {
    std::error_code error;
    std::vector<fs::path> files;
    for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error)) {
        std::error_code ignored;
        if (isPicture(at->path()) && at->is_regular_file(ignored)) files.push_back(at->path());
    }
    if (error) return fail(Fault::notFound, spoken(folder) + " cannot be listed: " + error.message() + ".");
    std::ranges::sort(files, [](const fs::path& a, const fs::path& b) {
        return namedBefore(a.filename().string(), b.filename().string());
    });
    return files;
}

std::string sizeText(Size size) { return std::to_string(size.width) + " x " + std::to_string(size.height); }

Result<std::vector<Wanted>> inOrder(const fs::path& folder, const std::vector<Pattern>& patterns, Size projector) {
    const auto files = picturesIn(folder);
    if (!files) return tl::unexpected(files.error());
    if (files->size() != patterns.size()) {
        return fail(Fault::badFile,
                    spoken(folder) + " holds " + std::to_string(files->size()) +
                        " pictures, but a scan with a projector of " + sizeText(projector) + " has " +
                        std::to_string(patterns.size()) +
                        ": check --projector, or write a scan.json that names what each picture shows.");
    }
    std::vector<Wanted> wanted;
    for (std::size_t i = 0; i < files->size(); ++i)
        wanted.push_back({(*files)[i], patterns[i]});
    return wanted;
}

Result<std::vector<Wanted>> named(const fs::path& folder, JsonReader& reader) {
    std::vector<Wanted> wanted;
    for (JsonReader& picture : reader.objects("pictures")) {
        const std::string file = picture.word("file");
        const auto pattern = patternFromWords(picture.word("shows"));
        if (!pattern) {
            picture.complain("shows", "must be white, black, or like \"column 3\", \"row 0 inverse\" or \"marker 1\".");
        }
        if (!staysInside(file)) picture.complain("file", "must be the name of a picture in this folder.");
        if (reader.problem()) break;
        wanted.push_back({folder / file, *pattern});
    }
    return wanted;
}

struct Manifest {
    Size projector;
    std::vector<Wanted> wanted;
};

Result<Manifest> readManifest(const fs::path& folder, std::optional<Size> projector) {
    const auto text = readWhole(folder / kManifest, 1'000'000);
    if (!text) return tl::unexpected(text.error());
    const std::string file = spoken(folder / kManifest);
    const auto json = Json::parse(*text, file);
    if (!json) return tl::unexpected(json.error());
    if (const auto good = checkedFormat(*json, file, kScanFormat, kVersion, "scan"); !good)
        return tl::unexpected(good.error());
    JsonReader reader(*json, file);
    Manifest manifest{projector.value_or(kUsualProjector), {}};
    if (!projector && reader.has("projector")) {
        const auto size = reader.numbers("projector", 2);
        const auto side = [](double value) {
            return value >= 2.0 && value <= kMostSide && value == static_cast<int>(value);
        };
        if (size.size() == 2 && side(size[0]) && side(size[1])) {
            manifest.projector = {static_cast<int>(size[0]), static_cast<int>(size[1])};
        } else {
            reader.complain("projector", "must be width and height in pixels, such as [1024, 768].");
        }
    }
    const bool ordered = reader.has("order");
    const std::size_t order = ordered ? reader.choice("order", {"white-first", "white-last"}) : 0;
    if (reader.problem()) return tl::unexpected(*reader.problem());
    auto wanted =
        ordered
            ? inOrder(folder, order == 0 ? grayCodePatterns(manifest.projector) : openCvPatterns(manifest.projector),
                      manifest.projector)
            : named(folder, reader);
    if (reader.problem()) return tl::unexpected(*reader.problem());
    if (!wanted) return tl::unexpected(wanted.error());
    manifest.wanted = *std::move(wanted);
    if (manifest.wanted.empty())
        return fail(Fault::badFile, file + " names no pictures: give \"pictures\" or an \"order\".");
    return manifest;
}

}  // namespace

std::vector<Pattern> openCvPatterns(Size projector) {
    std::vector<Pattern> patterns = grayCodePatterns(projector);
    std::rotate(patterns.begin(), patterns.begin() + 2, patterns.end());
    return patterns;
}

std::string shown(const Pattern& pattern) {
    using enum Pattern::Kind;
    switch (pattern.kind) {
    case white:
        return "white";
    case black:
        return "black";
    case column:
    case row:
    case marker:
        break;
    }
    const std::string kind = pattern.kind == column ? "column " : pattern.kind == row ? "row " : "marker ";
    return kind + std::to_string(pattern.bit) + (pattern.inverse ? " inverse" : "");
}

std::optional<Pattern> patternFromWords(const std::string& words) {
    using enum Pattern::Kind;
    for (const Pattern::Kind kind : {white, black}) {
        if (words == shown({kind, 0, false})) return Pattern{kind, 0, false};
    }
    for (const auto& [name, kind] :
         {std::pair{"column ", column}, std::pair{"row ", row}, std::pair{"marker ", marker}}) {
        if (!words.starts_with(name)) continue;
        Pattern pattern{kind, 0, words.ends_with(" inverse")};
        const char* from = words.data() + std::string(name).size();
        std::from_chars(from, words.data() + words.size(), pattern.bit);
        if (shown(pattern) == words && pattern.bit >= 0) return pattern;
    }
    return std::nullopt;
}

Result<Scan> readScan(const fs::path& folder, std::optional<Size> projector) {
    std::error_code ignored;
    if (!fs::is_directory(folder, ignored)) {
        return fail(Fault::notFound, spoken(folder) + " is not a folder: name the one that holds the scan's pictures.");
    }
    Manifest manifest{projector.value_or(kUsualProjector), {}};
    if (fs::exists(folder / kManifest, ignored)) {
        auto read = readManifest(folder, projector);
        if (!read) return tl::unexpected(read.error());
        manifest = *std::move(read);
    } else {
        auto wanted = inOrder(folder, openCvPatterns(manifest.projector), manifest.projector);
        if (!wanted) return tl::unexpected(wanted.error());
        manifest.wanted = *std::move(wanted);
    }
    std::vector<Result<Image<std::uint8_t>>> read(manifest.wanted.size());
    parallelFor(static_cast<int>(read.size()), [&](int i) {
        const auto at = static_cast<std::size_t>(i);
        read[at] = readMask(manifest.wanted[at].file);
    });
    Scan scan{manifest.projector, {}, {}};
    for (std::size_t i = 0; i < read.size(); ++i) {
        if (!read[i]) return tl::unexpected(read[i].error());
        if (read[i]->size() != read.front()->size()) {
            return fail(Fault::badFile, spoken(manifest.wanted[i].file) + " has " + sizeText(read[i]->size()) +
                                            " pixels, the scan's first picture " + sizeText(read.front()->size()) +
                                            ": all must come from one camera in one mode.");
        }
        scan.patterns.push_back(manifest.wanted[i].pattern);
        scan.pictures.push_back(*read[i]);
    }
    return scan;
}

Result<void> writeScan(const fs::path& folder, const Scan& scan) {
    Json json;
    json.set("format", std::string(kScanFormat));
    json.set("version", kVersion);
    json.set("projector", std::vector<double>{double(scan.projector.width), double(scan.projector.height)});
    std::vector<TreeFile> files;
    std::vector<Json> pictures;
    for (std::size_t i = 0; i < scan.pictures.size(); ++i) {
        const std::string number = std::to_string(i);
        const std::string name = "picture_" + std::string(number.size() < 2 ? "0" : "") + number + ".png";
        auto png = encodePng(scan.pictures[i]);
        if (!png) return tl::unexpected(png.error());
        files.push_back({name, Box<std::string>{*std::move(png)}});
        Json picture;
        picture.set("file", name);
        picture.set("shows", shown(scan.patterns[i]));
        pictures.push_back(picture);
    }
    json.set("pictures", pictures);
    files.push_back({kManifest, Box<std::string>{json.text()}});
    return writeFolder(folder, files);
}

}  // namespace ilf::projects
