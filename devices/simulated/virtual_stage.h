// The simulated stage inside one process with a clock that jumps: for tests and benchmarks of what plays on it.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "devices/simulated/machine.h"
#include "devices/simulated/simulated_stage.h"

namespace ilf::devices {

/// Orders reach the machine by a call; waiting moves the clock.
class VirtualPort : public DevicePort {
public:
    std::function<bool(const Body&)> failsAt;  ///< asked before each order; true: the order is lost
    Second loadTime;                           ///< how long an upload takes on the virtual clock
    std::vector<std::string> log;              ///< every order, lost ones too

    Result<Body> call(const Body& request) override;
    std::int64_t nowNs() override { return nowNs_; }
    void waitUntil(std::int64_t time_ns) override;

    Machine machine;

private:
    std::int64_t nowNs_ = 1'000'000'000;
};

class VirtualStage : public Stage {
public:
    VirtualPort port;

    Result<void> load(const Program& program) override { return stage_.load(program); }
    Result<void> swap() override { return stage_.swap(); }
    Result<void> heartbeat() override { return stage_.heartbeat(); }
    void safeLight() noexcept override { stage_.safeLight(); }
    StageReport report() const override { return stage_.report(); }
    std::string name() const override { return stage_.name(); }

    DeviceState state() { return port.machine.state(port.nowNs()); }

private:
    SimulatedStage stage_{port};
};

}  // namespace ilf::devices
