// Masks grown and shrunk: each level of coverage moved outwards or inwards by the same distance.
#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <set>

#include "core/document/shape.h"

namespace ilf {

namespace {

// A distance transform each. A shape with straight edges has no more than 9 levels: four edges, four corners and full.
constexpr std::size_t kMostLevels = 12;
constexpr std::size_t kFrequentLevels = 4;

/// The levels of coverage above 0 that occur, ascending. When they are many: some evenly picked, with both ends, and
/// the most frequent, which are the edges that run along the pixels and would show it if they moved by a tenth of one.
std::vector<std::uint8_t> levelsOf(const cv::Mat1b& coverage) {
    std::array<int, 256> count{};
    for (int y = 0; y < coverage.rows; ++y) {
        for (int x = 0; x < coverage.cols; ++x)
            ++count[coverage(y, x)];
    }
    std::vector<std::uint8_t> all;
    for (std::size_t v = 1; v < count.size(); ++v) {
        if (count[v] > 0) all.push_back(static_cast<std::uint8_t>(v));
    }
    if (all.size() <= kMostLevels) return all;
    std::vector<std::uint8_t> frequent = all;
    std::stable_sort(frequent.begin(), frequent.end(),
                     [&](std::uint8_t a, std::uint8_t b) { return count[a] > count[b]; });
    std::set<std::uint8_t> picked(frequent.begin(), frequent.begin() + kFrequentLevels);
    constexpr std::size_t kEven = kMostLevels - kFrequentLevels;
    for (std::size_t i = 0; i < kEven; ++i)
        picked.insert(all[i * (all.size() - 1) / (kEven - 1)]);
    return {picked.begin(), picked.end()};
}

/// Coverage after a whole number of pixels: the greatest level no farther away than `radius`, and from there on to the
/// next level in proportion to the way.
float levelAt(const std::vector<std::uint8_t>& levels, const std::vector<cv::Mat1f>& distances, int y, int x,
              float radius) {
    float value = 0.0f;
    for (std::size_t k = 0; k < levels.size(); ++k) {
        const float d = distances[k](y, x);
        if (d <= radius) {
            value = levels[k];
            continue;
        }
        if (k > 0) {
            const float before = distances[k - 1](y, x);
            value += static_cast<float>(levels[k] - levels[k - 1]) * (radius - before) / (d - before);
        }
        break;
    }
    return value;
}

/// `coverage` dilated by a disc. Never less than it was.
cv::Mat1b dilated(const cv::Mat1b& coverage, double radius) {
    const std::vector<std::uint8_t> levels = levelsOf(coverage);
    if (levels.empty()) return coverage.clone();
    std::vector<cv::Mat1f> distances(levels.size());
    for (std::size_t k = 0; k < levels.size(); ++k) {
        const cv::Mat outside = coverage < levels[k];
        cv::distanceTransform(outside, distances[k], cv::DIST_L2, cv::DIST_MASK_PRECISE, CV_32F);
    }
    const auto low = static_cast<float>(std::floor(radius));
    const auto high = static_cast<float>(std::ceil(radius));
    const auto share = static_cast<float>(radius) - low;
    cv::Mat1b result = coverage.clone();
    for (int y = 0; y < result.rows; ++y) {
        for (int x = 0; x < result.cols; ++x) {
            float v = levelAt(levels, distances, y, x, low);
            if (share > 0.0f) v += share * (levelAt(levels, distances, y, x, high) - v);
            result(y, x) = std::max(result(y, x), static_cast<std::uint8_t>(v + 0.5f));
        }
    }
    return result;
}

}  // namespace

Mask grown(const Mask& mask, double radius) {
    const PixelRect<CameraFrame> covered = mask.coveredPixels();
    if (radius == 0.0 || covered.empty()) return mask;
    // Nothing beyond this can change, nor be what changes something inside it.
    const PixelRect<CameraFrame> crop =
        covered.grown(static_cast<int>(std::ceil(std::min(std::abs(radius), 1e6))) + 1).clipped(mask.size());
    cv::Mat1b coverage(crop.height(), crop.width());
    for (int y = crop.y0; y < crop.y1; ++y) {
        for (int x = crop.x0; x < crop.x1; ++x)
            coverage(y - crop.y0, x - crop.x0) = mask.at(x, y);
    }
    // To shrink is to grow what is not covered.
    const bool shrinks = radius < 0.0;
    if (shrinks) cv::bitwise_not(coverage, coverage);
    cv::Mat1b moved = dilated(coverage, std::abs(radius));
    if (shrinks) cv::bitwise_not(moved, moved);

    Mask result = mask;
    for (int row = crop.y0 / kTile; row <= (crop.y1 - 1) / kTile; ++row) {
        for (int column = crop.x0 / kTile; column <= (crop.x1 - 1) / kTile; ++column) {
            Tile tile = *mask.tile(column, row);
            const PixelRect<CameraFrame> at = mask.pixelsOf(column, row);
            for (int y = std::max(at.y0, crop.y0); y < std::min(at.y1, crop.y1); ++y) {
                for (int x = std::max(at.x0, crop.x0); x < std::min(at.x1, crop.x1); ++x) {
                    tile.at(x - at.x0, y - at.y0) = moved(y - crop.y0, x - crop.x0);
                }
            }
            if (tile != *mask.tile(column, row)) result.setTile(column, row, boxed(tile));
        }
    }
    return result;
}

}  // namespace ilf
