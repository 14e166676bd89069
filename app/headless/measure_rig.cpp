#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <charconv>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <sstream>

#include "app/exit_code.h"
#include "app/headless/measure_command.h"
#include "app/headless/prepare.h"
#include "app/lens/lens_planner.h"
#include "app/output_core/usb_place.h"
#include "app/words.h"
#include "core/lens/shaped_wave.h"
#include "devices/dlpc350/lightcrafter.h"
#include "devices/emulated_bench/emulated_bench.h"
#include "devices/measure/projector_flashes.h"
#include "devices/measure/rig_measurement.h"
#include "devices/rig/pattern_frames.h"
#include "devices/usb1208/messages.h"
#include "devices/video/display_output.h"
#include "ilf/version.h"
#include "projects/wave_database.h"
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

/// Lines of milliamperes and dioptres; those that do not begin with a number are headings or remarks.
Result<std::vector<StaticPower>> knownPowers(const std::string& file) {
    std::ifstream in(file);
    if (!in)
        return fail(Fault::notFound, "\"" + file + "\" cannot be opened; it should list milliamperes and dioptres.");
    std::vector<StaticPower> known;
    int number = 0;
    for (std::string line; std::getline(in, line);) {
        ++number;
        std::istringstream cells(line);
        double current_mA = 0.0, power_D = 0.0;
        char comma = 0;
        if (!(cells >> current_mA)) continue;
        if (!(cells >> comma >> power_D) || comma != ',' || !std::isfinite(current_mA) || !std::isfinite(power_D))
            return fail(Fault::badFile,
                        "\"" + file + "\" line " + std::to_string(number) + " is not \"milliamperes, dioptres\".");
        known.push_back({Ampere::fromSi(1e-3 * current_mA), Dioptre::fromSi(power_D)});
    }
    return known;
}

Result<void> writable(const std::string& file, bool replace) {
    std::error_code ignored;
    if (replace || file.empty() || !std::filesystem::exists(file, ignored)) return {};
    return fail(Fault::cannotWrite, "\"" + file + "\" is there already; choose another name, or --replace it.");
}

/// What is measured: devices on the USB, or a bench that is emulated. The emulated operator connects what each step
/// asks.
struct Place {
    std::unique_ptr<devices::EmulatedBench> emulated;
    UsbPlaces usb;
    std::shared_ptr<devices::UsbLink> link;
    std::unique_ptr<devices::ProjectorFlashes> flashes;  ///< of a real projector
    devices::Clock clock = devices::Clock::steady();

    void connected(MeasureStep step, Eye eye) const {
        if (!emulated) return;
        const bool projector = step == MeasureStep::projector;
        emulated->ai0 = projector          ? devices::Heard::trigger
                        : eye == Eye::left ? devices::Heard::left
                                           : devices::Heard::right;
        emulated->lensInBeam = eye == Eye::left ? 0 : 1;
        emulated->photodiode.lit = step != MeasureStep::dark;
        emulated->projectorLight = nullptr;
        // A flash of two milliseconds, 0.46 ms (the paper's) after its trigger.
        if (projector)
            emulated->projectorLight = [](double since_s) {
                return since_s >= 0.46e-3 && since_s < 2.46e-3 ? 2.0 : 0.0;
            };
    }
};

Result<std::unique_ptr<devices::ProjectorFlashes>> flashesOf(const Rig& rig, UsbPlaces& usb) {
    using Board = devices::dlpc350::LightCrafter;
    if (rig.kind != ProjectorKind::lightCrafter4500)
        return fail(Fault::unsupported,
                    "Only a LightCrafter 4500 can be made to flash by this version; leave its delay as "
                    "it is (--no-projector).");
    auto video = devices::displayOutput({rig.devices->display, rig.projector});
    if (!video) return tl::unexpected(std::move(video.error()));
    devices::LightCrafterRig parts;
    parts.openProjector = [&usb, at = rig.devices->projectorAt]() -> Result<std::unique_ptr<devices::StageProjector>> {
        auto link = usb.link({{Board::kVendor, Board::kProduct}, "LightCrafter 4500"}, at, Board::kInterface);
        if (!link) return tl::unexpected(std::move(link.error()));
        auto board = Board::open(*std::move(link), devices::Clock::steady());
        if (!board) return tl::unexpected(std::move(board.error()));
        return std::make_unique<devices::LightCrafterProjector>(*std::move(board));
    };
    parts.video = *std::move(video);
    parts.packed = devices::patternFrames(rig.bits);
    return std::make_unique<devices::ProjectorFlashes>(std::move(parts),
                                                       devices::FlashSetup{rig.projector, rig.sweepRate, rig.slotRate});
}

/// As a lensmeter would tell them: hundredths of a dioptre.
std::vector<StaticPower> emulatedLensmeter(const devices::EmulatedBench& bench, Eye eye) {
    std::vector<StaticPower> known;
    for (const double current_A : {-0.06, -0.03, 0.0, 0.03, 0.06, 0.09, 0.11}) {
        const double power_D = bench.truthAtRest(eye == Eye::left ? 0 : 1, current_A);
        known.push_back({Ampere::fromSi(current_A), Dioptre::fromSi(0.01 * std::round(100.0 * power_D))});
    }
    return known;
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
Result<void> walked(devices::RigMeasurement& measurement, const Place& place, Eye eye,
                    const MeasureRigOptions& options) {
    std::vector<MeasureStep> steps;
    if (!options.withoutProjector) steps.push_back(MeasureStep::projector);
    steps.insert(steps.end(), std::begin(devices::kLensSteps), std::end(devices::kLensSteps));
    devices::MeasureWizard wizard(steps);
    const bool terminal = isatty(STDERR_FILENO) != 0;
    while (const auto step = wizard.step()) {
        const auto words = devices::wordsOf(*step, eye);
        std::cout << wizard.number() + 1 << " of " << steps.size() << ": " << words.title << "\n   " << words.connect
                  << "\n   Expected: " << words.expect << '\n';
        const bool nothingToDo =
            *step != MeasureStep::projector && *step != MeasureStep::dark && *step != MeasureStep::light;
        if (auto ready = asked("   Ready?", options.yes || nothingToDo); !ready) return ready;
        wizard.connected();
        place.connected(*step, eye);
        const auto outcome = measurement.perform(*step, [&](const std::string& what) {
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

projects::WaveFile waveFile(const devices::MeasuredRig& measured, const Rig& rig, const MeasureRigOptions& options,
                            bool emulated) {
    projects::WaveFile file;
    file.lens.emulated = emulated;
    // Not a preset's name alone: no planner shall take these records for what the lens emulator gives.
    file.lens.model = emulated ? "datasheet, on an emulated bench" : options.model;
    file.lens.serial = options.serial;
    file.lens.eye = options.eye == "left" ? "L" : "R";
    file.lens.notes = "static powers, hysteresis " + std::to_string(measured.sweep->hysteresis_D) + " D, drift " +
                      std::to_string(measured.drift_D) + " D";
    file.recordedUtc = utcNow();
    file.method = "photodiode";
    file.software = std::string("illuminatedfocus ") + kVersion;
    file.records = measured.waves;
    if (measured.delay) {
        const auto& delay = measured.delay->delay;
        file.delays.push_back({rig.name, std::to_string(rig.bits) + " bits", delay.median.si(), delay.deviation.si(),
                               static_cast<int>(measured.delay->delay_s.size())});
    }
    return file;
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

Rig withMeasured(Rig rig, const devices::MeasuredRig& measured, const MeasureRigOptions& options, bool emulated) {
    auto& devices = rig.devices.emplace(rig.devices.value_or(RigDevices{}));
    (options.eye == "left" ? devices.left : devices.right).powers = measured.sweep->powers;
    if (measured.delay) rig.projectorDelay = measured.delay->delay.median;
    std::error_code ignored;
    rig.lens = std::filesystem::absolute(options.lens, ignored).string();
    rig.provenance = emulated ? "simulated" : "measured";
    return rig;
}

Result<void> measured(const MeasureRigOptions& options) {
    for (const std::string& file : {options.lens, options.savedRig}) {
        if (auto may = writable(file, options.replace); !may) return may;
    }
    const auto rig = rigFrom(options.rig);
    if (!rig) return tl::unexpected(rig.error());
    if (!rig->devices)
        return fail(Fault::unsupported,
                    "This rig names no devices that could be measured; choose a rig's file that does, "
                    "or --rig emulated.");
    const bool emulated = options.rig == kEmulatedRig;
    const Eye eye = options.eye == "left" ? Eye::left : Eye::right;
    if (!options.yes && isatty(STDIN_FILENO) == 0)
        return fail(Fault::outOfRange, "Nobody is there to be asked: measure on a terminal, or say --yes.");
    Place place;
    devices::RigMeasurementSetup setup;
    // What hangs on an emulated bus is no lens either.
    const bool simulated = emulated || std::getenv("UMOCKDEV_DIR") != nullptr;
    if (simulated) setup.provenance = Provenance::simulated;
    setup.devices = *rig->devices;
    setup.eye = eye;
    setup.rate = Hertz::fromSi(options.rate_Hz);
    setup.lensMin = rig->lensMin;
    setup.lensMax = rig->lensMax;
    setup.waves = options.waves;
    setup.stop = [] { return stopped.load(); };
    if (emulated) {
        place.emulated = std::make_unique<devices::EmulatedBench>();
        place.link = place.emulated->link();
        place.clock = place.emulated->clock();
        setup.known = emulatedLensmeter(*place.emulated, eye);
        setup.temperature_C = [&place, eye] {
            return place.emulated->lenses[eye == Eye::left ? 0 : 1].temperature_C();
        };
    } else {
        if (!options.temperature_C)
            return fail(Fault::outOfRange,
                        "Say how warm the lens is (--temperature, degrees C): its powers drift by 0.03 D "
                        "for each degree.");
        setup.temperature_C = [warm = *options.temperature_C] { return warm; };
        auto link = place.usb.link({{devices::usb1208::kVendor, devices::usb1208::kProduct}, "USB-1208FS-Plus"},
                                   rig->devices->lensesAt, 0);
        if (!link) return tl::unexpected(link.error());
        place.link = *std::move(link);
        if (!options.withoutProjector) {
            auto flashes = flashesOf(*rig, place.usb);
            if (!flashes) return tl::unexpected(std::move(flashes.error()));
            place.flashes = *std::move(flashes);
            setup.flashes = [&place](bool on) { return place.flashes->flash(on); };
        }
    }
    if (!options.known.empty()) {
        auto known = knownPowers(options.known);
        if (!known) return tl::unexpected(known.error());
        setup.known = *std::move(known);
    }
    if (setup.known.size() < 2)
        return fail(Fault::outOfRange,
                    "Say at least two powers of the lens that are known (--known FILE, milliamperes and "
                    "dioptres a line): a photodiode alone knows no dioptres.");
    const StopsOnSignal stops;
    devices::RigMeasurement measurement(place.link, setup, place.clock);
    if (auto walk = walked(measurement, place, eye, options); !walk) return walk;
    projects::WaveFile waves = waveFile(measurement.measured(), *rig, options, simulated);
    if (!options.shape_D.empty()) {
        if (auto learning = learntToo(measurement, waves, options); !learning) return learning;
    }
    if (auto saved = projects::saveWaves(options.lens, waves); !saved) return saved;
    std::cout << options.lens << ": " << waves.records.size() << " waves, "
              << (simulated ? "simulated on an emulated bench, not measured" : "measured") << '\n';
    if (options.savedRig.empty()) return {};
    if (auto saved =
            projects::writeRig(options.savedRig, withMeasured(*rig, measurement.measured(), options, simulated));
        !saved)
        return saved;
    std::cout << options.savedRig << ": the rig with its static powers"
              << (measurement.measured().delay ? ", delay" : "") << " and waves\n";
    return {};
}

}  // namespace

int measureRigCommand(const MeasureRigOptions& options) {
    const auto done = measured(options);
    return done ? kDone : refused("measure rig", done.error());
}

}  // namespace ilf::app
