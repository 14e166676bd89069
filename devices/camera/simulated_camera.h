// A camera without hardware: a moving test scene, labelled as simulated, for tests and rehearsal.
#pragma once

#include "devices/camera/camera_source.h"

namespace ilf::devices {

/// 640 x 480 at 30 frames a second: a disc moves over a colour ramp with a little noise.
class SimulatedCamera : public CameraSource {
public:
    Result<std::optional<Frame>> read() override;
    Result<void> lockExposure(bool locked) override;
    std::string name() const override { return "Simulated camera"; }
    std::string id() const override { return kSimulatedCameraId; }

private:
    std::uint64_t number_ = 0;
    Second due_;
    bool locked_ = false;
};

/// The scene as it is `time` after the camera was opened, with `number` as the noise's seed. An unlocked camera's
/// exposure follows the scene, which slowly brightens and dims.
Image<std::uint8_t> simulatedScene(Second time, std::uint64_t number, bool locked);

}  // namespace ilf::devices
