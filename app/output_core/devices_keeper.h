// Keeps the devices' process of a simulated or emulated rig running; real devices need none.
#pragma once

#include <chrono>
#include <optional>

#include "app/output_core/start_role.h"
#include "devices/simulated/device_client.h"

namespace ilf::app {

class DevicesKeeper {
public:
    explicit DevicesKeeper(const CoreSetup& setup) : setup_(setup), client_(setup.runtimeDirectory) {}

    /// Starts it, if it does not run, and waits until it is ready or has failed.
    void start();
    /// Starts it again some time after it went; never waits. True once after an emulated rig became another one, whose
    /// bus and display nobody sees who was started before.
    bool watch();
    /// What processes need to see the emulated rig; empty while there is none, and for other rigs.
    const Environment& environment() const { return environment_; }
    /// Simulated devices: steady light, lens to rest. Others listen to nobody but who plays on them.
    void makeSafe();
    void stop();

private:
    using Clock = std::chrono::steady_clock;
    bool needed() const { return setup_.played.machine != Machine::real; }
    bool emulated() const { return setup_.played.machine == Machine::emulated; }
    bool runs() const;
    void startProcess();
    bool ready();
    bool sawAnother();

    const CoreSetup& setup_;
    devices::DeviceClient client_;
    Environment environment_;
    std::optional<Clock::time_point> gone_;
    std::chrono::milliseconds back_{};  ///< how long it may be gone before it is started again
};

}  // namespace ilf::app
