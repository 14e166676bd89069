#include "app/measure/measure_place.h"

#include <cmath>
#include <cstdlib>
#include <sstream>
#include <utility>

#include "app/output_core/usb_place.h"
#include "app/rigs.h"
#include "devices/dlpc350/lightcrafter.h"
#include "devices/emulated_bench/emulated_bench.h"
#include "devices/measure/projector_flashes.h"
#include "devices/rig/pattern_frames.h"
#include "devices/usb1208/messages.h"
#include "devices/video/display_output.h"

namespace ilf::app {
namespace {

using devices::MeasureStep;

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

std::size_t indexOf(Eye eye) { return eye == Eye::left ? 0 : 1; }

/// As a lensmeter would tell them: hundredths of a dioptre.
std::vector<StaticPower> emulatedLensmeter(const devices::EmulatedBench& bench, Eye eye) {
    std::vector<StaticPower> known;
    for (const double current_A : {-0.06, -0.03, 0.0, 0.03, 0.06, 0.09, 0.11}) {
        const double power_D = bench.truthAtRest(static_cast<int>(indexOf(eye)), current_A);
        known.push_back({Ampere::fromSi(current_A), Dioptre::fromSi(0.01 * std::round(100.0 * power_D))});
    }
    return known;
}

}  // namespace

struct MeasurePlace::Parts {
    std::unique_ptr<devices::EmulatedBench> emulated;
    UsbPlaces usb;
    std::unique_ptr<devices::ProjectorFlashes> flashes;  ///< of a real projector
    std::shared_ptr<devices::UsbLink> link;
    devices::Clock clock = devices::Clock::steady();
};

bool onEmulatedBench(const std::string& word) { return isEmulatedRig(word); }

Result<void> measurable(const std::string& word, const Rig& rig) {
    if (onEmulatedBench(word)) return {};
    if (!rig.devices)
        return fail(Fault::unsupported,
                    "This rig names no devices that could be measured; choose a rig's file that does, "
                    "or --rig emulated.");
    if (rig.devices->rehearsal)
        return fail(Fault::unsupported,
                    "This rig is for rehearsing masks and has no lenses to be measured; choose a rig's file that "
                    "names lenses.");
    return {};
}

Result<std::vector<StaticPower>> knownPowers(std::istream& lines, const std::string& name) {
    std::vector<StaticPower> known;
    int number = 0;
    for (std::string line; std::getline(lines, line);) {
        ++number;
        std::istringstream cells(line);
        double current_mA = 0.0, power_D = 0.0;
        char comma = 0;
        if (!(cells >> current_mA)) continue;
        if (!(cells >> comma >> power_D) || comma != ',' || !std::isfinite(current_mA) || !std::isfinite(power_D))
            return fail(Fault::badFile,
                        "\"" + name + "\" line " + std::to_string(number) + " is not \"milliamperes, dioptres\".");
        known.push_back({Ampere::fromSi(1e-3 * current_mA), Dioptre::fromSi(power_D)});
    }
    return known;
}

MeasurePlace::MeasurePlace(MeasureOrder order) : order_(std::move(order)), parts_(std::make_unique<Parts>()) {}
MeasurePlace::~MeasurePlace() = default;

devices::EmulatedBench* MeasurePlace::bench() { return parts_->emulated.get(); }

Result<void> MeasurePlace::openedBench(devices::RigMeasurementSetup& setup) {
    parts_->emulated = std::make_unique<devices::EmulatedBench>();
    parts_->link = parts_->emulated->link();
    parts_->clock = parts_->emulated->clock();
    setup.known = emulatedLensmeter(*parts_->emulated, order_.eye);
    setup.temperature_C = [bench = parts_->emulated.get(), eye = indexOf(order_.eye)] {
        return bench->lenses[eye].temperature_C();
    };
    return {};
}

Result<void> MeasurePlace::openedDevices(devices::RigMeasurementSetup& setup) {
    if (!order_.temperature_C)
        return fail(Fault::outOfRange,
                    "Say how warm the lens is (--temperature, degrees C): its powers drift by 0.03 D "
                    "for each degree.");
    setup.temperature_C = [warm = *order_.temperature_C] { return warm; };
    auto link = parts_->usb.link({{devices::usb1208::kVendor, devices::usb1208::kProduct}, "USB-1208FS-Plus"},
                                 order_.rig.devices->lensesAt, 0);
    if (!link) return tl::unexpected(link.error());
    parts_->link = *std::move(link);
    if (!order_.projector) return {};
    auto flashes = flashesOf(order_.rig, parts_->usb);
    if (!flashes) return tl::unexpected(std::move(flashes.error()));
    parts_->flashes = *std::move(flashes);
    setup.flashes = [flashing = parts_->flashes.get()](bool on) { return flashing->flash(on); };
    return {};
}

Result<std::unique_ptr<MeasurePlace>> MeasurePlace::open(const MeasureOrder& order, std::function<bool()> stop,
                                                         devices::MeasureWatch watch) {
    if (auto may = measurable(order.word, order.rig); !may) return tl::unexpected(std::move(may.error()));
    std::unique_ptr<MeasurePlace> place(new MeasurePlace(order));
    const bool bench = onEmulatedBench(order.word);
    // What hangs on an emulated bus is no lens either.
    place->simulated_ = bench || std::getenv("UMOCKDEV_DIR") != nullptr;
    devices::RigMeasurementSetup setup;
    if (place->simulated_) setup.provenance = Provenance::simulated;
    setup.devices = *order.rig.devices;
    setup.eye = order.eye;
    setup.rate = order.rate;
    setup.lensMin = order.rig.lensMin;
    setup.lensMax = order.rig.lensMax;
    setup.waves = order.waves;
    setup.stop = std::move(stop);
    setup.watch = std::move(watch);
    auto opened = bench ? place->openedBench(setup) : place->openedDevices(setup);
    if (!opened) return tl::unexpected(std::move(opened.error()));
    if (order.known) setup.known = *order.known;
    if (setup.known.size() < 2)
        return fail(Fault::outOfRange,
                    "Say at least two powers of the lens that are known (--known FILE, milliamperes and "
                    "dioptres a line): a photodiode alone knows no dioptres.");
    place->known_ = setup.known;
    place->measurement_ =
        std::make_unique<devices::RigMeasurement>(place->parts_->link, std::move(setup), place->parts_->clock);
    return place;
}

std::vector<MeasureStep> MeasurePlace::steps() const {
    std::vector<MeasureStep> steps;
    if (order_.projector) steps.push_back(MeasureStep::projector);
    steps.insert(steps.end(), std::begin(devices::kLensSteps), std::end(devices::kLensSteps));
    return steps;
}

void MeasurePlace::connected(MeasureStep step) {
    devices::EmulatedBench* bench = parts_->emulated.get();
    if (bench == nullptr) return;
    const bool projector = step == MeasureStep::projector;
    bench->ai0 = projector                 ? devices::Heard::trigger
                 : order_.eye == Eye::left ? devices::Heard::left
                                           : devices::Heard::right;
    bench->lensInBeam = static_cast<int>(indexOf(order_.eye));
    bench->photodiode.lit = step != MeasureStep::dark;
    bench->projectorLight = nullptr;
    // A flash of two milliseconds, 0.46 ms (the paper's) after its trigger.
    if (projector)
        bench->projectorLight = [](double since_s) { return since_s >= 0.46e-3 && since_s < 2.46e-3 ? 2.0 : 0.0; };
}

}  // namespace ilf::app
