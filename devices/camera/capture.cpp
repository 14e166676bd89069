#include "devices/camera/capture.h"

#include <cstdlib>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <utility>
#include <vector>

namespace ilf::devices {

void prepareCapture() {
    static const bool done = [] {
        setenv("OPENCV_VIDEOIO_V4L_SELECT_TIMEOUT", "1", 0);
        setenv("OPENCV_LOG_LEVEL", "SILENT", 0);
        setenv("OPENCV_FFMPEG_LOGLEVEL", "-8", 0);  // AV_LOG_QUIET
        return true;
    }();
    static_cast<void>(done);
}

Image<std::uint8_t> rgbOf(const cv::Mat& mat) {
    cv::Mat rgb;
    if (mat.type() == CV_8UC3) cv::cvtColor(mat, rgb, cv::COLOR_BGR2RGB);
    if (mat.type() == CV_8UC1) cv::cvtColor(mat, rgb, cv::COLOR_GRAY2RGB);
    if (mat.type() == CV_8UC4) cv::cvtColor(mat, rgb, cv::COLOR_BGRA2RGB);
    if (rgb.empty()) return {};
    const auto length = 3U * static_cast<std::size_t>(rgb.cols);
    std::vector<std::uint8_t> pixels;
    pixels.reserve(length * static_cast<std::size_t>(rgb.rows));
    for (int y = 0; y < rgb.rows; ++y)
        pixels.insert(pixels.end(), rgb.ptr(y), rgb.ptr(y) + length);
    return Image<std::uint8_t>({rgb.cols, rgb.rows}, 3, std::move(pixels));
}

}  // namespace ilf::devices
