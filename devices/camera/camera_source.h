// Whatever gives frames: a camera, a video file, or the simulated camera.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "core/base/result.h"
#include "devices/camera/frame.h"

namespace ilf::devices {

/// Called from one thread.
class CameraSource {
public:
    virtual ~CameraSource() = default;

    /// Waits for the next frame. Nothing when there is none for now (a video that is held at its end); an error when
    /// the source is lost or its data is bad.
    virtual Result<std::optional<Frame>> read() = 0;
    /// Exposure and white balance stay as they are (true) or follow the scene (false). Refused by sources without
    /// either.
    virtual Result<void> lockExposure(bool locked) = 0;
    /// Goes to 0..1 of a video; no effect on others.
    virtual void seek(double position) { static_cast<void>(position); }
    /// A video stands still at its end on purpose: that is no frozen camera.
    virtual bool mayStandStill() const { return false; }

    /// For the operator; a simulated source says that it is one.
    virtual std::string name() const = 0;
    /// The same for the same device tomorrow, at whatever port order.
    virtual std::string id() const = 0;
};

/// Opens one of the three by its id (see listCameras) or a video file by its path.
Result<std::unique_ptr<CameraSource>> openCameraSource(const std::string& idOrPath);

/// The id of the simulated camera, which is always there.
inline const std::string kSimulatedCameraId = "simulated";

}  // namespace ilf::devices
