// A camera on a thread of its own: opens it, posts its newest frame, notices when it freezes, opens it again.
#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "core/base/latest.h"
#include "devices/camera/camera_source.h"
#include "devices/camera/freeze_watch.h"

namespace ilf::devices {

struct CameraState {
    bool open = false;
    bool frozen = false;  ///< no new picture for a second, or the same one again and again
    bool locked = false;  ///< exposure and white balance
    Second frameAge;      ///< of the newest picture that differs from the one before
    double position = 0.0;
    std::string name, id;
    CameraMode mode;      ///< as of the newest picture
    std::string trouble;  ///< why there is no picture, as a sentence; empty when all is well
};

/// All functions may be called from the thread that made it, and never wait for the device.
class Camera {
public:
    using Open = std::function<Result<std::unique_ptr<CameraSource>>()>;
    /// `onNews` is called from the camera's thread when there is a frame or the state changed.
    Camera(Open open, std::function<void()> onNews);
    ~Camera();

    /// The newest frame nobody took yet.
    std::optional<Frame> takeFrame() { return frames_.tryTake(); }
    CameraState state() const;
    void lockExposure(bool locked);
    void seek(double position);

private:
    void run(std::stop_token stop);
    Error play(CameraSource& source, std::stop_token stop);
    Result<void> obey(CameraSource& source);
    void lost(const std::string& why);

    Open open_;
    std::function<void()> onNews_;
    Latest<Frame> frames_;
    Latest<bool> lock_;
    Latest<double> seek_;
    mutable std::mutex mutex_;
    CameraState state_;
    std::optional<FreezeWatch> watch_;  ///< of the source that is open
    bool mayStandStill_ = false;
    std::jthread thread_;  // last: joins before what it uses goes
};

/// The frame as a scene's picture.
Picture asPicture(const Frame& frame);

}  // namespace ilf::devices
