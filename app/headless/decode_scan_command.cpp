#include "app/headless/decode_scan_command.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <iostream>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "app/exit_code.h"
#include "app/headless/prepare.h"
#include "app/words.h"
#include "core/base/as_text.h"
#include "core/base/elapsed.h"
#include "core/registration/gray_code.h"
#include "core/registration/map_check.h"
#include "core/registration/scan_diagnosis.h"
#include "projects/map_file.h"
#include "projects/pictures.h"
#include "projects/scan_folder.h"

namespace ilf::app {
namespace {

using Json = nlohmann::ordered_json;

struct Report {
    Size camera, projector;
    DecodedScan decoded;
    ScanDiagnosis diagnosis;
    std::optional<MapCheck> columns, rows;
    double decode_ms = 0.0;
    std::string map, quality;  ///< files written
};

Result<std::optional<Size>> sizeFrom(const std::string& text) {
    if (text.empty()) return std::optional<Size>();
    Size size;
    char rest = 0;
    if (std::sscanf(text.c_str(), "%5dx%5d%c", &size.width, &size.height, &rest) == 2 && size.width >= 2 &&
        size.height >= 2) {
        return size;
    }
    return fail(Fault::outOfRange, "--projector " + text + " is no raster: write its width and height as in 1024x768.");
}

const char* weightWord(ScanFinding::Weight weight) {
    switch (weight) {
    case ScanFinding::Weight::note:
        return "note";
    case ScanFinding::Weight::warning:
        return "warning";
    case ScanFinding::Weight::failure:
        return "failure";
    }
    return "";
}

/// The map as a file gives it back, held against the map that was written and against the scan's own wide stripes.
Result<void> writtenAndChecked(const std::string& path, const DenseMap& map, const Scan& scan, Report& report) {
    const projects::MapFacts facts{
        {"taken", utcNow()}, {"method", "scan"}, {"decoded_pixels", std::to_string(report.decoded.count[0])}};
    if (auto written = projects::writeMap(path, map, facts); !written) return written;
    const auto read = projects::readMap(path);
    if (!read) return tl::unexpected(read.error());
    const DenseMap& back = read->map;
    bool same = back.projectorOfCamera == map.projectorOfCamera && back.confidence == map.confidence &&
                back.cameraOfProjector == map.cameraOfProjector && back.seen == map.seen;
    for (std::size_t k = 0; k < map.nearest.m.size(); ++k)
        same = same && std::abs(back.nearest.m[k] - map.nearest.m[k]) <= 1e-9 * (1.0 + std::abs(map.nearest.m[k]));
    if (!same)
        return fail(Fault::cannotWrite, "\"" + path + "\" does not read back as it was written: check the disk.");
    for (const auto& [kind, check] :
         {std::pair{Pattern::Kind::column, &report.columns}, std::pair{Pattern::Kind::row, &report.rows}}) {
        const Pattern pattern = checkPattern(kind, scan.projector);
        const auto picture = [&](bool inverse) -> const Image<std::uint8_t>& {
            std::size_t at = 0;
            while (scan.patterns[at] != Pattern{pattern.kind, pattern.bit, inverse})
                ++at;
            return scan.pictures[at];
        };
        auto checked = mapCheck(back, pattern, picture(false), picture(true));
        if (!checked) return tl::unexpected(checked.error());
        *check = *checked;
        if (!checked->holds()) {
            return fail(Fault::badFile, "The map does not hold: of " + std::to_string(checked->edges) +
                                            " places on the edges of wide " +
                                            (kind == Pattern::Kind::column ? "columns, " : "rows, ") +
                                            asText("%.0f %%", 100.0 * checked->beyond) +
                                            " are more than 4 projector pixels off, the "
                                            "others " +
                                            asText("%.2f", checked->rms_px) + " (rms). Scan again.");
        }
    }
    report.map = path;
    return {};
}

Json jsonOf(const MapCheck& check) {
    return {{"edges", check.edges}, {"rms_px", check.rms_px}, {"beyond_4_px", check.beyond}};
}

void printJson(const Report& report, const std::optional<Error>& error) {
    const auto count = [&](PixelState state) { return report.decoded.count[static_cast<std::size_t>(state)]; };
    Json findings = Json::array();
    for (const ScanFinding& finding : report.diagnosis.findings) {
        Json one{{"cause", word(finding.fault)}, {"weight", weightWord(finding.weight)}, {"what", finding.what}};
        const auto& area = finding.area;
        if (!area.empty()) one["area"] = {area.x0, area.y0, area.x1, area.y1};
        findings.push_back(std::move(one));
    }
    Json legend = Json::array();
    for (const QualityColour& colour : qualityLegend())
        legend.push_back({{"rgb", colour.rgb}, {"means", colour.words}});
    Json json{{"ok", !error},
              {"camera", {report.camera.width, report.camera.height}},
              {"projector", {report.projector.width, report.projector.height}},
              {"pixels",
               {{"decoded", count(PixelState::decoded)},
                {"dark", count(PixelState::dark)},
                {"saturated", count(PixelState::saturated)},
                {"ambiguous", count(PixelState::ambiguous)},
                {"inconsistent", count(PixelState::inconsistent)},
                {"lit", report.diagnosis.lit}}},
              {"contrast", report.diagnosis.medianContrast},
              {"projector_share", report.diagnosis.projectorShare},
              {"decode_ms", report.decode_ms},
              {"findings", std::move(findings)}};
    if (error) json["error"] = error->what;
    if (report.columns) json["check_columns"] = jsonOf(*report.columns);
    if (report.rows) json["check_rows"] = jsonOf(*report.rows);
    if (!report.map.empty()) json["map"] = report.map;
    if (!report.quality.empty()) {
        json["quality"] = report.quality;
        json["quality_legend"] = std::move(legend);
    }
    std::cout << json.dump(2) << '\n';
}

void printText(const Report& report) {
    const auto& count = report.decoded.count;
    std::cout << "Decoded " << count[0] << " of " << report.camera.width << " x " << report.camera.height
              << " pixels in " << asText("%.0f ms", report.decode_ms) << "; dark " << count[1] << ", saturated "
              << count[2] << ", ambiguous " << count[3] << ", inconsistent " << count[4] << ".\n";
    for (const ScanFinding& finding : report.diagnosis.findings)
        std::cout << weightWord(finding.weight) << ": " << finding.what << '\n';
    if (!report.quality.empty()) {
        std::cout << "Quality map: " << report.quality << '\n';
        for (const QualityColour& colour : qualityLegend())
            std::cout << "  " << colour.words << '\n';
    }
    if (report.columns && report.rows) {
        std::cout << "Written, read back and checked: edges of wide columns are "
                  << asText("%.2f", report.columns->rms_px) << " projector pixels off (rms of " << report.columns->edges
                  << "), of wide rows " << asText("%.2f", report.rows->rms_px) << ".\n"
                  << report.map << '\n';
    }
}

Result<void> decodeScan(const DecodeScanOptions& options, std::optional<Size> projector, Report& report) {
    const auto scan = projects::readScan(options.folder, projector);
    if (!scan) return tl::unexpected(scan.error());
    const auto start = std::chrono::steady_clock::now();
    auto decoded = decodedScan(*scan);
    if (!decoded) return tl::unexpected(decoded.error());
    report.decode_ms = millisecondsSince(start);
    report.decoded = *std::move(decoded);
    report.camera = report.decoded.state.size();
    report.projector = scan->projector;
    report.diagnosis = scanDiagnosis(*scan, report.decoded);
    if (!options.quality.empty()) {
        if (auto written = projects::writePng(options.quality, qualityMap(report.decoded)); !written) return written;
        report.quality = options.quality;
    }
    for (const ScanFinding& finding : report.diagnosis.findings) {
        if (finding.weight == ScanFinding::Weight::failure) return fail(Fault::badFile, finding.what);
    }
    const auto map = denseMap(report.decoded);
    if (!map) return tl::unexpected(map.error());
    return writtenAndChecked(options.out, *map, *scan, report);
}

}  // namespace

int decodeScanCommand(const DecodeScanOptions& options) {
    const auto size = sizeFrom(options.projector);
    if (!size) {
        refused("decode-scan", size.error());
        return kUsage;
    }
    constexpr std::array kEndings{".yml", ".yaml", ".yml.gz", ".yaml.gz", ".exr"};
    if (std::ranges::none_of(kEndings, [&](const char* ending) { return options.out.ends_with(ending); })) {
        std::cerr << "illuminatedfocus decode-scan: \"" << options.out
                  << "\" names no kind of map: end it with .yml, .yml.gz or .exr.\n";
        return kUsage;
    }
    Report report;
    const auto done = decodeScan(options, *size, report);
    const bool decoded = report.camera.width > 0;
    if (options.json && decoded) printJson(report, done ? std::nullopt : std::optional(done.error()));
    if (!options.json && decoded) printText(report);
    if (done) return kDone;
    return refused("decode-scan", done.error());
}

}  // namespace ilf::app
