#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iostream>

#include "app/exit_code.h"
#include "app/headless/measure_command.h"
#include "app/headless/prepare.h"
#include "app/lens/lens_planner.h"
#include "app/measure/measured_files.h"
#include "core/lens/shaped_wave.h"
#include "projects/wearer_rig.h"

namespace ilf::app {
namespace {

using devices::MeasureStep;

std::atomic<bool> stopped{false};
static_assert(std::atomic<bool>::is_always_lock_free);

/// Control-C and the like end a measurement with the lenses at rest.
class StopsOnSignal {
public:
    StopsOnSignal() {
        for (std::size_t i = 0; i < 2; ++i)
            before_[i] = std::signal(kSignals[i], [](int) { stopped = true; });
    }
    ~StopsOnSignal() {
        for (std::size_t i = 0; i < 2; ++i)
            std::signal(kSignals[i], before_[i]);
    }
    StopsOnSignal(const StopsOnSignal&) = delete;
    StopsOnSignal& operator=(const StopsOnSignal&) = delete;

private:
    static constexpr int kSignals[] = {SIGINT, SIGTERM};
    void (*before_[2])(int) = {};
};

Result<std::vector<StaticPower>> knownPowersOf(const std::string& file) {
    std::ifstream in(file);
    if (!in)
        return fail(Fault::notFound, "\"" + file + "\" cannot be opened; it should list milliamperes and dioptres.");
    return knownPowers(in, file);
}

Result<void> writable(const std::string& file, bool replace) {
    std::error_code ignored;
    if (replace || file.empty() || !std::filesystem::exists(file, ignored)) return {};
    return fail(Fault::cannotWrite, "\"" + file + "\" is there already; choose another name, or --replace it.");
}

Result<void> asked(const std::string& question, bool yes) {
    if (yes) return {};
    std::cout << question << " [Enter goes on, q ends] " << std::flush;
    std::string answer;
    if (!std::getline(std::cin, answer) || answer == "q" || stopped)
        return fail(Fault::device, "Measuring was ended; nothing was written.");
    return {};
}

/// Every step until all are good. Errors: the operator ended it, or nobody is there to try again.
Result<void> walked(MeasurePlace& place, const MeasureRigOptions& options) {
    const auto steps = place.steps();
    const Eye eye = place.order().eye;
    devices::MeasureWizard wizard(steps);
    const bool terminal = isatty(STDERR_FILENO) != 0;
    while (const auto step = wizard.step()) {
        const auto words = devices::wordsOf(*step, eye);
        std::cout << wizard.number() + 1 << " of " << steps.size() << ": " << words.title << "\n   " << words.connect
                  << "\n   Expected: " << words.expect << '\n';
        if (auto ready = asked("   Ready?", options.yes || !devices::needsHands(*step)); !ready) return ready;
        wizard.connected();
        place.connected(*step);
        const auto outcome = place.measurement().perform(*step, [&](const std::string& what) {
            if (terminal) std::cerr << "\r   " << what << "   " << std::flush;
        });
        if (terminal) std::cerr << "\r                              \r";
        wizard.measured(outcome);
        if (!outcome.measured.empty()) std::cout << "   Measured: " << outcome.measured << '\n';
        if (outcome.good) {
            wizard.next();
            continue;
        }
        std::cout << "   Not good: " << outcome.advice << '\n';
        if (options.yes || stopped) return fail(Fault::device, outcome.advice + " Nothing was written.");
        if (auto again = asked("   Again?", false); !again) return again;
        wizard.retry();
    }
    return {};
}

/// A wave that holds the measured lens at its levels.
Result<void> learntToo(devices::RigMeasurement& measurement, projects::WaveFile& waves,
                       const MeasureRigOptions& options) {
    const Hertz rate = Hertz::fromSi(options.rate_Hz);
    std::vector<double> levels = options.shape_D;
    std::sort(levels.begin(), levels.end());
    const auto holds = holdsFor(levels, usualDuty(levels.size(), rate), 0.5 / 16.0);
    return measurement.withRecorder([&](const RecordLens& record, const DriveLimits& limits) -> Result<void> {
        auto wave = learnt(record, rate, holds, kUsualHarmonics, limits);
        if (!wave) return tl::unexpected(std::move(wave.error()));
        std::cout << "Learnt: a wave that holds " << levels.size() << " levels within " << wave->largestError_D
                  << " D\n";
        waves.shaped.push_back(*std::move(wave));
        return {};
    });
}

Result<void> measured(const MeasureRigOptions& options) {
    for (const std::string& file : {options.lens, options.savedRig}) {
        if (auto may = writable(file, options.replace); !may) return may;
    }
    const auto rig = rigFrom(options.rig);
    if (!rig) return tl::unexpected(rig.error());
    if (auto may = measurable(options.rig, *rig); !may) return may;
    if (!options.yes && isatty(STDIN_FILENO) == 0)
        return fail(Fault::outOfRange, "Nobody is there to be asked: measure on a terminal, or say --yes.");
    MeasureOrder order;
    order.word = options.rig;
    order.rig = *rig;
    order.eye = options.eye == "left" ? Eye::left : Eye::right;
    order.projector = !options.withoutProjector;
    order.rate = Hertz::fromSi(options.rate_Hz);
    order.waves = options.waves;
    order.temperature_C = options.temperature_C;
    order.model = options.model;
    order.serial = options.serial;
    if (!options.known.empty()) {
        auto known = knownPowersOf(options.known);
        if (!known) return tl::unexpected(known.error());
        order.known = *std::move(known);
    }
    const StopsOnSignal stops;
    auto opened = MeasurePlace::open(order, [] { return stopped.load(); }, {});
    if (!opened) return tl::unexpected(opened.error());
    MeasurePlace& place = **opened;
    if (auto walk = walked(place, options); !walk) return walk;
    const devices::MeasuredRig& found = place.measurement().measured();
    projects::WaveFile waves = measuredWaves(found, order, place.simulated());
    if (!options.shape_D.empty()) {
        if (auto learning = learntToo(place.measurement(), waves, options); !learning) return learning;
    }
    if (auto saved = projects::saveWaves(options.lens, waves); !saved) return saved;
    std::cout << options.lens << ": " << waves.records.size() << " waves, "
              << (place.simulated() ? "simulated on an emulated bench, not measured" : "measured") << '\n';
    if (options.savedRig.empty()) return {};
    const Rig measuredRig = withMeasured(*rig, found, order.eye, options.lens, place.simulated());
    if (auto saved = projects::writeRig(options.savedRig, measuredRig); !saved) return saved;
    std::cout << options.savedRig << ": the rig with its static powers" << (found.delay ? ", delay" : "")
              << " and waves\n";
    return {};
}

}  // namespace

int measureRigCommand(const MeasureRigOptions& options) {
    const auto done = measured(options);
    return done ? kDone : refused("measure rig", done.error());
}

}  // namespace ilf::app
