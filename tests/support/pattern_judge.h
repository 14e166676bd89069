// Where a marker's corners are by all pixels of its printed pattern: a judge of corners that were found by other means.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/aruco.hpp>
#include <opencv2/imgproc.hpp>

#include "core/base/image.h"
#include "core/track/quad.h"

namespace ilf {

/// Draws the pattern at some corners, blurred, lit with a gradient, and moves the corners until what it differs from
/// the photograph by is least (Gauss-Newton; squares of all pixels). It looks for no edges and fits no lines.
class PatternJudge {
public:
    /// `about`: the marker's corners to some pixels. `inset`: pixels are asked that lie so many cells inside the white
    /// rim's outer edge; from 1.5 on they are those of the pattern inside alone, and the outline is not seen.
    PatternJudge(const Image<std::uint8_t>& grey, int dictionary, int id, const Quad& about, double inset = 0.4)
        : grey_(grey), about_(about), inset_(inset) {
        const auto set = cv::aruco::getPredefinedDictionary(dictionary);
        side_ = set->markerSize + 4;  // with its border and a white rim
        cells_ = cv::Mat(side_, side_, CV_8U, cv::Scalar(255));
        cv::Mat inner;
        cv::aruco::drawMarker(set, id, side_ - 2, inner, 1);
        inner.copyTo(cells_(cv::Rect(1, 1, side_ - 2, side_ - 2)));
    }

    /// What is left of the photograph, as a share of its contrast, when the pattern lies at these corners and is
    /// blurred as suits it best.
    double left(const Quad& corners) const {
        double least = 1e9;
        for (const double blur_px : kBlurs_px)
            least = std::min(least, stepFrom(corners, blur_px).left);
        return least;
    }

    Quad corners(const Quad& start) const {
        constexpr int kSteps = 10;
        Quad best = start;
        double least = 1e9;
        for (const double blur_px : kBlurs_px) {
            Quad at = start;
            for (int i = 0; i < kSteps; ++i)
                at = stepFrom(at, blur_px).next;
            const double left = stepFrom(at, blur_px).left;
            if (left < least) least = left, best = at;
        }
        return best;
    }

private:
    static constexpr std::array<double, 4> kBlurs_px{0.2, 0.4, 0.6, 0.8};
    static constexpr int kFine = 4;  // samples along a pixel

    struct Step {
        double left = 1e9;
        Quad next;
    };

    Step stepFrom(const Quad& corners, double blur_px) const {
        Step step;
        step.next = corners;
        const Quad square = cornersOf(PixelRect<CameraFrame>{1, 1, side_ - 1, side_ - 1});
        const auto toCells = motionBetween(corners, square), asked = motionBetween(about_, square);
        const auto back = motionBetween(square, corners);
        if (!toCells || !asked || !back) return step;
        const auto box = boxAround(about_).grown(6).clipped(grey_.size());
        cv::Mat fine(kFine * box.height(), kFine * box.width(), CV_32F);
        for (int y = 0; y < fine.rows; ++y) {
            for (int x = 0; x < fine.cols; ++x) {
                const auto c = (*toCells)(Point<CameraFrame>{box.x0 + (x + 0.5) / kFine, box.y0 + (y + 0.5) / kFine});
                fine.at<float>(y, x) = cells_.at<std::uint8_t>(std::clamp(static_cast<int>(c.y), 0, side_ - 1),
                                                               std::clamp(static_cast<int>(c.x), 0, side_ - 1));
            }
        }
        cv::Mat slopeX, slopeY, pattern;
        cv::GaussianBlur(fine, fine, {0, 0}, kFine * blur_px);
        cv::Sobel(fine, slopeX, CV_32F, 1, 0, 1, 0.5 * kFine);
        cv::Sobel(fine, slopeY, CV_32F, 0, 1, 1, 0.5 * kFine);
        const cv::Size size(box.width(), box.height());
        cv::resize(fine, pattern, size, 0, 0, cv::INTER_AREA);
        cv::resize(slopeX, slopeX, size, 0, 0, cv::INTER_AREA);
        cv::resize(slopeY, slopeY, size, 0, 0, cv::INTER_AREA);

        // How the pattern goes with each corner's coordinates.
        constexpr double kNudge_px = 0.01;
        std::array<Motion, 8> nudged;
        for (std::size_t k = 0; k < nudged.size(); ++k) {
            Quad to = corners;
            (k % 2 == 0 ? to[k / 2].x : to[k / 2].y) += kNudge_px;
            nudged[k] = motionBetween(square, to).value_or(*back);
        }
        cv::Mat terms(0, 12, CV_64F), values(0, 1, CV_64F);
        for (int y = 0; y < pattern.rows; ++y) {
            for (int x = 0; x < pattern.cols; ++x) {
                const Point<CameraFrame> here{box.x0 + x + 0.5, box.y0 + y + 0.5};
                const auto c = (*asked)(here);
                if (std::min(c.x, c.y) < inset_ || std::max(c.x, c.y) > side_ - inset_) continue;
                cv::Matx<double, 1, 12> row;
                row(0) = 1.0;
                row(1) = static_cast<double>(pattern.at<float>(y, x)) / 255.0;
                row(2) = static_cast<double>(x) / pattern.cols - 0.5;
                row(3) = static_cast<double>(y) / pattern.rows - 0.5;
                const auto cell = (*toCells)(here);
                for (std::size_t k = 0; k < nudged.size(); ++k) {
                    const auto moved = nudged[k](cell);
                    row(static_cast<int>(4 + k)) = -(static_cast<double>(slopeX.at<float>(y, x)) * (moved.x - here.x) +
                                                     static_cast<double>(slopeY.at<float>(y, x)) * (moved.y - here.y)) /
                                                   (255.0 * kNudge_px);
                }
                terms.push_back(cv::Mat(row));
                values.push_back(static_cast<double>(grey_.at(box.x0 + x, box.y0 + y)));
            }
        }
        if (terms.rows < 40) return step;
        cv::Mat light, all;
        const cv::Mat lit = terms.colRange(0, 4).clone();
        cv::solve(lit, values, light, cv::DECOMP_QR);
        const cv::Mat rest = values - lit * light;
        step.left = std::sqrt(rest.dot(rest) / rest.rows) / std::abs(light.at<double>(1));
        cv::solve(terms, values, all, cv::DECOMP_QR);
        for (int k = 0; k < 8; ++k) {
            const double by = std::clamp(all.at<double>(4 + k) / all.at<double>(1), -0.5, 0.5);
            auto& corner = step.next[static_cast<std::size_t>(k / 2)];
            (k % 2 == 0 ? corner.x : corner.y) += by;
        }
        return step;
    }

    Image<std::uint8_t> grey_;
    Quad about_;
    double inset_;
    cv::Mat cells_;
    int side_ = 0;
};

}  // namespace ilf
