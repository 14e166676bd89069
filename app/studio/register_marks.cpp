#include "app/studio/register_marks.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <string>

namespace ilf::app {
namespace {

constexpr int kGround = 30, kMark = 255;

cv::Mat ground(Size projector) { return {projector.height, projector.width, CV_8UC1, cv::Scalar(kGround)}; }

Image<std::uint8_t> imageOf(const cv::Mat& mat) {
    return Image<std::uint8_t>({mat.cols, mat.rows}, 1,
                               std::vector<std::uint8_t>(mat.begin<std::uint8_t>(), mat.end<std::uint8_t>()));
}

/// Odd, so that a line through a pixel has its middle in that pixel's.
int strokeOf(Size projector) { return std::max(1, projector.width / 400) | 1; }

void number(cv::Mat& mat, cv::Point at, int value) {
    const double scale = mat.rows / 400.0;
    const int stroke = std::max(2, mat.rows / 200);
    const std::string text = std::to_string(value);
    int below = 0;
    const cv::Size size = cv::getTextSize(text, cv::FONT_HERSHEY_SIMPLEX, scale, stroke, &below);
    at.x = std::clamp(at.x - size.width / 2, 0, std::max(0, mat.cols - size.width));
    at.y = std::clamp(at.y + size.height / 2, size.height, std::max(size.height, mat.rows - below));
    cv::putText(mat, text, at, cv::FONT_HERSHEY_SIMPLEX, scale, cv::Scalar(kMark), stroke, cv::LINE_AA);
}

}  // namespace

Image<std::uint8_t> framePicture(Size projector) {
    cv::Mat mat = ground(projector);
    const int w = projector.width, h = projector.height, thick = 3 * strokeOf(projector), arm = std::min(w, h) / 8;
    cv::rectangle(mat, cv::Rect(0, 0, w, strokeOf(projector)), cv::Scalar(kMark), cv::FILLED);
    cv::rectangle(mat, cv::Rect(0, h - strokeOf(projector), w, strokeOf(projector)), cv::Scalar(kMark), cv::FILLED);
    cv::rectangle(mat, cv::Rect(0, 0, strokeOf(projector), h), cv::Scalar(kMark), cv::FILLED);
    cv::rectangle(mat, cv::Rect(w - strokeOf(projector), 0, strokeOf(projector), h), cv::Scalar(kMark), cv::FILLED);
    for (int i = 0; i < 4; ++i) {
        const bool right = i == 1 || i == 2, low = i >= 2;
        cv::rectangle(mat, cv::Rect(right ? w - arm : 0, low ? h - thick : 0, arm, thick), cv::Scalar(kMark),
                      cv::FILLED);
        cv::rectangle(mat, cv::Rect(right ? w - thick : 0, low ? h - arm : 0, thick, arm), cv::Scalar(kMark),
                      cv::FILLED);
        number(mat, {right ? w - arm : arm, low ? h - arm : arm}, i + 1);
    }
    return imageOf(mat);
}

std::vector<Point<ProjectorFrame>> crossPlaces(Size projector) {
    static constexpr double kShares[][2] = {{0.12, 0.12}, {0.88, 0.12}, {0.88, 0.88}, {0.12, 0.88}, {0.5, 0.5},
                                            {0.5, 0.12},  {0.88, 0.5},  {0.5, 0.88},  {0.12, 0.5},  {0.3, 0.3},
                                            {0.7, 0.3},   {0.7, 0.7},   {0.3, 0.7}};
    std::vector<Point<ProjectorFrame>> places;
    for (const auto& share : kShares)
        places.push_back({std::floor(share[0] * projector.width) + 0.5, std::floor(share[1] * projector.height) + 0.5});
    return places;
}

Image<std::uint8_t> crossPicture(Size projector, Point<ProjectorFrame> at, int value) {
    cv::Mat mat = ground(projector);
    const cv::Point centre(static_cast<int>(std::floor(at.x)), static_cast<int>(std::floor(at.y)));
    const int arm = std::min(projector.width, projector.height) / 12, stroke = strokeOf(projector);
    cv::line(mat, {centre.x - arm, centre.y}, {centre.x + arm, centre.y}, cv::Scalar(kMark), stroke);
    cv::line(mat, {centre.x, centre.y - arm}, {centre.x, centre.y + arm}, cv::Scalar(kMark), stroke);
    cv::circle(mat, centre, arm / 2, cv::Scalar(kMark), stroke, cv::LINE_AA);
    // Towards the raster's middle, where there is room.
    const int side = centre.x * 2 < projector.width ? 1 : -1;
    number(mat, {centre.x + side * 2 * arm, centre.y}, value);
    return imageOf(mat);
}

}  // namespace ilf::app
