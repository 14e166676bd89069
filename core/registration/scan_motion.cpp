#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <opencv2/imgproc.hpp>

#include "core/registration/scan_faults.h"

namespace ilf {

namespace {

/// A pattern and its inverse together: what a camera sees of steady light, whatever the stripes.
cv::Mat together(const Image<std::uint8_t>& a, const Image<std::uint8_t>& b) {
    cv::Mat sum(a.height(), a.width(), CV_32F);
    for (int y = 0; y < a.height(); ++y) {
        float* row = sum.ptr<float>(y);
        for (int x = 0; x < a.width(); ++x)
            row[x] = static_cast<float>(a.at(x, y) + b.at(x, y));
    }
    return sum;
}

/// Texture that phase correlation can hold on to: without it shifts are chance.
bool textured(const cv::Mat& sum) {
    cv::Mat gx, gy;
    cv::Sobel(sum, gx, CV_32F, 1, 0);
    cv::Sobel(sum, gy, CV_32F, 0, 1);
    cv::Mat strong;
    cv::magnitude(gx, gy, strong);
    return cv::countNonZero(strong > 80.0F) > static_cast<int>(strong.total() / 500);
}

/// The highest level of the white picture in a block.
int brightest(const Scan& scan, int x0, int y0, int side) {
    const auto white = std::ranges::find(scan.patterns, Pattern{Pattern::Kind::white, 0, false});
    if (white == scan.patterns.end()) return 0;
    const auto& picture = scan.pictures[static_cast<std::size_t>(white - scan.patterns.begin())];
    int most = 0;
    for (int y = y0; y < std::min(picture.height(), y0 + side); ++y) {
        for (int x = x0; x < std::min(picture.width(), x0 + side); ++x)
            most = std::max(most, int{picture.at(x, y)});
    }
    return most;
}

}  // namespace

std::optional<Motion> motionIn(const Scan& scan) {
    std::vector<PatternPair> pairs = patternPairs(scan);
    // Fine stripes leave a trace in the sum wherever a camera is not linear.
    std::erase_if(pairs, [](const PatternPair& pair) { return pair.level < 2; });
    if (pairs.size() < 4) return std::nullopt;
    std::vector<cv::Mat> sums;
    for (const PatternPair& pair : pairs) {
        cv::Mat sum = together(scan.pictures[static_cast<std::size_t>(pair.picture)],
                               scan.pictures[static_cast<std::size_t>(pair.inverse)]);
        cv::GaussianBlur(sum, sum, {0, 0}, 1.0);
        sums.push_back(std::move(sum));
    }
    try {
        // The whole picture: where the sums went between the first pair and each later one.
        if (textured(sums.front())) {
            cv::Mat window;
            cv::createHanningWindow(window, sums.front().size(), CV_32F);
            const auto shift = [&](const cv::Mat& sum) {
                // Copies: OpenCV 4.6 multiplies the window into pictures whose size suits its Fourier transform.
                cv::Mat first = sums.front().clone(), later = sum.clone();
                const cv::Point2d by = cv::phaseCorrelate(first, later, window);
                return std::hypot(by.x, by.y);
            };
            constexpr double kMoved_px = 0.4;
            if (const double all = shift(sums.back()); all > kMoved_px) {
                std::size_t first = 1;
                while (first + 1 < sums.size() && shift(sums[first]) <= kMoved_px)
                    ++first;
                return Motion{all, std::min(pairs[first].picture, pairs[first].inverse), {}};
            }
        }
        // A part of it: where some sum leaves the median of all sums by more than noise, over an area. Blocks of 16
        // pixels hold the finest stripe looked at, and average noise away.
        constexpr int kBlock = 16;
        const cv::Size blocks(std::max(1, sums.front().cols / kBlock), std::max(1, sums.front().rows / kBlock));
        std::vector<cv::Mat> small(sums.size());
        for (std::size_t k = 0; k < sums.size(); ++k)
            cv::resize(sums[k], small[k], blocks, 0, 0, cv::INTER_AREA);
        cv::Mat worst = cv::Mat::zeros(blocks, CV_32F), when = cv::Mat::zeros(blocks, CV_32S);
        std::vector<float> values(small.size());
        for (int y = 0; y < blocks.height; ++y) {
            for (int x = 0; x < blocks.width; ++x) {
                if (brightest(scan, x * kBlock, y * kBlock, kBlock) == 255) continue;  // sums do not add up there
                for (std::size_t k = 0; k < small.size(); ++k)
                    values[k] = small[k].at<float>(y, x);
                std::vector<float> sorted = values;
                std::ranges::sort(sorted);
                const float middle = sorted[sorted.size() / 2];
                // An eighth of the light there, and never less than noise.
                const float most = std::max(8.0F, middle / 8.0F);
                for (std::size_t k = 0; k < small.size(); ++k) {
                    if (std::abs(values[k] - middle) <= most) continue;
                    if (worst.at<float>(y, x) == 0.0F) when.at<int>(y, x) = static_cast<int>(k);
                    worst.at<float>(y, x) = 1.0F;
                }
            }
        }
        const int moved = cv::countNonZero(worst);
        // All of it at once is a lamp that flickers or a frame that was lost, not something that moved.
        if (moved < 4 || moved > blocks.area() / 2) return std::nullopt;
        Motion motion;
        std::size_t first = sums.size() - 1;
        PixelRect<CameraFrame> area;
        for (int y = 0; y < blocks.height; ++y) {
            for (int x = 0; x < blocks.width; ++x) {
                if (worst.at<float>(y, x) == 0.0F) continue;
                area = area.united({x * kBlock, y * kBlock, (x + 1) * kBlock, (y + 1) * kBlock});
                first = std::min(first, static_cast<std::size_t>(when.at<int>(y, x)));
            }
        }
        motion.area = area;
        motion.picture = std::min(pairs[first].picture, pairs[first].inverse);
        return motion;
    } catch (const cv::Exception&) {
        return std::nullopt;
    }
}

}  // namespace ilf
