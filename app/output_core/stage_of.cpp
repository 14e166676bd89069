#include "app/output_core/stage_of.h"

#include <cstdlib>
#include <utility>

#include "app/output_core/events.h"
#include "app/output_core/log.h"
#include "app/output_core/rest_current.h"
#include "app/output_core/stage_mark.h"
#include "app/output_core/unplayable_stage.h"
#include "app/output_core/usb_place.h"
#include "devices/dlpc350/lightcrafter.h"
#include "devices/plugin/plugin_stage.h"
#include "devices/rig/any_projector_stage.h"
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
    MarkedStage(std::unique_ptr<devices::Stage> stage, Dioptre rest, std::filesystem::path runtimeDirectory)
        : directory_(std::move(runtimeDirectory)), rest_(rest), next_(rest), stage_(std::move(stage)) {}
    Result<void> load(const Program& program) override {
        next_ = program.waveform.rest;
        return stage_->load(program);
    }
    Result<void> swap() override {
        // First: lenses go there on the way.
        if (std::exchange(rest_, next_) != next_) markStage(directory_, rest_);
        return stage_->swap();
    }
    Result<void> heartbeat() override { return stage_->heartbeat(); }
    void safeLight() noexcept override { stage_->safeLight(); }
    devices::StageReport report() const override { return stage_->report(); }
    std::string name() const override { return stage_->name(); }

private:
    std::filesystem::path directory_;
    Dioptre rest_, next_;
    std::unique_ptr<devices::Stage> stage_;
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
    const auto usb = std::make_shared<UsbPlaces>(played.tapes);
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
    const Dioptre rest = rig.rest;
    return std::make_unique<MarkedStage>(std::make_unique<devices::LightCrafterStage>(std::move(rig)), rest, directory);
}

Result<std::unique_ptr<devices::Stage>> rehearsal(const PlayedRig& played) {
    auto video = devices::displayOutput({played.rig.devices->display, played.rig.projector});
    if (!video) return tl::unexpected(video.error());
    return devices::AnyProjectorStage::open(*std::move(video), devices::StagePurpose::rehearsal);
}

/// A call into a vendor's library that never returns leaves slots that nobody watches: this process ends, and the next
/// one makes light safe first.
void endHanging(const std::string& sentence) {
    note(event::kPlayerHangs, sentence);
    std::_Exit(1);
}

std::unique_ptr<devices::Stage> pluginStage(const PlayedRig& played, const std::filesystem::path& directory) {
    const RigDevices wired = *played.rig.devices;
    const auto usb = std::make_shared<UsbPlaces>(played.tapes);
    devices::PluginRig rig;
    rig.openProjector = [wired] {
        devices::HangingCall hanging;
        hanging.noticed = endHanging;
        return devices::openedPlugin(wired.projectorPlugin, wired.projectorAt, wired.projectorOptions,
                                     devices::Clock::steady(), std::move(hanging));
    };
    rig.openLens = [usb, wired](Dioptre rest) { return openedLenses(*usb, wired, rest, false); };
    rig.bits = played.rig.bits;
    return std::make_unique<MarkedStage>(std::make_unique<devices::PluginStage>(std::move(rig)), markedRest(directory),
                                         directory);
}

Result<std::unique_ptr<devices::Stage>> playable(const PlayedRig& played, const std::filesystem::path& directory) {
    if (played.machine == Machine::simulated) return std::make_unique<ConnectedStage>(directory);
    if (played.rig.devices->rehearsal) return rehearsal(played);
    if (!played.rig.devices->projectorPlugin.empty()) return pluginStage(played, directory);
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
