// What the parts of planar tracking share with each other and with OpenCV.
#pragma once

#include <opencv2/core.hpp>
#include <optional>
#include <vector>

#include "core/track/planar.h"

namespace ilf {

/// A view that must not be written to: OpenCV has no view of constant pixels.
inline cv::Mat viewOf(const Image<std::uint8_t>& image) {
    return {image.height(), image.width(), CV_8UC1, const_cast<std::uint8_t*>(image.pixels().data())};
}
Image<std::uint8_t> cutOut(const Image<std::uint8_t>& grey, const PixelRect<CameraFrame>& box);

inline cv::Point2f asCv(const Point<CameraFrame>& p) { return {static_cast<float>(p.x), static_cast<float>(p.y)}; }
inline Motion asMotion(const cv::Mat& h) {
    Motion motion;
    for (int i = 0; i < 9; ++i)
        motion.m[static_cast<std::size_t>(i)] = h.at<double>(i / 3, i % 3) / h.at<double>(2, 2);
    return motion;
}

/// A thing that is neither turned inside out nor seen edge-on, nor many times larger or smaller than it was.
bool plausible(const PlanarPattern& pattern, const Motion& motion);

/// What a picture is told again by, on some levels of its pyramid.
struct Features {
    std::vector<Point<CameraFrame>> at;
    cv::Mat descriptors;  ///< ORB, a row each
};
/// Each level is 1.2 times smaller than the one before; from the whole picture (0) on, `many` features on all kLevels
/// together, more on the finer ones.
inline constexpr int kLevels = 8;
Features featuresOf(const cv::Mat& picture, int many, int firstLevel, int endLevel);

/// See followPlanar. Precondition: `near` leaves the patch a convex quad before the camera.
std::optional<SeenPlanar> flowed(const PlanarPattern& pattern, const Image<std::uint8_t>& grey, const Motion& near);

}  // namespace ilf
