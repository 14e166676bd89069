// The studio's camera: a live device or a video file, its newest frame, and whether it goes on beneath the regions.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/document/document.h"
#include "devices/camera/camera.h"
#include "ui/view.h"

namespace ilf::app {

/// Main thread only; the device is the camera's own thread's.
class CameraPort {
public:
    explicit CameraPort(std::function<void()> onNews) : onNews_(std::move(onNews)) {}

    /// Opens a camera by its stable id; an empty id takes the first one found (the simulated camera is always there).
    void openLive(const std::string& id);
    void openVideo(const std::string& path);
    void close();

    /// Takes what came since the last call; true if there is a new frame.
    bool collect();
    const devices::Frame& frame() const { return *frame_; }
    /// The newest frame as a scene that says its camera's mode, for "grab"; refused when there is none or the camera is
    /// frozen.
    Result<Scene> grabbed() const;

    Result<void> toggleLock();
    void toggleLive() { live_ = !live_ && camera_; }
    bool live() const { return live_; }
    bool streaming() const { return camera_ && live_; }
    void seek(double position);

    /// What went wrong since the last call, each once.
    std::vector<std::string> takeSentences();
    ui::CameraStatus status() const;
    /// The stable id of what is open; empty: nothing.
    std::string id() const { return camera_ ? camera_->state().id : std::string(); }
    /// Ids of the cameras plugged in; looked for again when a camera is opened or closed.
    const std::vector<std::string>& ids() const { return ids_; }

private:
    void open(devices::Camera::Open source);
    void lookAround();

    std::function<void()> onNews_;
    std::unique_ptr<devices::Camera> camera_;
    std::optional<devices::Frame> frame_;
    bool live_ = false, video_ = false;
    std::string saidTrouble_;
    std::vector<std::string> ids_;
};

}  // namespace ilf::app
