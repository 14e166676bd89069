#include "app/headless/scan_command.h"

#include <unistd.h>

#include <atomic>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <iostream>
#include <nlohmann/json.hpp>
#include <thread>

#include "app/exit_code.h"
#include "app/headless/own_core.h"
#include "app/headless/prepare.h"
#include "app/rigs.h"
#include "app/scan/light_map.h"
#include "app/scan/scan.h"
#include "app/scan/scan_truth.h"
#include "core/base/as_text.h"
#include "devices/camera/list.h"
#include "devices/emulated_scene/emulated_camera.h"
#include "projects/map_file.h"
#include "projects/pictures.h"

namespace ilf::app {
namespace {

using nlohmann::ordered_json;

std::atomic<bool> interrupted{false};
static_assert(std::atomic<bool>::is_always_lock_free);

/// Control-C ends a scan in safe light. A handler may only set a flag; this thread asks the scan to stop.
class StopsOnSignal {
public:
    StopsOnSignal() {
        for (std::size_t i = 0; i < 2; ++i)
            before_[i] = std::signal(kSignals[i], [](int) { interrupted = true; });
        watch_ = std::jthread([this](const std::stop_token& over) {
            while (!over.stop_requested() && !interrupted)
                std::this_thread::sleep_for(std::chrono::milliseconds(50));
            if (interrupted) stop_.request_stop();
        });
    }
    ~StopsOnSignal() {
        watch_ = {};
        for (std::size_t i = 0; i < 2; ++i)
            std::signal(kSignals[i], before_[i]);
    }
    StopsOnSignal(const StopsOnSignal&) = delete;
    StopsOnSignal& operator=(const StopsOnSignal&) = delete;
    std::stop_token token() const { return stop_.get_token(); }

private:
    static constexpr int kSignals[] = {SIGINT, SIGTERM};
    void (*before_[2])(int) = {};
    std::stop_source stop_;
    std::jthread watch_;
};

Result<std::string> cameraOf(const ScanOptions& options, const Rig& rig) {
    if (!options.camera.empty()) return options.camera;
    if (!rig.devices || isEmulatedRig(options.rig.rig)) return devices::kEmulatedCameraId;
    for (const devices::CameraEntry& camera : devices::listCameras()) {
        if (!camera.device.empty()) return camera.id;
    }
    return fail(Fault::notFound, "No camera is plugged in: plug one in, or name one with --camera.");
}

ordered_json asJson(const ScanOutcome& outcome, const std::string& provenance) {
    const auto& captured = outcome.captured;
    ordered_json out{{"provenance", provenance},
                     {"projector", {captured.scan.projector.width, captured.scan.projector.height}},
                     {"camera",
                      {{"device", captured.mode.device},
                       {"sensor", {captured.mode.sensor.width, captured.mode.sensor.height}},
                       {"corner", {captured.mode.x0, captured.mode.y0}},
                       {"binning", captured.mode.binning},
                       {"picture", {captured.mode.picture.width, captured.mode.picture.height}}}},
                     {"exposure_ms", 1e3 * captured.exposure.si()},
                     {"frames_late", captured.late},
                     {"pairs_taken_again", captured.repeated},
                     {"remarks", captured.remarks},
                     {"ambient",
                      {{"go", captured.ambient.go},
                       {"projector_share", captured.ambient.projectorShare},
                       {"contrast", captured.ambient.contrast}}},
                     {"pictures", captured.scan.pictures.size()},
                     {"decoded", outcome.decoded.count[static_cast<std::size_t>(PixelState::decoded)]},
                     {"decoded_share_of_lit", outcome.diagnosis.decodedShare}};
    out["findings"] = ordered_json::array();
    for (const ScanFinding& finding : outcome.diagnosis.findings) {
        out["findings"].push_back({{"fault", word(finding.fault)},
                                   {"failure", finding.weight == ScanFinding::Weight::failure},
                                   {"what", finding.what}});
    }
    for (const auto& [name, check] : {std::pair{"columns", outcome.columns}, std::pair{"rows", outcome.rows}}) {
        if (check)
            out["check"][name] = {{"edges", check->edges}, {"rms_px", check->rms_px}, {"beyond_share", check->beyond}};
    }
    if (!outcome.trouble.empty()) out["failed"] = outcome.trouble;
    return out;
}

projects::MapFacts factsOf(const Registration& registration) {
    return {{"provenance", registration.provenance}, {"method", "scan"},
            {"camera", registration.camera.device},  {"projector", registration.projectorName},
            {"taken", registration.taken},           {"rms_px", asText("%.4f", registration.rms_px)}};
}

/// Success is what was read back.
Result<void> written(const std::string& file, const Registration& registration) {
    const DenseMap& map = *registration.map.dense();
    if (const auto done = projects::writeMap(file, map, factsOf(registration)); !done) return done;
    const auto back = projects::readMap(file);
    if (!back) return tl::unexpected(back.error());
    if (!(back->map == map))
        return fail(Fault::cannotWrite,
                    file + " does not read back as it was written; check the disk, then scan again.");
    return {};
}

Result<ScanOutcome> scannedOnOwnCore(const ScanOptions& options, ScanOrder& order) {
    const auto arguments = coreArguments(options.rig);
    if (!arguments) return tl::unexpected(arguments.error());
    const auto core = OwnCore::start(options.coreProgram, *arguments);
    if (!core) return tl::unexpected(core.error());
    order.runtimeDirectory = (*core)->directory();
    const StopsOnSignal stops;
    const bool terminal = isatty(STDERR_FILENO) != 0;
    std::string said;
    const auto watch = [&](const devices::ScanProgress& progress) {
        if (!terminal || progress.words == said) return;
        said = progress.words;
        std::cerr << "\r\033[K" << said << std::flush;
    };
    auto outcome = scanned(order, watch, stops.token());
    if (terminal) std::cerr << "\r\033[K";
    return outcome;
}

Result<void> reported(const ScanOptions& options, const ScanOrder& order, const ScanOutcome& outcome) {
    ordered_json said = asJson(outcome, provenanceOf(order));
    if (!options.quality.empty()) {
        const auto map = outcome.black.empty() ? qualityMap(outcome.decoded)
                                               : lightMap(outcome.white, outcome.black, outcome.moved).rgb;
        if (const auto done = projects::writePng(options.quality, map); !done) return done;
    }
    const auto truth = againstTruth(order, outcome);
    if (truth)
        said["against_truth"] = {
            {"pixels", truth->pixels}, {"rms_px", truth->rms_px}, {"beyond_2px_share", truth->beyond}};
    if (options.json) {
        std::cout << said.dump(2) << '\n';
    } else {
        for (const std::string& remark : outcome.captured.remarks)
            std::cout << remark << '\n';
        for (const ScanFinding& finding : outcome.diagnosis.findings)
            std::cout << finding.what << '\n';
        std::cout << outcome.decoded.count[0] << " pixels decoded, "
                  << asText("%.1f %%", 100.0 * outcome.diagnosis.decodedShare) << " of what is lit";
        if (outcome.columns && outcome.rows)
            std::cout << "; stripes shown anew are off by " << asText("%.2f", outcome.columns->rms_px)
                      << " (across) and " << asText("%.2f", outcome.rows->rms_px) << " (down) projector pixels rms";
        std::cout << ".\n";
        if (truth)
            std::cout << "Against the emulated scene's truth: " << asText("%.3f", truth->rms_px) << " px rms, "
                      << asText("%.2f %%", 100.0 * truth->beyond) << " off by more than 2.\n";
    }
    if (!outcome.registration) return fail(Fault::device, outcome.trouble);
    if (const auto done = written(options.out, *outcome.registration); !done) return done;
    if (!options.json)
        std::cout << options.out << ": the map, checked and read back (" << provenanceOf(order) << ").\n";
    return {};
}

}  // namespace

int scanCommand(const ScanOptions& options) {
    std::error_code ignored;
    if (!options.keep.empty() && std::filesystem::exists(options.keep, ignored)) {
        return refused("scan", {Fault::cannotWrite,
                                options.keep + " exists already: name a new folder for the pictures (--keep)."});
    }
    const auto rig = withOptions(Rig{}, options.rig);
    if (!rig) return refused("scan", rig.error());
    const auto camera = cameraOf(options, *rig);
    if (!camera) return refused("scan", camera.error());
    ScanOrder order{*rig, {}, {}, *camera, {}, options.keep};
    order.wish.sweeps = options.sweeps;
    order.wish.anyway = options.anyway;
    const auto outcome = scannedOnOwnCore(options, order);
    if (!outcome) return refused("scan", outcome.error());
    const auto done = reported(options, order, *outcome);
    return done ? kDone : refused("scan", done.error());
}

}  // namespace ilf::app
