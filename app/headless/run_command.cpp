#include "app/headless/run_command.h"

#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>
#include <optional>
#include <thread>

#include "app/exit_code.h"
#include "app/headless/own_core.h"
#include "app/headless/plan_command.h"
#include "app/headless/prepare.h"
#include "app/headless/run_pictures.h"
#include "app/headless/run_report.h"
#include "app/pictures_of.h"
#include "app/rigs.h"
#include "devices/link/rig_mishap.h"

namespace ilf::app {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

/// The slowest fault to be noticed: a lens that drifts out of phase.
constexpr std::chrono::seconds kNoticed{12};
/// After this the newest whole sweep is one of the program sent last.
constexpr std::chrono::milliseconds kWholeSweeps{150};

/// Pixels of the slot images the simulated devices hold that differ from the program's, slot by slot.
Result<json> receivedAgainstIntended(OwnCore& core, const Program& program) {
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

Result<std::vector<devices::RigMishap>> mishapsOf(const RunOptions& options) {
    std::vector<devices::RigMishap> mishaps;
    for (const std::string& text : options.mishaps) {
        auto mishap = devices::mishapFrom(text);
        if (!mishap) return tl::unexpected(mishap.error());
        mishaps.push_back(*std::move(mishap));
    }
    if (!mishaps.empty() && !isEmulatedRig(options.rig.rig))
        return fail(Fault::outOfRange, "Mishaps befall the emulated rig only: add --rig emulated.");
    return mishaps;
}

Result<void> writeReport(const std::string& path, const json& report) {
    if (path.empty()) return {};
    std::error_code ignored;
    const auto parent = fs::path(path).parent_path();
    if (!parent.empty()) fs::create_directories(parent, ignored);
    std::ofstream file(path);
    file << report.dump(2) << '\n';
    if (!file.flush())
        return fail(Fault::cannotWrite,
                    "The report " + path + " can not be written: check the directory and the space left.");
    return {};
}

/// One run, step by step; what it found lies in its report.
class Run {
public:
    Run(const RunOptions& options, const Prepared& project, OwnCore& core)
        : options_(options), project_(project), core_(core) {}

    Result<void> played() {
        const auto played = core_.play(program(), std::chrono::duration<double>(options_.seconds));
        if (!played) return tl::unexpected(played.error());
        report_ = runReport(project_, options_.file, options_.seconds, *played);
        std::cout << planText(project_.compiled.plan, project_.compiled.document) << '\n'
                  << "Played " << played->sweeps << " sweeps on " << inWords(options_.rig) << "; first light "
                  << played->sentToSwapped_ms << " ms after it was sent";
        if (played->state && !played->status.emulated)
            std::cout << "; the lens was " << std::lround(played->state->offWave.si() * 1e3)
                      << " mD rms off its predicted wave";
        std::cout << ".\n";
        if (played->status.contentHashPlayed != contentHash(program())) {
            return fail(Fault::device, "The devices show another program than the one that was sent; nothing about "
                                       "this run can be trusted. Run it again, and report it if it stays.");
        }
        return played->status.emulated ? readEmulated() : readSimulated(*played);
    }

    Result<void> pictures() {
        if (options_.pictures.empty()) return {};
        json views;
        const auto written =
            writePictures(project_.compiled, outcome_ ? &outcome_->sweep : nullptr, options_.pictures, views);
        if (!written) return tl::unexpected(written.error());
        report_["pictures"] = written->names;
        report_["views"] = std::move(views);
        std::cout << written->names.size() << " pictures in " << options_.pictures << '\n';
        return {};
    }

    Result<void> befall(const std::vector<devices::RigMishap>& mishaps) {
        if (mishaps.empty()) return {};
        const auto mishap = core_.befall(mishaps, kNoticed);
        if (!mishap) return tl::unexpected(mishap.error());
        const auto sweep = core_.received();
        if (!sweep) return tl::unexpected(sweep.error());
        const Ended ended = endedAs(*sweep, program().waveform.rest);
        addMishap(report_, *mishap, *sweep, ended);
        trouble_ = (mishap->fault.empty() ? "No fault was noticed." : mishap->fault) + " " + inWords(ended);
        return {};
    }

    /// What is wrong with what was received; empty: nothing.
    std::string trouble() const {
        if (!trouble_.empty()) return trouble_;
        if (outcome_ && !asIntended(*outcome_))
            return "The emulated rig received something else than the plan states: " +
                   devices::verdict(outcome_->light) + ". The report tells it slot by slot.";
        return {};
    }
    const json& report() const { return report_; }

private:
    const Program& program() const { return project_.compiled.program; }

    Result<void> readSimulated(const Played& played) {
        if (!played.state) return {};  // nobody measures what real devices gave
        if (played.state->hashShown != contentHash(program())) {
            return fail(Fault::device, "The simulated devices show another program than the one that was sent; nothing "
                                       "about this run can be trusted. Run it again, and report it if it stays.");
        }
        const auto compared = receivedAgainstIntended(core_, program());
        if (!compared) return tl::unexpected(compared.error());
        report_["received"] = *compared;
        return {};
    }

    /// From sending to first light where a program plays already: a changed tile, and back to the program.
    Result<void> timeUpdate() {
        Program changed = program();
        LightImage& image = changed.images.front();
        const int column = image.columns() / 2, row = image.rows() / 2;
        image.setTile(column, row, uniformTile(image.isUniform(column, row, 255) ? 0 : 255));
        if (const auto there = core_.update(changed); !there) return tl::unexpected(there.error());
        const auto back = core_.update(program());
        if (!back) return tl::unexpected(back.error());
        report_["sent_to_first_light_ms"] = *back;
        return {};
    }

    Result<void> readEmulated() {
        if (const auto timed = timeUpdate(); !timed) return timed;
        std::this_thread::sleep_for(kWholeSweeps);
        auto sweep = core_.received();
        if (!sweep) return tl::unexpected(sweep.error());
        outcome_ = outcomeOf(*std::move(sweep), program(), project_.compiled.document.rig);
        addOutcome(report_, *outcome_);
        std::cout << verdict(*outcome_) << '\n';
        return {};
    }

    const RunOptions& options_;
    const Prepared& project_;
    OwnCore& core_;
    std::optional<Outcome> outcome_;
    std::string trouble_;
    json report_;
};

}  // namespace

int runCommand(const RunOptions& options) {
    const auto mishaps = mishapsOf(options);
    const auto arguments = mishaps.and_then([&](const auto&) { return coreArguments(options.rig); });
    if (!arguments) {
        refused("run", arguments.error());
        return kUsage;
    }
    const auto project = prepared(options.file, options.rig);
    if (!project) return refused("run", project.error());
    auto core = OwnCore::start(options.coreProgram, *arguments);
    if (!core) return refused("run", core.error());

    Run run(options, *project, **core);
    const auto done =
        run.played().and_then([&] { return run.befall(*mishaps); }).and_then([&] { return run.pictures(); });
    json report = run.report();
    if (report.is_null()) report = {{"file", options.file}};  // a report of an earlier run must not pass for this one's
    if (!done) report["failed"] = done.error().what;
    if (const auto written = writeReport(options.report, report); !written) return refused("run", written.error());
    if (!done) return refused("run", done.error());
    if (!run.trouble().empty()) return refused("run", {Fault::device, run.trouble()});
    return kDone;
}

}  // namespace ilf::app
