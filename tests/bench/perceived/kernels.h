// One blur of a plane or a picture by a disc: the engine's, and what somebody would write with a library at hand.
#pragma once

#include <opencv2/core.hpp>
#include <string>
#include <vector>

namespace ilf::bench {

/// All take 32-bit floats of 1 or more interleaved channels, are dark outside, and give back the same size.
/// A disc of `radius` pixels, uniform, integral 1, over a picture that is bilinear between pixel centres.
struct Blur {
    std::string name;
    cv::Mat (*run)(const cv::Mat& picture, double radius);
};

/// filter2D with the disc itself, GaussianBlur and blur with the disc's variance, a product of spectra.
const std::vector<Blur>& libraryBlurs();

/// The engine's own way of one channel, tile by tile: exact rims, or (as at rest) over averages where discs are large.
cv::Mat engineExact(const cv::Mat& picture, double radius);
cv::Mat engineAtRest(const cv::Mat& picture, double radius);

/// Mean over the pixels whose centres lie within the pixel's own radius, for `rows` rows from the middle: the loop that
/// comes to mind first. `radii` has one channel.
cv::Mat gatheredRows(const cv::Mat& picture, const cv::Mat& radii, int rows);
/// The same for single pixels.
std::vector<float> gathered(const cv::Mat& picture, const cv::Mat& radii, const std::vector<cv::Point>& at);

/// The disc's weights, exact to 1e-9; odd size.
cv::Mat discKernel(double radius);
/// The exact blur, in double.
cv::Mat exactBlur(const cv::Mat& picture, double radius);

}  // namespace ilf::bench
