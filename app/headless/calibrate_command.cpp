#include "app/headless/calibrate_command.h"

#include <algorithm>
#include <charconv>
#include <iostream>
#include <nlohmann/json.hpp>

#include "app/exit_code.h"
#include "app/headless/prepare.h"
#include "app/words.h"
#include "core/base/as_text.h"
#include "core/registration/calibrate.h"
#include "projects/calibration_file.h"
#include "projects/scan_folder.h"

namespace ilf::app {
namespace {

using nlohmann::ordered_json;

const char* const kName = "calibrate";

ordered_json asJson(const Pinhole& p, const PinholeDeviation& d) {
    return {{"width_px", p.size.width},
            {"height_px", p.size.height},
            {"fx_px", p.fx},
            {"fy_px", p.fy},
            {"cx_px", p.cx},
            {"cy_px", p.cy},
            {"distortion", p.distortion},
            {"deviation",
             {{"fx_px", d.fx}, {"fy_px", d.fy}, {"cx_px", d.cx}, {"cy_px", d.cy}, {"distortion", d.distortion}}}};
}

ordered_json asJson(const Calibrated& found) {
    const ProcamCalibration& c = found.calibration;
    ordered_json poses = ordered_json::array();
    for (const PoseFit& pose : found.poses) {
        ordered_json entry{{"name", pose.name},
                           {"used", pose.used},
                           {"camera_corners", pose.cameraCorners},
                           {"projector_corners", pose.projectorCorners}};
        if (pose.used) entry["camera_px"] = pose.camera_px, entry["projector_px"] = pose.projector_px;
        poses.push_back(std::move(entry));
    }
    return {{"camera", asJson(c.camera, found.camera)},
            {"projector", asJson(c.projector, found.projector)},
            {"projector_from_camera",
             {{"rotation", c.projectorFromCamera.rotation},
              {"translation_m", c.projectorFromCamera.translation},
              {"deviation", {{"rotation_rad", found.rotation_rad}, {"translation_m", found.translation_m}}}}},
            {"camera_rms_px", c.cameraRms_px},
            {"projector_rms_px", c.projectorRms_px},
            {"widest_tilt_deg", found.widestTilt_deg},
            {"scale", c.scale},
            {"poses", std::move(poses)},
            {"notes", found.notes}};
}

void print(const char* device, const Pinhole& p, const PinholeDeviation& d, double rms_px) {
    std::cout << device << ": f " << asText("%.1f", p.fx) << " +-" << asText("%.1f", d.fx) << ", "
              << asText("%.1f", p.fy) << " +-" << asText("%.1f", d.fy) << " px; centre " << asText("%.1f", p.cx)
              << " +-" << asText("%.1f", d.cx) << ", " << asText("%.1f", p.cy) << " +-" << asText("%.1f", d.cy)
              << " px; distortion";
    for (const double term : p.distortion)
        std::cout << ' ' << asText("%.4f", term);
    std::cout << "; residual " << asText("%.3f", rms_px) << " px rms.\n";
}

void print(const Calibrated& found) {
    std::cout << "pose                      camera px  projector px  corners\n";
    for (const PoseFit& pose : found.poses) {
        char line[160];
        if (pose.used) {
            std::snprintf(line, sizeof line, "%-24.60s %10.3f %13.3f  %4d, %d\n", pose.name.c_str(), pose.camera_px,
                          pose.projector_px, pose.cameraCorners, pose.projectorCorners);
        } else {
            std::snprintf(line, sizeof line, "%-24.60s   left out\n", pose.name.c_str());
        }
        std::cout << line;
    }
    const ProcamCalibration& c = found.calibration;
    print("Camera", c.camera, found.camera, c.cameraRms_px);
    print("Projector", c.projector, found.projector, c.projectorRms_px);
    const auto& t = c.projectorFromCamera.inverted().translation;
    std::cout << "The projector stands " << asText("%.1f", 1e3 * t[0]) << " mm to the right of the camera, "
              << asText("%.1f", 1e3 * t[1]) << " mm below and " << asText("%.1f", 1e3 * t[2])
              << " mm before it (metres from the " << c.scale << "). The poses' tilts differ by up to "
              << asText("%.0f", found.widestTilt_deg) << " degrees.\n";
    for (const std::string& note : found.notes)
        std::cout << note << '\n';
}

/// One pose: its scan read and decoded, the board found under white light and placed on the projector.
Result<BoardView> poseIn(const std::string& folder, const Board& board, std::optional<Size> projector) {
    const auto scan = projects::readScan(folder, projector);
    if (!scan) return tl::unexpected(scan.error());
    const auto decoded = decodedScan(*scan);
    if (!decoded) return tl::unexpected(Error{decoded.error().fault, folder + ": " + decoded.error().what});
    const auto white = std::ranges::find(scan->patterns, Pattern::Kind::white, &Pattern::kind) - scan->patterns.begin();
    if (white == static_cast<std::ptrdiff_t>(scan->patterns.size()))
        return fail(Fault::badFile, folder + ": its scan has no picture under white light, where the board is seen.");
    return boardView(scan->pictures[static_cast<std::size_t>(white)], *decoded, board, folder);
}

Result<Calibrated> calibratedFrom(const CalibrateOptions& options, const Board& board, std::optional<Size> projector) {
    // A pose without its board is named and left out, as long as enough others may be left.
    std::vector<BoardView> views;
    std::vector<std::string> lost;
    for (const std::string& folder : options.folders) {
        auto view = poseIn(folder, board, projector);
        if (!view && options.folders.size() < 3) return tl::unexpected(view.error());
        if (view) {
            if (!options.json) {
                std::cout << folder << ": board found, "
                          << std::ranges::count_if(view->onProjector, [](const auto& p) { return p.has_value(); })
                          << " of " << view->onProjector.size() << " corners on the projector.\n";
            }
            views.push_back(*std::move(view));
        } else {
            lost.push_back(view.error().what);
        }
    }
    if (views.empty() && !lost.empty()) return fail(Fault::notFound, lost.front());
    auto found = calibrated(views, board);
    if (!found) return found;
    found->notes.insert(found->notes.begin(), lost.begin(), lost.end());
    found->calibration.provenance = "measured";
    found->calibration.taken = utcNow();
    return found;
}

int write(const CalibrateOptions& options, const ProcamCalibration& calibration) {
    if (options.out.empty()) return kDone;
    if (const auto good = projects::writeCalibration(options.out, calibration); !good)
        return refused(kName, good.error());
    // Success is said of what can be read again.
    const auto back = projects::readCalibration(options.out);
    if (!back) return refused(kName, back.error());
    if (*back != calibration) {
        return refused(kName, {Fault::cannotWrite, options.out + " does not hold what was written: check the disk."});
    }
    if (!options.json) std::cout << "Written: " << options.out << '\n';
    return kDone;
}

int importedCommand(const CalibrateOptions& options, std::optional<Size> projector) {
    if (!projector) {
        std::cerr << "illuminatedfocus calibrate: an OpenCV file does not tell the projector's raster: give "
                     "--projector, such as 1024x768.\n";
        return kUsage;
    }
    const auto read = projects::importCalibration(options.opencv, *projector);
    if (!read) return refused(kName, read.error());
    Calibrated found;
    found.calibration = *read;
    if (options.json) {
        std::cout << asJson(found).dump(2) << '\n';
    } else {
        print(found);
    }
    return write(options, *read);
}

}  // namespace

std::optional<Size> sizeFromWords(const std::string& text) {
    Size size;
    const char* const end = text.data() + text.size();
    const auto width = std::from_chars(text.data(), end, size.width);
    if (width.ec != std::errc() || width.ptr == end || *width.ptr != 'x') return std::nullopt;
    const auto height = std::from_chars(width.ptr + 1, end, size.height);
    if (height.ec != std::errc() || height.ptr != end || size.width < 1 || size.height < 1) return std::nullopt;
    return size;
}

Result<Metre> lengthFromWords(const std::string& text) {
    const auto last = text.find_last_of("0123456789.");
    const std::string number = last == std::string::npos ? "" : text.substr(0, last + 1);
    std::string unit = last == std::string::npos ? text : text.substr(last + 1);
    unit.erase(0, std::min(unit.find_first_not_of(' '), unit.size()));
    const auto value = wholeNumber(number);
    const double metres = unit == "mm" ? 1e-3 : unit == "cm" ? 1e-2 : unit == "m" ? 1.0 : 0.0;
    if (!value || metres == 0.0 || !(*value > 0.0)) {
        return fail(Fault::outOfRange, "\"" + text + "\" is no length: write it with its unit, such as 75mm.");
    }
    return Metre::fromSi(*value * metres);
}

int calibrateCommand(const CalibrateOptions& options) {
    const auto usage = [](const std::string& what) {
        std::cerr << "illuminatedfocus calibrate: " << what << '\n';
        return kUsage;
    };
    std::optional<Size> projector;
    if (!options.projector.empty()) {
        projector = sizeFromWords(options.projector);
        if (!projector) return usage("\"" + options.projector + "\" is no raster: write it as 1024x768.");
    }
    if (options.opencv.empty() == options.folders.empty())
        return usage("give the folders of the board's scans, or --opencv FILE.");
    if (!options.opencv.empty()) return importedCommand(options, projector);
    const auto corners = sizeFromWords(options.board);
    if (!corners) return usage("\"" + options.board + "\" is no board: write its inner corners as 9x6.");
    const auto square = lengthFromWords(options.square);
    if (!square) return usage(square.error().what);
    const Board board{corners->width, corners->height, *square};
    if (const auto good = checked(board); !good) return usage(good.error().what);
    const auto found = calibratedFrom(options, board, projector);
    if (!found) return refused(kName, found.error());
    if (options.json) {
        std::cout << asJson(*found).dump(2) << '\n';
    } else {
        print(*found);
    }
    return write(options, found->calibration);
}

}  // namespace ilf::app
