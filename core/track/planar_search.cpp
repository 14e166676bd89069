#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/calib3d.hpp>
#include <opencv2/features2d.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "core/track/planar_cv.h"

namespace ilf {

namespace {

constexpr int kFrameFeatures = 900;
/// A wider picture is looked through shrunk to this: features larger than that are what a thing is told by.
constexpr int kSearchWidth = 640;
constexpr double kRatio = 0.8;  // D. Lowe, "Distinctive image features from scale-invariant keypoints", IJCV 2004
constexpr int kFewestMatches = 10;
/// Levels that a look takes, from one to the next, so that all take about as long.
constexpr std::array<int, PlanarSearch::kLooks> kFirstLevel{0, 2, 4, kLevels};
constexpr double kShrink = 1.2;
constexpr int kEdge = 15;  // so near to it nothing is told apart

void keep(PlanarSearch& search, const Image<std::uint8_t>& grey, std::size_t features) {
    search.scale = std::min(1.0, static_cast<double>(kSearchWidth) / grey.width());
    search.kept = grey;
    search.nearest.assign(features, {});
    if (search.scale == 1.0) return;
    cv::Mat small;
    cv::resize(viewOf(grey), small, {}, search.scale, search.scale, cv::INTER_AREA);
    search.kept = {{small.cols, small.rows}, 1, std::vector<std::uint8_t>(small.datastart, small.dataend)};
}

void compare(PlanarSearch& search, const PlanarPattern& pattern, const Features& features) {
    if (features.at.empty()) return;
    std::vector<std::vector<cv::DMatch>> matches;
    cv::BFMatcher(cv::NORM_HAMMING).knnMatch(viewOf(pattern.descriptors), features.descriptors, matches, 2);
    for (const auto& pair : matches) {
        for (const cv::DMatch& match : pair) {
            auto& nearest = search.nearest[static_cast<std::size_t>(match.queryIdx)];
            const double distance = static_cast<double>(match.distance);
            if (distance < nearest.best) {
                const auto& p = features.at[static_cast<std::size_t>(match.trainIdx)];
                nearest = {distance, nearest.best, {p.x / search.scale, p.y / search.scale}};
            } else {
                nearest.second = std::min(nearest.second, distance);
            }
        }
    }
}

/// Where most of what is clearly alike agrees that it is.
std::optional<Motion> agreed(const PlanarSearch& search, const PlanarPattern& pattern) {
    std::vector<cv::Point2f> from, to;
    for (std::size_t i = 0; i < search.nearest.size(); ++i) {
        const auto& nearest = search.nearest[i];
        if (nearest.best > kRatio * nearest.second) continue;
        from.push_back(asCv(pattern.features[i]));
        to.push_back(asCv(nearest.at));
    }
    if (from.size() < kFewestMatches) return std::nullopt;
    cv::Mat inliers;
    const cv::Mat h = cv::findHomography(from, to, cv::RANSAC, 3.0 / search.scale, inliers, 1000, 0.995);
    if (h.empty() || cv::countNonZero(inliers) < kFewestMatches) return std::nullopt;
    const Motion rough = asMotion(h);
    return plausible(pattern, rough) ? std::optional(rough) : std::nullopt;
}

}  // namespace

Features featuresOf(const cv::Mat& picture, int many, int firstLevel, int endLevel) {
    Features features;
    const double all = (1.0 - std::pow(kShrink, -kLevels)) / (1.0 - 1.0 / kShrink);
    for (int level = firstLevel; level < endLevel; ++level) {
        const double smaller = std::pow(kShrink, -level);
        const cv::Size size(static_cast<int>(std::lround(picture.cols * smaller)),
                            static_cast<int>(std::lround(picture.rows * smaller)));
        if (std::min(size.width, size.height) <= 2 * kEdge) break;
        cv::Mat shrunk = picture;
        if (level > 0) cv::resize(picture, shrunk, size, 0, 0, cv::INTER_AREA);
        std::vector<cv::KeyPoint> keys;
        cv::Mat descriptors;
        cv::ORB::create(static_cast<int>(std::lround(many * smaller / all)), static_cast<float>(kShrink), 1, kEdge, 0,
                        2, cv::ORB::HARRIS_SCORE, 31, 10)
            ->detectAndCompute(shrunk, cv::noArray(), keys, descriptors);
        const double sx = static_cast<double>(picture.cols) / shrunk.cols;
        const double sy = static_cast<double>(picture.rows) / shrunk.rows;
        for (const auto& key : keys)
            features.at.push_back(
                {sx * (static_cast<double>(key.pt.x) + 0.5), sy * (static_cast<double>(key.pt.y) + 0.5)});
        if (!keys.empty()) features.descriptors.push_back(descriptors);
    }
    return features;
}

std::optional<SeenPlanar> lookedFor(PlanarSearch& search, const PlanarPattern& pattern,
                                    const Image<std::uint8_t>& grey) {
    if (grey.empty() || pattern.features.size() < kFewestMatches) return std::nullopt;
    try {
        const auto look = static_cast<std::size_t>(search.look);
        if (look == PlanarSearch::kLooks - 1) {
            const Motion rough = search.rough;
            search = {};
            return followPlanar(pattern, grey, rough);
        }
        if (look == 0) keep(search, grey, pattern.features.size());
        compare(search, pattern,
                featuresOf(viewOf(search.kept), kFrameFeatures, kFirstLevel[look], kFirstLevel[look + 1]));
        ++search.look;
        if (look + 2 < PlanarSearch::kLooks) return std::nullopt;
        const auto rough = agreed(search, pattern);
        search = {rough ? search.look : 0, {}, 1.0, {}, rough.value_or(Motion{})};
    } catch (const cv::Exception&) {
        search = {};  // degenerate matches: not seen
    }
    return std::nullopt;
}

}  // namespace ilf
