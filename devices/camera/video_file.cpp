#include "devices/camera/video_file.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <exception>
#include <opencv2/core.hpp>
#include <opencv2/videoio.hpp>
#include <thread>
#include <utility>

#include "core/base/srgb.h"
#include "devices/camera/capture.h"

namespace ilf::devices {
namespace {

namespace fs = std::filesystem;

constexpr double kMaxPixels = 100e6;
/// Taken where a file does not say how fast it plays.
constexpr double kUsualRate = 25.0;

class VideoFile : public CameraSource {
public:
    VideoFile(fs::path path, cv::VideoCapture capture, Image<std::uint8_t> first)
        : path_(std::move(path)), capture_(std::move(capture)), first_(std::move(first)) {
        const double rate = capture_.get(cv::CAP_PROP_FPS);
        period_ = Second::fromSi(1.0 / (rate > 0.1 && rate < 1000.0 ? rate : kUsualRate));
        count_ = std::max(1.0, capture_.get(cv::CAP_PROP_FRAME_COUNT));
    }

    Result<std::optional<Frame>> read() override {
        if (ended_) return std::nullopt;
        auto image = first_.empty() ? decoded() : std::exchange(first_, {});
        if (image.empty()) {
            // The header's count is a claim; the end is where frames end.
            ended_ = true;
            count_ = std::max(1.0, index_);
            return std::nullopt;
        }
        const Second now = steadyNow();
        if (number_ == 0) due_ = now;
        if (now < due_) std::this_thread::sleep_for(std::chrono::duration<double>((due_ - now).si()));
        const Second shown = steadyNow();
        // A reader that was late gets the next frame at once, but the ones after at their rate.
        due_ = std::max(due_, shown - period_) + period_;
        index_ += 1.0;
        return Frame{std::move(image), shown, ++number_, std::min(1.0, index_ / count_)};
    }

    Result<void> lockExposure(bool) override {
        return fail(Fault::unsupported, "A video file has no exposure to lock: its pictures are what they are.");
    }

    void seek(double position) override {
        const double wanted = std::floor(std::clamp(position, 0.0, 1.0) * (count_ - 1.0));
        try {
            capture_.set(cv::CAP_PROP_POS_FRAMES, wanted);
        } catch (const std::exception&) {
            return;  // a file that cannot seek plays on
        }
        index_ = wanted;
        first_ = {};
        ended_ = false;
        due_ = steadyNow();
    }

    bool mayStandStill() const override { return true; }
    std::string name() const override { return path_.filename().string(); }
    std::string id() const override { return path_.string(); }

private:
    Image<std::uint8_t> decoded() {
        try {
            cv::Mat mat;
            return capture_.read(mat) ? rgbOf(mat) : Image<std::uint8_t>();
        } catch (const std::exception&) {
            return {};
        }
    }

    fs::path path_;
    cv::VideoCapture capture_;
    Image<std::uint8_t> first_;  ///< decoded when it was opened
    Second period_, due_;
    double count_ = 1.0, index_ = 0.0;
    std::uint64_t number_ = 0;
    bool ended_ = false;
};

std::string spoken(const fs::path& path) {
    std::string quoted(1, '"');
    quoted.append(path.string()).push_back('"');
    return quoted;
}

struct Opened {
    cv::VideoCapture capture;
    Image<std::uint8_t> first;
};

Result<Opened> opened(const fs::path& path) {
    std::error_code error;
    if (!fs::exists(path, error)) {
        return fail(Fault::notFound, spoken(path) + " does not exist. Check the name, or where it was moved to.");
    }
    if (!fs::is_regular_file(path, error)) {
        return fail(Fault::badFile, spoken(path) + " is not a file. Choose a video file.");
    }
    if (fs::file_size(path, error) == 0) return fail(Fault::badFile, spoken(path) + " is empty: 0 bytes.");
    prepareCapture();
    try {
        Opened video;
        // FFmpeg alone: other backends take names for patterns of picture sequences.
        if (!video.capture.open(path.string(), cv::CAP_FFMPEG)) {
            return fail(Fault::badFile, spoken(path) +
                                            " is not a video that can be played, or it is cut short. Use MP4, " +
                                            "MKV, MOV, AVI or WebM.");
        }
        const double pixels =
            video.capture.get(cv::CAP_PROP_FRAME_WIDTH) * video.capture.get(cv::CAP_PROP_FRAME_HEIGHT);
        if (pixels > kMaxPixels) {
            return fail(Fault::badFile,
                        spoken(path) + " says it has more than 100 megapixels. Scale it down and try again.");
        }
        cv::Mat mat;
        if (video.capture.read(mat)) video.first = rgbOf(mat);
        if (video.first.empty()) {
            return fail(Fault::badFile, spoken(path) + " holds no picture that can be decoded; it may be cut short.");
        }
        return video;
    } catch (const std::exception&) {
        return fail(Fault::badFile, spoken(path) + " is damaged and cannot be played. Copy it again.");
    }
}

}  // namespace

Result<std::unique_ptr<CameraSource>> openVideoFile(const fs::path& path) {
    auto video = opened(path);
    if (!video) return tl::unexpected(video.error());
    return std::make_unique<VideoFile>(path, std::move(video->capture), std::move(video->first));
}

Result<Picture> firstFrame(const fs::path& path) {
    return opened(path).map([](const Opened& video) { return toPicture(video.first); });
}

}  // namespace ilf::devices
