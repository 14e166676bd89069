// The stage made of a vendor's projector, through its plugin, and the lenses: who is told what, in which order.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "devices/plugin/loaded_plugin.h"
#include "devices/rig/known_device.h"
#include "devices/rig/lens_side.h"

namespace ilf::devices {

/// What a stage is made of. Devices are opened when they are first needed and again after they were lost.
struct PluginRig {
    std::function<Result<std::unique_ptr<PluginProjector>>()> openProjector;
    /// Opens the lenses at rest at this power; refuses where no calibration says what current gives it.
    LensSide::Open openLens;
    int bits = 8;  ///< of one slot's picture
    Clock clock = Clock::steady();
    std::string name = "projector plugin and lenses";
};

/// The projector keeps the time and gives a pulse at each start of a sweep, which the lenses follow. The order of a
/// start: steady white; lenses to their sweep, until they are predicted to be settled; the projector's slots, white in
/// every one, so that its pulses can be heard; the sweep locked to them; the program's pictures. A program with the
/// same wave, slots and delay is sent by `load` beside what plays, and `swap` is one call. Another wave goes through
/// white slots, another slot rate through steady white.
///
/// Any error of a device ends in safe light before it is returned, and only a new `load` and `swap` lights slots again;
/// so does a frame that was dropped, an underrun or a lost trigger while slots are lit. A projector whose safe state
/// could not be told is let go and opened again, at most once a second, by `heartbeat` and `safeLight`.
class PluginStage : public Stage {
public:
    explicit PluginStage(PluginRig rig) : rig_(std::move(rig)), lens_(rig_.openLens, rig_.clock) {}
    ~PluginStage() override;

    Result<void> load(const Program& program) override;
    Result<void> swap() override;
    Result<void> heartbeat() override;
    void safeLight() noexcept override;
    StageReport report() const override;
    std::string name() const override {
        return rig_.name + ", through a plugin; tested with a loopback plugin, never with a vendor's SDK";
    }

    /// When the first light of the program swapped in last had begun, in the rig's clock.
    std::chrono::nanoseconds lightBegan() const { return lightBegan_; }

private:
    enum class Light { unknown, white, slotted };
    struct Loaded {
        Program program;
        PluginConfiguration how;
        std::vector<Image<std::uint8_t>> pictures;  ///< one for each slot; equal ones share their pixels
        bool uploaded = false;
    };

    bool playsLikeLoaded() const;
    Result<void> began();
    Result<void> reached(Dioptre rest);
    Result<void> uploaded(const std::vector<Image<std::uint8_t>>& pictures);
    Result<void> swapped();
    Result<void> slotsRun(const PluginConfiguration& how);
    Result<void> confirmed();
    Result<void> projectorWell();
    Result<void> countsWell(const PluginStatus& now);
    Result<void> reachedAgain();
    Result<void> openedProjector();
    Result<void> whiteInSlots(const PluginConfiguration& how);
    void makeSafe();
    tl::unexpected<Error> faulted(Error error);
    std::string projectorDoes() const;

    PluginRig rig_;
    LensSide lens_;
    std::unique_ptr<PluginProjector> projector_;  ///< none: not opened, or lost
    KnownDevice known_{"projector", "projector"};
    std::optional<std::chrono::nanoseconds> triedAt_;

    Light light_ = Light::unknown;
    bool safeTold_ = false;                       ///< to all that can be reached, and nothing else since
    std::optional<Error> safeTrouble_;            ///< what first did not listen then
    std::optional<PluginConfiguration> running_;  ///< none: steady white
    std::uint64_t program_ = 0;                   ///< swapped in last; each gets the next number
    std::optional<Loaded> loaded_;
    std::optional<PluginStatus> status_;     ///< the last
    std::optional<PluginStatus> slottedAt_;  ///< when slots came on
    std::chrono::nanoseconds lightBegan_{0};
};

}  // namespace ilf::devices
