#include "app/evaluate/observers.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <random>

namespace ilf::app {
namespace {

/// Least squares (Kasa): x^2 + y^2 = 2 a x + 2 b y + c over the points, about their mean.
FittedCircle fitted(const std::vector<cv::Point2d>& points) {
    cv::Point2d mean(0.0, 0.0);
    for (const auto& p : points)
        mean += p;
    mean *= 1.0 / static_cast<double>(points.size());
    double xx = 0.0, xy = 0.0, yy = 0.0, xz = 0.0, yz = 0.0, z = 0.0;
    for (const auto& p : points) {
        const double x = p.x - mean.x, y = p.y - mean.y, square = x * x + y * y;
        xx += x * x;
        xy += x * y;
        yy += y * y;
        xz += x * square;
        yz += y * square;
        z += square;
    }
    const double determinant = xx * yy - xy * xy;
    const double a = 0.5 * (xz * yy - yz * xy) / determinant, b = 0.5 * (yz * xx - xz * xy) / determinant;
    return {mean.x + a, mean.y + b, std::sqrt(a * a + b * b + z / static_cast<double>(points.size()))};
}

/// Middles of the pixel sides between a blob and what is not it.
std::vector<cv::Point2d> outline(const cv::Mat1i& labels, int label, cv::Rect box) {
    std::vector<cv::Point2d> points;
    const auto inside = [&](int x, int y) {
        return x >= 0 && y >= 0 && x < labels.cols && y < labels.rows && labels(y, x) == label;
    };
    constexpr std::array<std::array<int, 2>, 4> kSides{{{1, 0}, {-1, 0}, {0, 1}, {0, -1}}};
    for (int y = box.y; y < box.y + box.height; ++y) {
        for (int x = box.x; x < box.x + box.width; ++x) {
            if (labels(y, x) != label) continue;
            for (const auto& [dx, dy] : kSides) {
                if (!inside(x + dx, y + dy)) points.emplace_back(x + 0.5 + 0.5 * dx, y + 0.5 + 0.5 * dy);
            }
        }
    }
    return points;
}

std::vector<float> lessMean(std::vector<float> values) {
    double sum = 0.0;
    for (const float v : values)
        sum += static_cast<double>(v);
    const auto mean = static_cast<float>(sum / static_cast<double>(values.size()));
    for (float& v : values)
        v -= mean;
    return values;
}

constexpr int kGreen = 1;

}  // namespace

Image<std::uint8_t> exposed(const Image<float>& light, std::uint64_t seed) {
    std::vector<float> sorted(light.pixels().begin(), light.pixels().end());
    const std::size_t bright = std::min<std::size_t>(50, sorted.size() - 1);
    std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(bright), sorted.end(),
                     std::greater<>());
    const double gain = 200.0 / std::max(1e-30, static_cast<double>(sorted[bright]));
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal;
    std::vector<std::uint8_t> pixels;
    pixels.reserve(sorted.size());
    for (const float value : light.pixels()) {
        const double level = gain * static_cast<double>(value);
        const double noisy = level + std::hypot(1.5, 0.25 * std::sqrt(level)) * normal(random);
        pixels.push_back(static_cast<std::uint8_t>(std::clamp(std::lround(noisy), 0L, 255L)));
    }
    return {light.size(), 1, std::move(pixels)};
}

std::vector<FittedCircle> blurCircles(const Image<std::uint8_t>& picture, int leastArea) {
    const cv::Mat grey(picture.height(), picture.width(), CV_8UC1,
                       const_cast<std::uint8_t*>(picture.pixels().data()));  // read only
    cv::Mat binary, statistics, centres;
    cv::threshold(grey, binary, 0.0, 255.0, cv::THRESH_BINARY | cv::THRESH_OTSU);
    // Only the outline counts: specks of noise inside a blob are filled.
    std::vector<std::vector<cv::Point>> contours;
    cv::findContours(binary.clone(), contours, cv::RETR_EXTERNAL, cv::CHAIN_APPROX_NONE);
    cv::drawContours(binary, contours, -1, cv::Scalar(255.0), cv::FILLED);
    cv::Mat1i labels;
    const int blobs = cv::connectedComponentsWithStats(binary, labels, statistics, centres, 8, CV_32S);
    std::vector<FittedCircle> circles;
    for (int blob = 1; blob < blobs; ++blob) {
        if (statistics.at<int>(blob, cv::CC_STAT_AREA) < leastArea) continue;
        const cv::Rect box(statistics.at<int>(blob, cv::CC_STAT_LEFT), statistics.at<int>(blob, cv::CC_STAT_TOP),
                           statistics.at<int>(blob, cv::CC_STAT_WIDTH), statistics.at<int>(blob, cv::CC_STAT_HEIGHT));
        circles.push_back(fitted(outline(labels, blob, box)));
    }
    const auto fromMiddle = [&](const FittedCircle& c) {
        return std::max(std::abs(c.x - 0.5 * picture.width()), std::abs(c.y - 0.5 * picture.height()));
    };
    std::ranges::sort(circles, {}, fromMiddle);
    if (circles.size() > 9) circles.resize(9);
    return circles;
}

RingReader::RingReader(Size receptors, double gap_px, double noise, std::uint64_t seed) : noise_(noise), state_(seed) {
    for (int direction = 0; direction < kRingDirections; direction += 2) {
        const double angle = 6.283185307179586 * direction / kRingDirections;
        std::vector<float> ring;
        constexpr int kFine = 8;
        for (int row = 0; row < receptors.height; ++row) {
            for (int column = 0; column < receptors.width; ++column) {
                int white = 0;
                for (int i = 0; i < kFine * kFine; ++i) {
                    const double x = (column + (i % kFine + 0.5) / kFine - 0.5 * receptors.width) / gap_px;
                    const double y = (0.5 * receptors.height - row - (i / kFine + 0.5) / kFine) / gap_px;
                    const double along = x * std::cos(angle) + y * std::sin(angle);
                    const double across = y * std::cos(angle) - x * std::sin(angle), radius = std::hypot(x, y);
                    const bool inGap = along > 0.0 && std::abs(across) < 0.5;
                    white += radius > 1.5 && radius < 2.5 && !inGap ? 0 : 1;
                }
                ring.push_back(static_cast<float>(white) / (kFine * kFine));
            }
        }
        remembered_.push_back(lessMean(std::move(ring)));
    }
}

int RingReader::read(const Image<float>& light) {
    std::mt19937_64 random(state_++);
    std::normal_distribution<double> normal(0.0, noise_);
    std::vector<float> received(light.pixels().begin(), light.pixels().end());
    for (float& value : received)
        value += static_cast<float>(normal(random));
    received = lessMean(std::move(received));
    std::size_t best = 0;
    double most = -1e300;
    for (std::size_t k = 0; k < remembered_.size(); ++k) {
        double likeness = 0.0;
        for (std::size_t i = 0; i < received.size(); ++i)
            likeness += static_cast<double>(received[i]) * static_cast<double>(remembered_[k][i]);
        if (likeness <= most) continue;
        most = likeness;
        best = k;
    }
    return static_cast<int>(best) * 2;
}

double detailLeft(const Radiance& seen, const Radiance& sharp, int x0, int y0, int x1, int y1) {
    const auto detail = [&](const Radiance& picture) {
        double sum = 0.0;
        for (int y = y0; y < y1; ++y) {
            for (int x = x0; x < x1; ++x) {
                const double here = static_cast<double>(picture.at(x, y, kGreen));
                sum += std::pow(static_cast<double>(picture.at(x + 1, y, kGreen)) - here, 2) +
                       std::pow(static_cast<double>(picture.at(x, y + 1, kGreen)) - here, 2);
            }
        }
        return sum;
    };
    return detail(seen) / detail(sharp);
}

std::vector<double> lightAcross(const Radiance& seen, const Radiance& plain, int window) {
    const auto columns = [&](const Radiance& picture) {
        std::vector<double> sums(static_cast<std::size_t>(picture.width()));
        for (int y = 0; y < picture.height(); ++y) {
            for (int x = 0; x < picture.width(); ++x)
                sums[static_cast<std::size_t>(x)] += static_cast<double>(picture.at(x, y, kGreen));
        }
        return sums;
    };
    const std::vector<double> above = columns(seen), below = columns(plain);
    std::vector<double> out;
    const int last = static_cast<int>(above.size()) - 1;
    for (int x = 0; x <= last; ++x) {
        double a = 0.0, b = 0.0;
        for (int k = std::max(0, x - window / 2); k <= std::min(last, x + window / 2); ++k) {
            a += above[static_cast<std::size_t>(k)];
            b += below[static_cast<std::size_t>(k)];
        }
        out.push_back(a / b);
    }
    return out;
}

double weberAt(const std::vector<double>& profile, int border, int reach) {
    double worst = 0.0;
    for (int x = std::max(0, border - reach); x < std::min(static_cast<int>(profile.size()), border + reach); ++x) {
        const double off = profile[static_cast<std::size_t>(x)] - 1.0;
        if (std::abs(off) > std::abs(worst)) worst = off;
    }
    return worst;
}

}  // namespace ilf::app
