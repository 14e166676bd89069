#include "devices/camera/live_camera.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <exception>
#include <opencv2/core.hpp>
#include <opencv2/videoio.hpp>
#include <utility>

#include "devices/camera/capture.h"
#include "devices/camera/list.h"
#include "devices/camera/simulated_camera.h"
#include "devices/camera/video_file.h"
#include "devices/emulated_scene/emulated_camera.h"

namespace ilf::devices {
namespace {

namespace fs = std::filesystem;

class LiveCamera : public CameraSource {
public:
    LiveCamera(std::string id, std::string name, cv::VideoCapture capture)
        : id_(std::move(id)), name_(std::move(name)), capture_(std::move(capture)) {}

    Result<std::optional<Frame>> read() override {
        try {
            cv::Mat mat;
            if (capture_.read(mat)) {
                Image<std::uint8_t> rgb = rgbOf(mat);
                if (!rgb.empty()) size_ = rgb.size();
                if (!rgb.empty()) return Frame{std::move(rgb), steadyNow(), ++number_, 0.0};
            }
        } catch (const std::exception&) {  // told below
        }
        return fail(Fault::device, name_ + " gives no pictures any more. Check its cable; it is looked for again.");
    }

    Result<void> lockExposure(bool locked) override {
        try {
            // V4L2_CID_EXPOSURE_AUTO: 1 is manual, 3 is aperture priority, the automatic of webcams.
            const bool exposure = capture_.set(cv::CAP_PROP_AUTO_EXPOSURE, locked ? 1.0 : 3.0);
            const bool white = capture_.set(cv::CAP_PROP_AUTO_WB, locked ? 0.0 : 1.0);
            if (exposure && white) return {};
            const std::string what = !exposure && !white ? "exposure and white balance"
                                     : exposure          ? "white balance"
                                                         : "exposure";
            return fail(Fault::unsupported,
                        name_ + " does not let its " + what + " be " + (locked ? "locked" : "set free") + ".");
        } catch (const std::exception&) {
            return fail(Fault::device, name_ + " did not take the setting. Check its cable.");
        }
    }

    Result<Second> setExposure(Second exposure) override {
        try {
            // V4L2_CID_EXPOSURE_ABSOLUTE counts in 100 us; taken in manual exposure only.
            capture_.set(cv::CAP_PROP_AUTO_EXPOSURE, 1.0);
            const double asked = std::max(1.0, std::round(exposure.si() * 1e4));
            if (capture_.set(cv::CAP_PROP_EXPOSURE, asked)) {
                const double told = capture_.get(cv::CAP_PROP_EXPOSURE);
                return Second::fromSi(1e-4 * (told > 0.0 ? told : asked));
            }
        } catch (const std::exception&) {  // told below
        }
        return fail(Fault::unsupported, name_ + " does not let its exposure be set.");
    }
    CameraMode mode() const override {
        CameraMode mode;
        mode.device = id_;
        mode.picture = size_;
        return mode;
    }

    std::string name() const override { return name_; }
    std::string id() const override { return id_; }

private:
    std::string id_, name_;
    cv::VideoCapture capture_;
    Size size_;  ///< of the newest picture
    std::uint64_t number_ = 0;
};

}  // namespace

Result<std::unique_ptr<CameraSource>> openLiveCamera(const std::string& id, const fs::path& v4l) {
    const auto device = deviceOf(id, v4l);
    if (!device) return tl::unexpected(device.error());
    std::string name = id;
    for (const CameraEntry& camera : listCameras(v4l)) {
        if (camera.id == id) name = camera.name;
    }
    prepareCapture();
    try {
        cv::VideoCapture capture;
        if (capture.open(device->string(), cv::CAP_V4L2)) {
            capture.set(cv::CAP_PROP_BUFFERSIZE, 1.0);  // the newest picture, not one from a queue
            return std::make_unique<LiveCamera>(id, name, std::move(capture));
        }
    } catch (const std::exception&) {  // told below
    }
    return fail(Fault::device, name + " cannot be opened. Another program may be using it: close that and try again.");
}

Result<std::unique_ptr<CameraSource>> openCameraSource(const std::string& idOrPath) {
    if (idOrPath == kSimulatedCameraId) return std::make_unique<SimulatedCamera>();
    if (isEmulatedCamera(idOrPath)) return openEmulatedCamera(idOrPath);
    if (idOrPath.starts_with("/dev/")) return openLiveCamera(idOrPath);
    return openVideoFile(idOrPath);
}

}  // namespace ilf::devices
