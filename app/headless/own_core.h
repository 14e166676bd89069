// An output core of its own for one headless run, on simulated devices, the emulated rig or a real one.
#pragma once

#include <chrono>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/headless/received_light.h"
#include "core/compile/program.h"
#include "devices/link/core_link.h"
#include "devices/simulated/device_client.h"

namespace ilf::app {

/// What core and devices said at the end of a run.
struct Played {
    devices::Status status;
    std::optional<devices::DeviceState> state;  ///< none: real devices tell nothing of themselves
    double sentToSwapped_ms = 0.0;              ///< the first program's first light, lens and projector started for it
    long sweeps = 0;
};

/// What is left of a show after something befell it.
struct Mishap {
    std::string fault;        ///< what the operator reads; empty: nothing was noticed
    double noticed_ms = 0.0;  ///< from the mishap to the fault's sentence
};

/// Lives in a temporary directory, so that a core that plays a show on this machine is not disturbed; stopped in order
/// (steady light, lens at rest) and removed with the object.
class OwnCore {
public:
    /// `arguments`: which lens and which rig, as illuminatedfocus-core takes them.
    static Result<std::unique_ptr<OwnCore>> start(const std::string& coreProgram,
                                                  const std::vector<std::string>& arguments);
    ~OwnCore();
    OwnCore(const OwnCore&) = delete;
    OwnCore& operator=(const OwnCore&) = delete;

    /// Sends `program`, waits until it is on show, and lets it play.
    Result<Played> play(const Program& program, std::chrono::duration<double> time);
    /// Sends another program while one plays; milliseconds from sending to its first light.
    Result<double> update(const Program& program);
    /// Lets things go wrong, then waits until the core has told a fault and been safe for a while, at most `patience`.
    Result<Mishap> befall(const std::vector<devices::RigMishap>& mishaps, std::chrono::duration<double> patience);

    /// Where its sockets are, for who links to it besides.
    const std::filesystem::path& directory() const { return directory_; }

    /// What the simulated devices show in a slot.
    Result<LightImage> slot(int slot);
    /// What the emulated rig received in its newest whole sweep.
    Result<ReceivedSweep> received();

private:
    OwnCore(std::string coreProgram, std::filesystem::path directory);
    Result<std::int64_t> shown(const Program& program, devices::Why why);

    std::string coreProgram_;
    std::filesystem::path directory_;
    std::unique_ptr<devices::CoreLink> link_;
    std::uint64_t revision_ = 0;
};

}  // namespace ilf::app
