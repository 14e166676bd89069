// Whatever gives frames: a camera, a video file, or the simulated camera.
#pragma once

#include <memory>
#include <optional>
#include <stop_token>
#include <string>

#include "core/base/result.h"
#include "core/registration/registration.h"
#include "devices/camera/frame.h"

namespace ilf::devices {

/// Called from one thread.
class CameraSource {
public:
    virtual ~CameraSource() = default;

    /// Waits for the next frame. Nothing when there is none for now (a video that is held at its end); an error when
    /// the source is lost or its data is bad.
    virtual Result<std::optional<Frame>> read() = 0;
    /// Asked before the first frame: once `stop` is requested, `read` need not finish what takes long and may give
    /// nothing. No effect on sources that are quick.
    virtual void endWhen(std::stop_token stop) { static_cast<void>(stop); }
    /// Exposure and white balance stay as they are (true) or follow the scene (false). Refused by sources without
    /// either.
    virtual Result<void> lockExposure(bool locked) = 0;
    /// Light is gathered for this long in each frame from now on; gives what was set. Refused by sources that cannot.
    virtual Result<Second> setExposure(Second exposure) {
        static_cast<void>(exposure);
        return fail(Fault::unsupported, name() + " does not let its exposure be set.");
    }
    /// Whose pictures these are and how they are cut out of the sensor. A source that does not know says its id alone.
    virtual CameraMode mode() const {
        CameraMode known;
        known.device = id();
        return known;
    }
    /// Goes to 0..1 of a video; no effect on others.
    virtual void seek(double position) { static_cast<void>(position); }
    /// A video stands still at its end on purpose: that is no frozen camera.
    virtual bool mayStandStill() const { return false; }

    /// For the operator; a simulated source says that it is one.
    virtual std::string name() const = 0;
    /// The same for the same device tomorrow, at whatever port order.
    virtual std::string id() const = 0;
};

/// Opens a camera by its id (see listCameras) or a video file by its path. The emulated camera looks at what the output
/// core of the usual runtime directory shows; its id may go on with words (devices/emulated_scene/scene_wish.h).
Result<std::unique_ptr<CameraSource>> openCameraSource(const std::string& idOrPath);

/// The id of the simulated camera, which is always there.
inline const std::string kSimulatedCameraId = "simulated";
/// The id of the camera that sees the emulated scene in the light the devices show; always there as well.
inline const std::string kEmulatedCameraId = "emulated";

}  // namespace ilf::devices
