// An output core with simulated devices of its own, for one headless run.
#pragma once

#include <chrono>
#include <filesystem>
#include <memory>
#include <string>

#include "core/compile/program.h"
#include "devices/simulated/device_client.h"
#include "devices/simulated/emulated_lens.h"

namespace ilf::app {

/// What the devices said at the end of a run.
struct Played {
    devices::DeviceState state;
    double sentToSwapped_ms = 0.0;
    long sweeps = 0;
};

/// Lives in a temporary directory, so that a core that plays a show on this machine is not disturbed; stopped in order
/// (steady light, lens at rest) and removed with the object.
class SimulatedCore {
public:
    static Result<std::unique_ptr<SimulatedCore>> start(const std::string& coreProgram, devices::SimulatedLens lens);
    ~SimulatedCore();
    SimulatedCore(const SimulatedCore&) = delete;
    SimulatedCore& operator=(const SimulatedCore&) = delete;

    /// Sends `program`, waits until it is on show, and lets it play.
    Result<Played> play(const Program& program, std::chrono::duration<double> time);
    /// What the devices show in a slot.
    Result<LightImage> slot(int slot);

private:
    SimulatedCore(std::string coreProgram, std::filesystem::path directory);
    std::string coreProgram_;
    std::filesystem::path directory_;
};

}  // namespace ilf::app
