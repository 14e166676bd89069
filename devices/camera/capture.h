// What live cameras and video files share: the settings of OpenCV's capture and frames as values.
#pragma once

#include "devices/camera/frame.h"

namespace cv {
class Mat;
}

namespace ilf::devices {

/// Sets what OpenCV reads from the environment: no chatter on the terminal, a camera that gives nothing for a second
/// returns, and a video's header is believed up to 100 megapixels. To be called before the first capture.
void prepareCapture();

/// RGB of what a capture gives (8 bits; BGR, grey or BGRA), or an empty image when it is something else.
Image<std::uint8_t> rgbOf(const cv::Mat& mat);

}  // namespace ilf::devices
