#include "tests/bench/perceived/kernels.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <opencv2/imgproc.hpp>

#include "core/perceived/engine_shown.h"

namespace ilf::bench {
namespace {

/// Integral of a pixel's tent up to `x`.
double tentUpTo(double x) {
    const double t = std::clamp(x, -1.0, 1.0);
    return t < 0.0 ? 0.5 * (1.0 + t) * (1.0 + t) : 1.0 - 0.5 * (1.0 - t) * (1.0 - t);
}

/// What the disc holds of the tent of the pixel (dx, dy): lines across it by the midpoint rule.
double weightOf(double radius, int dx, int dy) {
    constexpr int kLines = 1024;
    double sum = 0.0;
    for (int line = 0; line < kLines; ++line) {
        const double offset = -1.0 + 2.0 * (line + 0.5) / kLines, y = dy + offset;
        if (std::abs(y) >= radius) continue;
        const double half = std::sqrt(radius * radius - y * y);
        sum += (1.0 - std::abs(offset)) * (tentUpTo(half - dx) - tentUpTo(-half - dx));
    }
    return sum * 2.0 / kLines;
}

cv::Mat filtered(const cv::Mat& picture, double radius) {
    cv::Mat kernel, out;
    discKernel(radius).convertTo(kernel, CV_32F);
    cv::filter2D(picture, out, -1, kernel, {-1, -1}, 0.0, cv::BORDER_CONSTANT);
    return out;
}

cv::Mat gaussian(const cv::Mat& picture, double radius) {
    cv::Mat out;
    cv::GaussianBlur(picture, out, {0, 0}, 0.5 * radius, 0.5 * radius, cv::BORDER_CONSTANT);
    return out;
}

/// A disc's variance along one axis is r^2 / 4, a box's (w^2 - 1) / 12.
cv::Mat box(const cv::Mat& picture, double radius) {
    const int half = static_cast<int>(std::lround(0.5 * (std::sqrt(3.0 * radius * radius + 1.0) - 1.0)));
    cv::Mat out;
    cv::blur(picture, out, {2 * half + 1, 2 * half + 1}, {-1, -1}, cv::BORDER_CONSTANT);
    return out;
}

/// Convolution by spectra, channel by channel; `depth` CV_32F or CV_64F.
cv::Mat bySpectra(const cv::Mat& picture, double radius, int depth) {
    const cv::Mat kernel = discKernel(radius);
    const cv::Size size(cv::getOptimalDFTSize(picture.cols + kernel.cols - 1),
                        cv::getOptimalDFTSize(picture.rows + kernel.rows - 1));
    cv::Mat disc = cv::Mat::zeros(size, depth);
    kernel.convertTo(disc(cv::Rect(0, 0, kernel.cols, kernel.rows)), depth);
    cv::dft(disc, disc, 0, kernel.rows);
    std::vector<cv::Mat> channels;
    cv::split(picture, channels);
    for (cv::Mat& channel : channels) {
        cv::Mat spectrum = cv::Mat::zeros(size, depth);
        channel.convertTo(spectrum(cv::Rect(0, 0, channel.cols, channel.rows)), depth);
        cv::dft(spectrum, spectrum, 0, channel.rows);
        cv::mulSpectrums(spectrum, disc, spectrum, 0);
        cv::dft(spectrum, spectrum, cv::DFT_INVERSE | cv::DFT_SCALE | cv::DFT_REAL_OUTPUT);
        channel = spectrum(cv::Rect(kernel.cols / 2, kernel.rows / 2, picture.cols, picture.rows));
    }
    cv::Mat out;
    cv::merge(channels, out);
    return out;
}

cv::Mat dft(const cv::Mat& picture, double radius) { return bySpectra(picture, radius, CV_32F); }

void gatherAt(const cv::Mat& picture, const cv::Mat& radii, int x, int y, float* out) {
    const int channels = picture.channels();
    const float radius = radii.at<float>(y, x);
    const int reach = static_cast<int>(radius);
    std::fill_n(out, channels, 0.0F);
    int count = 0;
    for (int dy = -reach; dy <= reach; ++dy) {
        const int half = static_cast<int>(std::sqrt(radius * radius - static_cast<float>(dy * dy)));
        count += 2 * half + 1;
        if (y + dy < 0 || y + dy >= picture.rows) continue;
        const auto* row = picture.ptr<float>(y + dy);
        for (int i = std::max(0, x - half); i <= std::min(picture.cols - 1, x + half); ++i)
            for (int c = 0; c < channels; ++c)
                out[c] += row[i * channels + c];
    }
    for (int c = 0; c < channels; ++c)
        out[c] /= static_cast<float>(count);
}

/// What the engine keeps between frames: kernels and maps, and planes to work in.
struct Kept {
    view::TileCount tiles;
    view::Shown shown;
    view::PaddedPlane values, averages;
    cv::Mat out;
};

/// One channel through the engine's own loops: averages, running sums, rims, interpolation.
cv::Mat byTiles(const cv::Mat& picture, double radius, const view::RungRules& rules) {
    static std::map<std::pair<double, double>, Kept> all;
    const auto [found, fresh] = all.try_emplace({radius, rules.half_px});
    Kept& kept = found->second;
    if (fresh) {
        kept.tiles = view::tileCount({picture.cols, picture.rows});
        view::Looks looks;
        looks.fill({radius, 1.0, 0.5 * picture.cols, 0.5 * picture.rows});
        kept.shown = view::shown(looks, 1, kept.tiles, rules);
        const int c = kept.shown.placing.coarse, width = kept.tiles.columns * view::kTileW,
                  height = kept.tiles.rows * view::kTileH;
        kept.values = view::PaddedPlane(width, height);
        if (c > 1) kept.averages = view::PaddedPlane(width / c, height / c);
        kept.out = cv::Mat(picture.rows, picture.cols, CV_32F);
    }
    for (int y = 0; y < picture.rows; ++y)
        std::copy_n(picture.ptr<float>(y), picture.cols, kept.values.at(0, y));
    const view::TileCount tiles = kept.tiles;
    const int coarse = kept.shown.placing.coarse;
    view::Workspace& work = view::workspace();
    for (int tile = 0; tile < tiles.count() && coarse > 1; ++tile) {
        const view::ViewRect rect = tiles.rect(tile), window = rect.grown(view::averagingLead(coarse));
        view::averageTile(kept.averages.at(rect.x0 / coarse, rect.y0 / coarse), kept.averages.stride(), coarse, nullptr,
                          0, 1.0F, kept.values.at(window.x0, window.y0), kept.values.stride());
    }
    std::array<float, view::kTilePixels> seen;
    for (int tile = 0; tile < tiles.count(); ++tile) {
        seen.fill(0.0F);
        const view::ViewRect part = kept.shown.samples(tiles, tile), rect = tiles.rect(tile);
        view::sumSource(work, kept.shown, part, {{}, coarse > 1 ? &kept.averages : &kept.values});
        view::addSummed(seen.data(), work, kept.shown, kept.shown.kernel(0, 1), tiles, tile, part, nullptr, 1.0F);
        for (int y = 0; y < std::min(view::kTileH, picture.rows - rect.y0); ++y) {
            std::copy_n(seen.data() + y * view::kTileW, std::min(view::kTileW, picture.cols - rect.x0),
                        kept.out.ptr<float>(rect.y0 + y) + rect.x0);
        }
    }
    return kept.out;
}

}  // namespace

const std::vector<Blur>& libraryBlurs() {
    static const std::vector<Blur> all{{"filter2D", filtered}, {"GaussianBlur", gaussian}, {"box", box}, {"DFT", dft}};
    return all;
}

cv::Mat engineExact(const cv::Mat& picture, double radius) {
    view::RungRules exact = view::rulesOf(Rung::idle);
    exact.half_px = exact.quarter_px = exact.thinRim_px = 1e9;
    return byTiles(picture, radius, exact);
}
cv::Mat engineAtRest(const cv::Mat& picture, double radius) {
    return byTiles(picture, radius, view::rulesOf(Rung::rest));
}

cv::Mat gatheredRows(const cv::Mat& picture, const cv::Mat& radii, int rows) {
    cv::Mat out(rows, picture.cols, picture.type());
    const int first = (picture.rows - rows) / 2;
    for (int y = 0; y < rows; ++y)
        for (int x = 0; x < picture.cols; ++x)
            gatherAt(picture, radii, x, first + y, out.ptr<float>(y) + x * picture.channels());
    return out;
}

std::vector<float> gathered(const cv::Mat& picture, const cv::Mat& radii, const std::vector<cv::Point>& at) {
    const auto channels = static_cast<std::size_t>(picture.channels());
    std::vector<float> out(at.size() * channels);
    for (std::size_t i = 0; i < at.size(); ++i)
        gatherAt(picture, radii, at[i].x, at[i].y, out.data() + i * channels);
    return out;
}

cv::Mat discKernel(double radius) {
    // What a program would keep between frames.
    static std::map<double, cv::Mat> kept;
    cv::Mat& kernel = kept[radius];
    if (!kernel.empty()) return kernel;
    const int reach = static_cast<int>(std::ceil(radius + 1.0));
    kernel = cv::Mat(2 * reach + 1, 2 * reach + 1, CV_64F);
    for (int dy = 0; dy <= reach; ++dy) {
        for (int dx = 0; dx <= reach; ++dx) {
            const double weight = weightOf(radius, dx, dy);
            for (const int y : {reach - dy, reach + dy})
                for (const int x : {reach - dx, reach + dx})
                    kernel.at<double>(y, x) = weight;
        }
    }
    kernel /= cv::sum(kernel)[0];
    return kernel;
}

cv::Mat exactBlur(const cv::Mat& picture, double radius) { return bySpectra(picture, radius, CV_64F); }

}  // namespace ilf::bench
