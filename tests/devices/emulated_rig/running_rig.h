// An emulated rig in this process, in real time, and the stage that plays on it as on a real one.
#pragma once

#include <atomic>
#include <chrono>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "devices/comparison/light_comparison.h"
#include "devices/link/rig_environment.h"
#include "devices/rig/lightcrafter_stage.h"
#include "devices/simulated/device_client.h"
#include "devices/simulated/lens_emulator.h"
#include "devices/usb/usb_bus.h"

namespace ilf::devices::test {

/// Serves on a thread of its own until it is destroyed. With DISPLAY and the bus set as its environment file says.
class RunningRig {
public:
    explicit RunningRig(LensPreset lens = LensPreset::datasheet);
    ~RunningRig();
    RunningRig(const RunningRig&) = delete;
    RunningRig& operator=(const RunningRig&) = delete;

    /// Why there is none; the sentence an operator would read.
    const std::optional<std::string>& refused() const { return refused_; }
    const std::filesystem::path& directory() const { return directory_; }
    DeviceClient& client() { return *client_; }
    bool befalls(const std::string& device, const std::string& kind, std::uint64_t after = 0, std::uint64_t times = 0,
                 double amount = 0.0);
    /// A stage of the unmodified drivers, through libusb and the X server. `bits` a slot.
    std::unique_ptr<LightCrafterStage> stage(int bits);

private:
    std::filesystem::path directory_;
    int stop_ = -1;
    std::optional<std::string> refused_;
    std::unique_ptr<DeviceClient> client_;
    std::atomic<bool> ended_ = false;
    Result<void> served_;
    std::thread server_;
    std::unique_ptr<UsbBus> bus_;
};

/// The light of the newest whole sweep, as the report's comparison takes it.
std::vector<SlotLight> receivedSweep(DeviceClient& client, Received& received);
/// Plays for a while as the player does: a heartbeat every 100 ms. The first error it has.
std::optional<std::string> playedFor(LightCrafterStage& stage, std::chrono::milliseconds time);

}  // namespace ilf::devices::test
