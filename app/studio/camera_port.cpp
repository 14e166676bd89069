#include "app/studio/camera_port.h"

#include "devices/camera/list.h"
#include "devices/camera/video_file.h"

namespace ilf::app {

void CameraPort::openLive(const std::string& id) {
    lookAround();
    const std::string wanted = !id.empty() ? id : ids_.empty() ? devices::kSimulatedCameraId : ids_.front();
    open([wanted] { return devices::openCameraSource(wanted); });
    video_ = false;
    live_ = true;
}

void CameraPort::openVideo(const std::string& path) {
    open([path] { return devices::openVideoFile(path); });
    video_ = true;
}

void CameraPort::open(devices::Camera::Open source) {
    close();
    camera_ = std::make_unique<devices::Camera>(std::move(source), onNews_);
}

void CameraPort::close() {
    camera_.reset();
    frame_.reset();
    live_ = video_ = false;
    saidTrouble_.clear();
    if (ids_.empty()) lookAround();
}

void CameraPort::lookAround() {
    ids_.clear();
    for (const devices::CameraEntry& entry : devices::listCameras())
        ids_.push_back(entry.id);
}

bool CameraPort::collect() {
    if (!camera_) return false;
    auto frame = camera_->takeFrame();
    if (!frame) return false;
    frame_ = std::move(frame);
    return true;
}

Result<Scene> CameraPort::grabbed() const {
    if (!camera_)
        return fail(Fault::notFound, "There is no camera to grab from: open one first (Scene > Open camera).");
    const devices::CameraState state = camera_->state();
    if (!frame_) {
        return fail(Fault::device,
                    state.trouble.empty() ? "The camera has not given a frame yet: wait a moment." : state.trouble);
    }
    if (state.frozen && !video_) {
        return fail(Fault::device, "\"" + state.name + "\" is frozen: what it shows is old. Plug it in again.");
    }
    Scene scene;
    scene.picture = Box(devices::asPicture(*frame_));
    scene.source = state.id;
    scene.scale = {focalPixels(scene.size().width, kDefaultFieldOfView), PixelScale::Source::assumed};
    if (video_) return scene;  // its pictures may be of any camera
    scene.camera = state.mode;
    scene.camera.picture = scene.size();  // what a camera says of itself may be older than its newest picture
    return scene;
}

Result<void> CameraPort::toggleLock() {
    if (!camera_) return fail(Fault::notFound, "There is no camera to lock: open one first (Scene > Open camera).");
    camera_->lockExposure(!camera_->state().locked);
    return {};
}

void CameraPort::seek(double position) {
    if (camera_) camera_->seek(position);
}

std::vector<std::string> CameraPort::takeSentences() {
    if (!camera_) return {};
    const std::string trouble = camera_->state().trouble;
    if (trouble == saidTrouble_) return {};
    saidTrouble_ = trouble;
    return trouble.empty() ? std::vector<std::string>{} : std::vector<std::string>{trouble};
}

ui::CameraStatus CameraPort::status() const {
    ui::CameraStatus status;
    if (!camera_) return status;
    const devices::CameraState state = camera_->state();
    status.open = state.open;
    status.name = state.name;
    status.frameAge_s = state.frameAge.si();
    status.frozen = state.frozen;
    status.live = live_;
    status.locked = state.locked;
    status.isVideoFile = video_;
    status.videoPosition = state.position;
    return status;
}

}  // namespace ilf::app
