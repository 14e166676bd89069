#include "core/track/planar.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <string>

#include "core/track/planar_cv.h"

namespace ilf {

namespace {

constexpr int kPoints = 90;
constexpr int kFewestPoints = 14;
/// The hull of the points must span so much of the patch, or a tilt cannot be told.
constexpr double kLeastSpread = 0.12;
/// Of cornerMinEigenVal on 8 bits, blurred: several times what noise of 3 grey values makes.
constexpr double kLeastTexture = 2e-4;
constexpr int kPatternFeatures = 500;

Point<CameraFrame> toPicture(const cv::Point2f& p, const PixelRect<CameraFrame>& patch) {
    return {static_cast<double>(p.x) + 0.5 + patch.x0, static_cast<double>(p.y) + 0.5 + patch.y0};
}

}  // namespace

bool plausible(const PlanarPattern& pattern, const Motion& motion) {
    const Quad before = cornersOf(pattern.patch);
    for (const auto& p : before) {
        if (motion.m[6] * p.x + motion.m[7] * p.y + motion.m[8] <= 0.0) return false;
    }
    const Quad now = moved(before, motion);
    const double area = signedArea(now);
    const double share = area / signedArea(before);
    if (!(share > 0.02 && share < 50.0)) return false;
    for (std::size_t i = 0; i < 4; ++i) {
        const auto &a = now[i], &b = now[(i + 1) % 4], &c = now[(i + 2) % 4];
        const double turn = (b.x - a.x) * (c.y - b.y) - (b.y - a.y) * (c.x - b.x);
        if (!(turn > 0.05 * area)) return false;
    }
    return true;
}

Result<Box<PlanarPattern>> planarPattern(const Image<std::uint8_t>& grey, const PixelRect<CameraFrame>& patch) {
    if (grey.empty() || patch.clipped(grey.size()) != patch || patch.width() < 16 || patch.height() < 16) {
        return fail(Fault::outOfRange,
                    "What a region follows must be a part of the picture of at least 16 x 16 pixels: draw it again.");
    }
    PlanarPattern pattern;
    pattern.patch = patch;
    pattern.grey = cutOut(grey, patch);
    try {
        const cv::Mat picture = viewOf(pattern.grey);
        cv::Mat blurred, texture;
        cv::GaussianBlur(picture, blurred, {5, 5}, 1.2);
        cv::cornerMinEigenVal(blurred, texture, 5);
        std::vector<cv::Point2f> points;
        const double apart =
            std::max(4.0, std::sqrt(patch.width() * static_cast<double>(patch.height()) / kPoints) / 2);
        cv::goodFeaturesToTrack(blurred, points, kPoints, 0.02, apart, cv::noArray(), 5);
        std::erase_if(points, [&](const cv::Point2f& p) {
            return static_cast<double>(texture.at<float>(cv::Point(p))) < kLeastTexture;
        });
        if (points.size() >= 3) {
            std::vector<cv::Point2f> hull;
            cv::convexHull(points, hull);
            pattern.spread = cv::contourArea(hull);
        }
        const double area = static_cast<double>(patch.width()) * patch.height();
        if (points.size() < kFewestPoints || pattern.spread < kLeastSpread * area) {
            return fail(Fault::unsupported,
                        "This part of the picture has too little texture to be followed (" +
                            std::to_string(points.size()) + " of at least " + std::to_string(kFewestPoints) +
                            " points, well spread): draw it around print or pattern, or lay a marker on it.");
        }
        for (const auto& p : points)
            pattern.points.push_back(toPicture(p, patch));

        const Features features = featuresOf(picture, kPatternFeatures, 0, kLevels);
        for (const auto& p : features.at)
            pattern.features.push_back({p.x + patch.x0, p.y + patch.y0});
        if (!features.at.empty()) {
            const cv::Mat& rows = features.descriptors;
            pattern.descriptors =
                Image<std::uint8_t>({rows.cols, rows.rows}, 1, std::vector<std::uint8_t>(rows.datastart, rows.dataend));
        }
    } catch (const cv::Exception& e) {
        return fail(Fault::unsupported, std::string("This part of the picture could not be learnt: ") + e.what());
    }
    return Box(std::move(pattern));
}

std::optional<SeenPlanar> followPlanar(const PlanarPattern& pattern, const Image<std::uint8_t>& grey,
                                       const Motion& near) {
    if (grey.empty() || !plausible(pattern, near)) return std::nullopt;
    try {
        auto seen = flowed(pattern, grey, near);
        if (!seen || !plausible(pattern, seen->motion)) return std::nullopt;
        return seen;
    } catch (const cv::Exception&) {
        return std::nullopt;  // degenerate points: not seen
    }
}

}  // namespace ilf
