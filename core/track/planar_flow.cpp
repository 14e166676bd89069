#include <algorithm>
#include <cmath>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>
#include <vector>

#include "core/track/planar_cv.h"

namespace ilf {

namespace {

constexpr int kMargin_px = 24;          // around where it is thought to be: how far flow reaches
constexpr double kMostPixels = 90'000;  // of the window that flow works on; a larger one is shrunk
constexpr int kFewestSeen = 10;
constexpr double kInlier_px = 1.5;
constexpr int kLook = 4;               // half a side of the square about a point that is compared, pixels
constexpr double kSureInliers = 24.0;  // so many agreeing points leave no doubt

double sampled(const cv::Mat& picture, double x, double y) {
    const double px = std::clamp(x - 0.5, 0.0, picture.cols - 1.001);
    const double py = std::clamp(y - 0.5, 0.0, picture.rows - 1.001);
    const int ix = static_cast<int>(px), iy = static_cast<int>(py);
    const double fx = px - ix, fy = py - iy;
    const std::uint8_t* a = picture.ptr<std::uint8_t>(iy) + ix;
    const std::uint8_t* b = picture.ptr<std::uint8_t>(iy + 1) + ix;
    return (a[0] * (1 - fx) + a[1] * fx) * (1 - fy) + (b[0] * (1 - fx) + b[1] * fx) * fy;
}

/// Normalised correlation (-1..1) of the pattern about `at` with the picture where the motion puts it.
double likeness(const PlanarPattern& pattern, const cv::Mat& picture, const Motion& motion,
                const Point<CameraFrame>& at) {
    const cv::Mat own = viewOf(pattern.grey);
    double a1 = 0, b1 = 0, aa = 0, bb = 0, ab = 0;
    int n = 0;
    for (int dy = -kLook; dy <= kLook; dy += 2) {
        for (int dx = -kLook; dx <= kLook; dx += 2) {
            const Point<CameraFrame> p{at.x + dx, at.y + dy};
            const auto q = motion(p);
            const double a = sampled(own, p.x - pattern.patch.x0, p.y - pattern.patch.y0);
            const double b = sampled(picture, q.x, q.y);
            a1 += a, b1 += b, aa += a * a, bb += b * b, ab += a * b;
            ++n;
        }
    }
    const double va = aa - a1 * a1 / n, vb = bb - b1 * b1 / n;
    return va > 1.0 && vb > 1.0 ? (ab - a1 * b1 / n) / std::sqrt(va * vb) : 0.0;
}

/// As bright and contrasty as the picture, so that flow sees motion and not another light.
void matchLight(cv::Mat& drawn, const cv::Mat& picture, const cv::Mat& mask) {
    cv::Scalar meanA, meanB, sdA, sdB;
    cv::meanStdDev(drawn, meanA, sdA, mask);
    cv::meanStdDev(picture, meanB, sdB, mask);
    const double gain = std::clamp(sdB[0] / std::max(1.0, sdA[0]), 0.2, 5.0);
    drawn.convertTo(drawn, CV_8U, gain, meanB[0] - gain * meanA[0]);
}

}  // namespace

Image<std::uint8_t> cutOut(const Image<std::uint8_t>& grey, const PixelRect<CameraFrame>& box) {
    std::vector<std::uint8_t> out;
    out.reserve(static_cast<std::size_t>(box.width()) * static_cast<std::size_t>(box.height()));
    for (int y = box.y0; y < box.y1; ++y)
        out.insert(out.end(), grey.row(y) + box.x0, grey.row(y) + box.x1);
    return {{box.width(), box.height()}, 1, std::move(out)};
}

std::optional<SeenPlanar> flowed(const PlanarPattern& pattern, const Image<std::uint8_t>& grey, const Motion& near) {
    const cv::Mat picture = viewOf(grey);
    const auto window = boxAround(moved(cornersOf(pattern.patch), near)).grown(kMargin_px).clipped(grey.size());
    if (window.width() < 32 || window.height() < 32) return std::nullopt;
    const double pixels = static_cast<double>(window.width()) * window.height();
    const double scale = std::min(1.0, std::sqrt(kMostPixels / pixels));
    cv::Mat now = picture(cv::Rect(window.x0, window.y0, window.width(), window.height()));
    if (scale < 1.0) {
        cv::Mat small;
        cv::resize(now, small, {}, scale, scale, cv::INTER_AREA);
        now = small;
    }
    const double sx = static_cast<double>(now.cols) / window.width();
    const double sy = static_cast<double>(now.rows) / window.height();

    // The pattern as it should look in the window, in OpenCV's pixels: centres at whole numbers.
    const cv::Matx33d toWindow(sx, 0, -sx * window.x0 - 0.5, 0, sy, -sy * window.y0 - 0.5, 0, 0, 1);
    const cv::Matx33d toPicture(1, 0, pattern.patch.x0 + 0.5, 0, 1, pattern.patch.y0 + 0.5, 0, 0, 1);
    const cv::Matx33d drawnFromPattern = toWindow * cv::Matx33d(near.m.data()) * toPicture;
    cv::Mat drawn, mask;
    cv::warpPerspective(viewOf(pattern.grey), drawn, drawnFromPattern, now.size(), cv::INTER_LINEAR,
                        cv::BORDER_REPLICATE);
    cv::warpPerspective(cv::Mat(pattern.grey.height(), pattern.grey.width(), CV_8UC1, cv::Scalar(255)), mask,
                        drawnFromPattern, now.size(), cv::INTER_NEAREST);
    matchLight(drawn, now, mask);

    std::vector<cv::Point2f> from, expected;
    for (const auto& p : pattern.points) {
        const auto at = near(p);
        if (at.x < window.x0 + 3 || at.y < window.y0 + 3 || at.x > window.x1 - 3 || at.y > window.y1 - 3) continue;
        from.push_back(asCv(p));
        expected.emplace_back(static_cast<float>(sx * (at.x - window.x0) - 0.5),
                              static_cast<float>(sy * (at.y - window.y0) - 0.5));
    }
    SeenPlanar seen;
    seen.asked = static_cast<int>(from.size());
    if (seen.asked < kFewestSeen) return std::nullopt;
    std::vector<cv::Point2f> found;
    std::vector<std::uint8_t> status;
    std::vector<float> errors;
    cv::calcOpticalFlowPyrLK(drawn, now, expected, found, status, errors, {15, 15}, 3,
                             {cv::TermCriteria::COUNT + cv::TermCriteria::EPS, 20, 0.02}, 0, 1e-3);
    std::vector<cv::Point2f> a, b;
    for (std::size_t i = 0; i < from.size(); ++i) {
        if (status[i] == 0) continue;
        a.push_back(from[i]);
        b.emplace_back(static_cast<float>((static_cast<double>(found[i].x) + 0.5) / sx + window.x0),
                       static_cast<float>((static_cast<double>(found[i].y) + 0.5) / sy + window.y0));
    }
    if (static_cast<int>(a.size()) < kFewestSeen) return std::nullopt;
    cv::Mat agree;
    const cv::Mat h = cv::findHomography(a, b, cv::RANSAC, kInlier_px / std::min(sx, sy), agree, 300, 0.995);
    if (h.empty()) return std::nullopt;
    seen.motion = asMotion(h);

    // How sure: points that agree and look alike, how many of those asked, and how far they spread.
    std::vector<cv::Point2f> alike;
    double squares = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        if (agree.at<std::uint8_t>(static_cast<int>(i)) == 0) continue;
        const Point<CameraFrame> p{static_cast<double>(a[i].x), static_cast<double>(a[i].y)};
        if (likeness(pattern, picture, seen.motion, p) < 0.5) continue;
        alike.push_back(a[i]);
        const auto at = seen.motion(p);
        squares += std::pow(at.x - static_cast<double>(b[i].x), 2) + std::pow(at.y - static_cast<double>(b[i].y), 2);
    }
    seen.inliers = static_cast<int>(alike.size());
    if (seen.inliers < 4) return std::nullopt;
    seen.rms_px = std::sqrt(squares / seen.inliers);
    std::vector<cv::Point2f> hull;
    cv::convexHull(alike, hull);
    const double spread = cv::contourArea(hull) / pattern.spread;
    const double share = static_cast<double>(seen.inliers) / seen.asked;
    seen.confidence =
        std::min(1.0, seen.inliers / kSureInliers) * std::min(1.0, 2.0 * share) * std::min(1.0, 2.0 * spread);
    return seen;
}

}  // namespace ilf
