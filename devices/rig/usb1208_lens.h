// The lenses of a stage on the outputs of a USB-1208FS-Plus, in step with the projector's triggers.
#pragma once

#include <memory>
#include <optional>

#include "devices/rig/stage_lens.h"
#include "devices/usb1208/sweep_sync.h"

namespace ilf::devices {

/// Both lenses play the same wave. Temperatures are not known: the box has no sensor for them.
class Usb1208Lens : public StageLens {
public:
    /// `rest` is the power that `setup`'s resting currents give.
    static Result<std::unique_ptr<StageLens>> open(std::shared_ptr<UsbLink> link, const LensOutputSetup& setup,
                                                   Dioptre rest, Clock clock = Clock::steady(), EdgeLevels levels = {});

    Result<Second> play(const Waveform& wave, Second triggerAhead) override;
    Result<PhaseState> follow() override;
    Result<LensCondition> heartbeat() override;
    Result<void> safe() override;
    Dioptre rest() const override { return rest_; }
    std::string name() const override { return "lenses on the USB-1208FS-Plus at USB " + link_->identity().path; }

private:
    Usb1208Lens(std::shared_ptr<UsbLink> link, std::unique_ptr<LensOutput> output, Dioptre rest, Clock clock,
                EdgeLevels levels);
    Result<void> listening();

    std::shared_ptr<UsbLink> link_;
    Dioptre rest_;
    Clock clock_;
    EdgeLevels levels_;
    double target_ = 0.0;
    std::unique_ptr<LensOutput> output_;
    std::unique_ptr<AnalogInput> input_;  ///< none until the triggers are to be heard
    std::optional<SweepSync> sync_;       ///< last: it refers to both
};

}  // namespace ilf::devices
