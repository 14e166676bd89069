#include "app/output_core/stage_of.h"

#include <utility>

#include "app/output_core/rest_current.h"
#include "app/output_core/stage_mark.h"
#include "app/output_core/unplayable_stage.h"
#include "app/output_core/usb_place.h"
#include "devices/dlpc350/lightcrafter.h"
#include "devices/rig/lightcrafter_stage.h"
#include "devices/rig/pattern_frames.h"
#include "devices/rig/usb1208_lens.h"
#include "devices/simulated/device_client.h"
#include "devices/simulated/simulated_stage.h"
#include "devices/usb1208/messages.h"
#include "devices/video/display_output.h"

namespace ilf::app {
namespace {

constexpr UsbKind kLightCrafter{{devices::dlpc350::LightCrafter::kVendor, devices::dlpc350::LightCrafter::kProduct},
                                "LightCrafter 4500"};
constexpr UsbKind kConverter{{devices::usb1208::kVendor, devices::usb1208::kProduct}, "USB-1208FS-Plus"};
constexpr int kConverterInterface = 0;
/// Emulated devices share the processors with all else, builds included: 120 ms of samples wait instead of 40.
constexpr int kEmulatedTransfers = 12;

/// The simulated stage with the connection it plays over.
class ConnectedStage : public devices::Stage {
public:
    explicit ConnectedStage(const std::filesystem::path& runtimeDirectory) : client_(runtimeDirectory) {}
    Result<void> load(const Program& program) override { return stage_.load(program); }
    Result<void> swap() override { return stage_.swap(); }
    Result<void> heartbeat() override { return stage_.heartbeat(); }
    void safeLight() noexcept override { stage_.safeLight(); }
    devices::StageReport report() const override { return stage_.report(); }
    std::string name() const override { return stage_.name(); }

private:
    devices::DeviceClient client_;
    devices::SimulatedStage stage_{client_};
};

/// Marks where this wearer's lenses rest, for whoever comes after a player that was killed.
class MarkedStage : public devices::Stage {
public:
    MarkedStage(devices::LightCrafterRig rig, std::filesystem::path runtimeDirectory)
        : directory_(std::move(runtimeDirectory)), rest_(rig.rest), next_(rest_), stage_(std::move(rig)) {}
    Result<void> load(const Program& program) override {
        next_ = program.waveform.rest;
        return stage_.load(program);
    }
    Result<void> swap() override {
        // First: lenses go there on the way.
        if (std::exchange(rest_, next_) != next_) markStage(directory_, rest_);
        return stage_.swap();
    }
    Result<void> heartbeat() override { return stage_.heartbeat(); }
    void safeLight() noexcept override { stage_.safeLight(); }
    devices::StageReport report() const override { return stage_.report(); }
    std::string name() const override { return stage_.name(); }

private:
    std::filesystem::path directory_;
    Dioptre rest_, next_;
    devices::LightCrafterStage stage_;
};

Result<std::unique_ptr<devices::StageProjector>> openedProjector(UsbPlaces& usb, const std::string& place) {
    auto link = usb.link(kLightCrafter, place, devices::dlpc350::LightCrafter::kInterface);
    if (!link) return tl::unexpected(link.error());
    auto board = devices::dlpc350::LightCrafter::open(*std::move(link), devices::Clock::steady());
    if (!board) return tl::unexpected(board.error());
    return std::make_unique<devices::LightCrafterProjector>(*std::move(board));
}

Result<std::unique_ptr<devices::StageLens>> openedLenses(UsbPlaces& usb, const RigDevices& wired, Dioptre rest,
                                                         bool emulated) {
    const auto left = restCurrent(wired.left, rest, "left lens"), right = restCurrent(wired.right, rest, "right lens");
    if (!left) return tl::unexpected(left.error());
    if (!right) return tl::unexpected(right.error());
    auto link = usb.link(kConverter, wired.lensesAt, kConverterInterface);
    if (!link) return tl::unexpected(link.error());
    devices::LensOutputSetup setup;
    if (emulated) setup.transfersInFlight = kEmulatedTransfers;
    setup.channels.left = {wired.left.amplifier, *left};
    setup.channels.right = {wired.right.amplifier, *right};
    return devices::Usb1208Lens::open(*std::move(link), setup, rest, devices::Clock::steady(),
                                      {wired.triggerLow, wired.triggerHigh});
}

Result<std::unique_ptr<devices::Stage>> lightCrafterStage(const PlayedRig& played,
                                                          const std::filesystem::path& directory) {
    const RigDevices wired = *played.rig.devices;
    auto video = devices::displayOutput({wired.display, played.rig.projector});
    if (!video) return tl::unexpected(video.error());
    const auto usb = std::make_shared<UsbPlaces>();
    devices::LightCrafterRig rig;
    rig.openProjector = [usb, wired] { return openedProjector(*usb, wired.projectorAt); };
    rig.openLens = [usb, wired, emulated = played.machine == Machine::emulated](Dioptre rest) {
        return openedLenses(*usb, wired, rest, emulated);
    };
    rig.video = *std::move(video);
    rig.packed = devices::patternFrames(played.rig.bits);
    rig.emulated = played.machine == Machine::emulated;
    if (rig.emulated) rig.name = "emulated LightCrafter 4500 and lenses";
    rig.rest = markedRest(directory);
    return std::make_unique<MarkedStage>(std::move(rig), directory);
}

Result<std::unique_ptr<devices::Stage>> playable(const PlayedRig& played, const std::filesystem::path& directory) {
    if (played.machine == Machine::simulated) return std::make_unique<ConnectedStage>(directory);
    if (played.rig.kind == ProjectorKind::highSpeed)
        return fail(Fault::unsupported,
                    "A projector of the 1000 Hz class is driven by its maker's software, through a plugin, and this "
                    "rig names none: nothing is played. Choose a LightCrafter 4500, or --rig simulated.");
    if (played.machine == Machine::emulated)
        if (const auto sees = seesEmulatedRig(directory); !sees) return tl::unexpected(sees.error());
    return lightCrafterStage(played, directory);
}

}  // namespace

std::unique_ptr<devices::Stage> stageOf(const PlayedRig& played, const std::filesystem::path& runtimeDirectory) {
    auto stage = playable(played, runtimeDirectory);
    if (stage) return *std::move(stage);
    return std::make_unique<UnplayableStage>(stage.error(), played.machine == Machine::emulated);
}

}  // namespace ilf::app
