#include "app/studio/register_depth.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <span>
#include <vector>

namespace ilf::app {
namespace {

/// Of all figures, where a picture's colours end: what lies beyond is an edge or a speck.
constexpr double kLeast = 0.01, kGreatest = 0.99;

/// Of every seventh pixel: figures for an operator, not a measurement.
std::vector<float> sampled(const Image<float>& image) {
    std::vector<float> values;
    const auto pixels = image.pixels();
    for (std::size_t i = 0; i < pixels.size(); i += 7) {
        if (pixels[i] > 0.0F && std::isfinite(pixels[i])) values.push_back(pixels[i]);
    }
    std::ranges::sort(values);
    return values;
}

float quantile(const std::vector<float>& sorted, double share) {
    if (sorted.empty()) return 0.0F;
    return sorted[static_cast<std::size_t>(share * static_cast<double>(sorted.size() - 1))];
}

/// A click is good to some pixels and one pixel may be a hole: the median of those around it.
std::optional<Point3<CameraSpace>> pointAt(const MeasuredDepth& depth, Point<CameraFrame> at) {
    constexpr int kAround = 3;
    std::vector<float> near;
    const int cx = static_cast<int>(std::floor(at.x)), cy = static_cast<int>(std::floor(at.y));
    for (int y = std::max(0, cy - kAround); y <= std::min(depth.metres.height() - 1, cy + kAround); ++y) {
        for (int x = std::max(0, cx - kAround); x <= std::min(depth.metres.width() - 1, cx + kAround); ++x) {
            if (const float z = depth.metres.at(x, y); z > 0.0F) near.push_back(z);
        }
    }
    if (near.empty()) return std::nullopt;
    const auto middle = near.begin() + static_cast<std::ptrdiff_t>(near.size() / 2);
    std::ranges::nth_element(near, middle);
    const auto slopes = depth.camera.slopesOf(at.x, at.y);
    const double z = static_cast<double>(*middle);
    return Point3<CameraSpace>{slopes[0] * z, slopes[1] * z, z};
}

Image<float> times(const Image<float>& image, float factor) {
    if (image.empty()) return image;
    std::vector<float> pixels(image.pixels().begin(), image.pixels().end());
    for (float& pixel : pixels)
        pixel *= factor;
    return Image<float>(image.size(), image.channels(), std::move(pixels));
}

/// Viridis, a value beyond `least` and `greatest` like the nearest of them.
cv::Mat coloured(Size size, std::span<const float> values, float least, float greatest, bool leastIsBright) {
    const float range = std::max(1e-9F, greatest - least);
    cv::Mat shades(size.height, size.width, CV_8UC1), colours;
    std::ranges::transform(values, shades.begin<std::uint8_t>(), [&](float value) {
        const float share = std::clamp((value - least) / range, 0.0F, 1.0F);
        return static_cast<std::uint8_t>(std::lround(255.0F * (leastIsBright ? 1.0F - share : share)));
    });
    cv::applyColorMap(shades, colours, cv::COLORMAP_VIRIDIS);
    return colours;
}

/// RGB; grey where there is no depth. Empty without values.
Image<std::uint8_t> painted(const MeasuredDepth& depth, const Image<float>& values, bool leastIsBright) {
    if (values.empty()) return {};
    const auto sorted = sampled(values);
    const cv::Mat colours =
        coloured(values.size(), values.pixels(), quantile(sorted, kLeast), quantile(sorted, kGreatest), leastIsBright);
    std::vector<std::uint8_t> rgb;
    rgb.reserve(3 * values.pixels().size());
    auto pixel = colours.begin<cv::Vec3b>();
    for (const float z : depth.metres.pixels()) {
        const cv::Vec3b bgr = z > 0.0F ? *pixel : cv::Vec3b(45, 45, 45);
        rgb.insert(rgb.end(), {bgr[2], bgr[1], bgr[0]});
        ++pixel;
    }
    return Image<std::uint8_t>(values.size(), 3, std::move(rgb));
}

}  // namespace

ui::RegisterDepth figuresOf(const MeasuredDepth& depth, int decoded) {
    const auto metres = sampled(depth.metres), sigma = sampled(depth.sigma);
    const auto measured = std::ranges::count_if(depth.metres.pixels(), [](float z) { return z > 0.0F; });
    const auto at = [](const std::vector<float>& sorted, double share) {
        return Metre::fromSi(static_cast<double>(quantile(sorted, share)));
    };
    ui::RegisterDepth figures;
    figures.nearest = at(metres, kLeast);
    figures.farthest = at(metres, kGreatest);
    figures.sigma = at(sigma, 0.5);
    figures.surest = at(sigma, kLeast);
    figures.vaguest = at(sigma, kGreatest);
    if (decoded > 0) figures.share = static_cast<double>(measured) / decoded;
    figures.metres = depth.metres;
    figures.spread = depth.sigma;
    return figures;
}

Image<std::uint8_t> depthPicture(const MeasuredDepth& depth) { return painted(depth, depth.metres, true); }

Image<std::uint8_t> spreadPicture(const MeasuredDepth& depth) { return painted(depth, depth.sigma, false); }

std::vector<std::array<std::uint8_t, 3>> depthRamp(bool nearIsBright) {
    constexpr int kColours = 32;
    std::vector<float> values(kColours);
    for (int i = 0; i < kColours; ++i)
        values[static_cast<std::size_t>(i)] = static_cast<float>(i) / (kColours - 1);
    const cv::Mat colours = coloured({kColours, 1}, values, 0.0F, 1.0F, nearIsBright);
    std::vector<std::array<std::uint8_t, 3>> ramp;
    for (auto bgr = colours.begin<cv::Vec3b>(); bgr != colours.end<cv::Vec3b>(); ++bgr)
        ramp.push_back({(*bgr)[2], (*bgr)[1], (*bgr)[0]});
    return ramp;
}

std::optional<Metre> lengthBetween(const MeasuredDepth& depth, Point<CameraFrame> from, Point<CameraFrame> to) {
    const auto a = pointAt(depth, from), b = pointAt(depth, to);
    if (!a || !b) return std::nullopt;
    return Metre::fromSi(std::hypot(a->x - b->x, a->y - b->y, a->z - b->z));
}

MeasuredDepth scaled(const MeasuredDepth& depth, double factor) {
    MeasuredDepth next = depth;
    next.metres = times(depth.metres, static_cast<float>(factor));
    next.sigma = times(depth.sigma, static_cast<float>(factor));
    return next;
}

}  // namespace ilf::app
