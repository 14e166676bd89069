#include "projects/calibration_file.h"

#include "projects/calibration_json.h"
#include "projects/safe_file.h"

namespace ilf::projects {
namespace {

constexpr std::size_t kMostOfCalibration = std::size_t{1} << 20;
const char* const kCalibrationFormat = "illuminatedfocus-calibration";

Result<Json> readJson(const fs::path& path) {
    return readWhole(path, kMostOfCalibration).and_then([&](const std::string& text) {
        return Json::parse(text, spoken(path));
    });
}

}  // namespace

Result<ProcamCalibration> readCalibration(const fs::path& path) {
    const auto json = readJson(path);
    if (!json) return tl::unexpected(json.error());
    if (const auto known = checkedFormat(*json, spoken(path), kCalibrationFormat, kCalibrationVersion, "calibration");
        !known)
        return tl::unexpected(known.error());
    JsonReader reader(*json, spoken(path));
    ProcamCalibration calibration = procamCalibrationFrom(reader);
    if (reader.problem()) return tl::unexpected(*reader.problem());
    return calibration;
}

Result<void> writeCalibration(const fs::path& path, const ProcamCalibration& calibration) {
    const auto before = readJson(path);
    Json json = before && before->word("format") == kCalibrationFormat ? *before : Json();
    json.set("format", std::string(kCalibrationFormat));
    json.set("version", kCalibrationVersion);
    return writeAtomically(path, written(calibration, json).text());
}

}  // namespace ilf::projects
