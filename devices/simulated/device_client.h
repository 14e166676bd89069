// The client of the simulated devices' process, and of an emulated rig's: for the stage, the supervisor and tests.
#pragma once

#include <chrono>
#include <filesystem>

#include "devices/link/channel.h"
#include "devices/simulated/device_port.h"

namespace ilf::devices {

class DeviceClient : public DevicePort {
public:
    explicit DeviceClient(const std::filesystem::path& runtimeDirectory,
                          std::chrono::milliseconds timeout = std::chrono::milliseconds(350));

    Result<Body> call(const Body& request) override;
    std::int64_t nowNs() override;
    void waitUntil(std::int64_t time_ns) override;

    Result<DeviceState> readState() { return ask<DeviceState>(*this, Read{}); }
    Result<SlotImage> readSlot(int slot) { return ask<SlotImage>(*this, ReadSlot{slot}); }
    /// Of an emulated rig: takes hold of its newest whole sweep, and then the light of one of its exposures.
    Result<Received> readReceived() { return ask<Received>(*this, ReadReceived{}); }
    Result<ExposedLight> readExposure(int number) { return ask<ExposedLight>(*this, ReadExposure{number}); }
    Result<Done> mishap(const RigMishap& mishap) { return ask<Done>(*this, mishap); }
    /// Steady light, lens to rest; tried three times.
    Result<void> safeLight();

private:
    Client client_;
    std::chrono::milliseconds timeout_;
    std::uint64_t lastId_ = 0;
};

}  // namespace ilf::devices
