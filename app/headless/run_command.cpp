#include "app/headless/run_command.h"

#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>
#include <thread>

#include "app/exit_code.h"
#include "app/headless/plan_command.h"
#include "app/headless/prepare.h"
#include "app/headless/simulated_core.h"
#include "app/pictures_of.h"
#include "core/base/srgb.h"
#include "core/perceived/view_engine.h"
#include "ilf/version.h"
#include "projects/pictures.h"

namespace ilf::app {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

/// What a view took, and why the rest of it was not worked out.
json countersOf(Eye eye, const PerceivedView& view) {
    const ViewCounters& c = view.counters;
    return {{"eye", eye == Eye::left ? "left" : "right"},
            {"rung", std::string(word(view.rung))},
            {"tiles", c.tiles},
            {"computed", c.computed},
            {"skipped", {{"unchanged", c.unchanged}, {"plain", c.plain}, {"dark", c.dark}}},
            {"lights", c.lights},
            {"dark_levels", c.darkLights},
            {"surfaces", {{"blurred", c.blurred}, {"sharp", c.sharp}, {"unlit", c.unlit}, {"hidden", c.hidden}}},
            {"conflict_tiles", c.conflicts},
            {"times_ms", {{"geometry", c.geometry_ms}, {"light", c.light_ms}, {"tiles", c.tiles_ms}}}};
}

struct WrittenPictures {
    std::vector<std::string> names;
    json views = json::array();  ///< counters of each perceived one
};

/// Every view and every distinct slot image, as PNG.
Result<WrittenPictures> writePictures(const Compiled& compiled, const fs::path& directory) {
    std::error_code error;
    fs::create_directories(directory, error);
    if (error) {
        return fail(Fault::cannotWrite,
                    "The directory " + directory.string() + " can not be made: " + error.message() + ".");
    }
    WrittenPictures all;
    const auto write = [&](const std::string& name, const Image<std::uint8_t>& picture) -> Result<void> {
        if (auto written = projects::writePng(directory / name, picture); !written) return written;
        all.names.push_back((directory / name).string());
        return {};
    };
    const Document& document = compiled.document;
    if (auto r = write("camera.png", scenePicture(document)); !r) return tl::unexpected(r.error());
    if (auto r = write("overlay.png", overlayPicture(document)); !r) return tl::unexpected(r.error());
    for (const Eye eye : {Eye::left, Eye::right}) {
        ViewRequest request;
        request.eye = eye;
        const auto view = ViewEngine().see(document, compiled.plan, compiled.program, request);
        if (!view) return tl::unexpected(view.error());
        all.views.push_back(countersOf(eye, *view));
        const auto* name = eye == Eye::left ? "perceived-left.png" : "perceived-right.png";
        if (auto r = write(name, toSrgb8(view->radiance())); !r) return tl::unexpected(r.error());
    }
    for (std::size_t slot = 0; slot < compiled.program.imageOfSlot.size(); ++slot) {
        const auto number = (slot < 10 ? "0" : "") + std::to_string(slot);
        if (auto r = write("slot-" + number + ".png", slotPicture(compiled.program, static_cast<int>(slot))); !r) {
            return tl::unexpected(r.error());
        }
    }
    return all;
}

/// Pixels of the slot images the devices received that differ from the program's, slot by slot.
Result<json> receivedAgainstIntended(SimulatedCore& core, const Program& program) {
    json slots = json::array();
    for (int slot = 0; slot < static_cast<int>(program.imageOfSlot.size()); ++slot) {
        const auto received = core.slot(slot);
        if (!received) return tl::unexpected(received.error());
        const auto intended = slotPicture(program, slot);
        const auto shown = toImage(*received);
        std::int64_t differing = 0;
        if (shown.size() != intended.size()) {
            differing = static_cast<std::int64_t>(intended.pixels().size());
        } else {
            for (std::size_t i = 0; i < intended.pixels().size(); ++i) {
                differing += intended.pixels()[i] != shown.pixels()[i] ? 1 : 0;
            }
        }
        slots.push_back({{"slot", slot}, {"differing_pixels", differing}});
    }
    return slots;
}

json reportOf(const Prepared& project, const RunOptions& options, const Played& played) {
    const CompileCounters& counters = project.compiled.counters;
    return {
        {"program", std::string("illuminatedfocus ") + ilf::kVersion},
        {"file", options.file},
        {"provenance", "simulated lens and projector"},
        {"seconds", options.seconds},
        {"plan", json::parse(planJson(project.compiled.plan, project.compiled.document))},
        {"times_ms",
         {{"open", project.open_ms},
          {"plan", project.plan_ms},
          {"compile", project.compile_ms},
          {"sent_to_swapped", played.sentToSwapped_ms}}},
        {"tiles",
         {{"all", counters.tiles},
          {"computed", counters.computed},
          {"unchanged", counters.unchanged},
          {"uniform", counters.uniform},
          {"seam", counters.seamTiles}}},
        {"played",
         {{"content_hash_sent", std::to_string(contentHash(project.compiled.program))},
          {"content_hash_shown", std::to_string(played.state.hashShown)},
          {"light", played.state.light == devices::LightMode::slotted ? "slotted" : "steady"},
          {"sweeps", played.sweeps},
          {"swaps", played.state.swaps},
          {"refusals", played.state.refusals},
          {"lens_low_D", played.state.waveform.low.si()},
          {"lens_high_D", played.state.waveform.high.si()},
          {"lens_unsettled_D", played.state.lensError.si()},
          {"lens_off_its_wave_rms_D", played.state.offWave.si()},
          {"lens_temperature_C", played.state.lensTemperature_C},
          {"triggers_lost", played.state.triggersLost},
          {"rate_changes_under_slotted_light", played.state.rateChangesUnderSlottedLight}}},
    };
}

}  // namespace

int runCommand(const RunOptions& options) {
    const auto project = prepared(options.file, options.lens);
    if (!project) return refused("run", project.error());
    const Program& program = project->compiled.program;

    auto core = SimulatedCore::start(options.coreProgram, *simulatedLens(options.lens));
    if (!core) return refused("run", core.error());
    const auto played = (*core)->play(program, std::chrono::duration<double>(options.seconds));
    if (!played) return refused("run", played.error());
    const auto compared = receivedAgainstIntended(**core, program);
    if (!compared) return refused("run", compared.error());

    json report = reportOf(*project, options, *played);
    report["received"] = *compared;
    if (!options.pictures.empty()) {
        const auto pictures = writePictures(project->compiled, options.pictures);
        if (!pictures) return refused("run", pictures.error());
        report["pictures"] = pictures->names;
        report["views"] = pictures->views;
        std::cout << pictures->names.size() << " pictures in " << options.pictures << '\n';
    }
    if (!options.report.empty()) {
        std::error_code ignored;
        const auto parent = fs::path(options.report).parent_path();
        if (!parent.empty()) fs::create_directories(parent, ignored);
        std::ofstream file(options.report);
        file << report.dump(2) << '\n';
        if (!file.flush()) {
            return refused("run", {Fault::cannotWrite, "The report " + options.report +
                                                           " can not be written: check the "
                                                           "directory and the space left."});
        }
    }
    std::cout << planText(project->compiled.plan, project->compiled.document) << '\n'
              << "Played " << played->sweeps << " sweeps on the simulated devices; first light "
              << played->sentToSwapped_ms << " ms after it was sent; the lens was "
              << std::lround(played->state.offWave.si() * 1e3) << " mD rms off its predicted wave.\n";
    if (played->state.hashShown != contentHash(program)) {
        return refused("run",
                       {Fault::device, "The devices show another program than the one that was sent; nothing "
                                       "about this run can be trusted. Run it again, and report it if it stays."});
    }
    return kDone;
}

}  // namespace ilf::app
