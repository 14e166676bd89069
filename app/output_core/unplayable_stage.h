// The stage of a rig that cannot be played: plays nothing, and says why.
#pragma once

#include <string>
#include <utility>

#include "devices/stage.h"

namespace ilf::app {

/// Never falls back to simulated light: an operator would take it for the room's.
class UnplayableStage : public devices::Stage {
public:
    UnplayableStage(Error why, bool emulated) : why_(std::move(why)), emulated_(emulated) {}

    Result<void> load(const Program&) override { return tl::unexpected(why_); }
    Result<void> swap() override { return tl::unexpected(why_); }
    Result<void> heartbeat() override { return tl::unexpected(why_); }
    void safeLight() noexcept override {}
    devices::StageReport report() const override {
        devices::StageReport report;
        report.projectorLine = why_.what;
        report.lensLine = report.lensName = "no lenses";
        report.simulated = report.emulated = emulated_;
        report.devices = {{"projector", devices::DeviceHealth::absent, "projector", why_.what}};
        return report;
    }
    std::string name() const override { return "nothing: " + why_.what; }

private:
    Error why_;
    bool emulated_;
};

}  // namespace ilf::app
