#include "core/document/select.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace ilf {

namespace {

constexpr double kWorkingPixels = 96.0 * 1024.0;  // a third of a second
constexpr int kRounds = 3;                        // of GrabCut; later rounds move a handful of pixels
constexpr double kMargin = 0.25;                  // of the box, on each side: what GrabCut learns the surroundings from

/// The part of `picture` inside `crop` as 8-bit RGB.
cv::Mat3b cropped(const Picture& picture, PixelRect<CameraFrame> crop) {
    cv::Mat3b result(crop.height(), crop.width());
    const int channels = picture.channels();
    for (int y = crop.y0; y < crop.y1; ++y) {
        const std::uint16_t* row = picture.row(y);
        for (int x = crop.x0; x < crop.x1; ++x) {
            const std::uint16_t* p = row + static_cast<std::ptrdiff_t>(x) * channels;
            auto& to = result(y - crop.y0, x - crop.x0);
            for (int c = 0; c < 3; ++c)
                to[c] = static_cast<std::uint8_t>((p[channels >= 3 ? c : 0] + 128) / 257);
        }
    }
    return result;
}

/// A mask of the whole picture that holds `coverage` at the crop's place.
Mask placed(const cv::Mat1b& coverage, PixelRect<CameraFrame> crop, Size size) {
    Mask mask(size);
    for (int row = crop.y0 / kTile; row <= (crop.y1 - 1) / kTile; ++row) {
        for (int column = crop.x0 / kTile; column <= (crop.x1 - 1) / kTile; ++column) {
            Tile tile;
            const PixelRect<CameraFrame> at = mask.pixelsOf(column, row);
            for (int y = std::max(at.y0, crop.y0); y < std::min(at.y1, crop.y1); ++y) {
                for (int x = std::max(at.x0, crop.x0); x < std::min(at.x1, crop.x1); ++x) {
                    tile.at(x - at.x0, y - at.y0) = coverage(y - crop.y0, x - crop.x0);
                }
            }
            mask.setTile(column, row, boxed(tile));
        }
    }
    return mask;
}

/// The mean of the 5x5 pixels about (x, y), as far as they lie in the picture.
std::array<double, 3> meanAbout(const Picture& picture, int x, int y) {
    std::array<double, 3> sum{};
    int count = 0;
    for (int j = std::max(0, y - 2); j <= std::min(picture.height() - 1, y + 2); ++j) {
        for (int i = std::max(0, x - 2); i <= std::min(picture.width() - 1, x + 2); ++i) {
            for (int c = 0; c < 3; ++c) {
                sum[static_cast<std::size_t>(c)] += picture.at(i, j, picture.channels() >= 3 ? c : 0);
            }
            ++count;
        }
    }
    for (double& s : sum)
        s /= count;
    return sum;
}

/// 255 where a pixel's colour is within `tolerance` of full scale of `colour`, in every channel.
cv::Mat1b alike(const Picture& picture, const std::array<double, 3>& colour, double tolerance) {
    cv::Mat1b result(picture.height(), picture.width());
    const int channels = picture.channels();
    std::array<int, 3> low{}, high{};
    for (std::size_t c = 0; c < 3; ++c) {
        low[c] = static_cast<int>(std::ceil(colour[c] - tolerance * 65535.0));
        high[c] = static_cast<int>(std::floor(colour[c] + tolerance * 65535.0));
    }
    for (int y = 0; y < result.rows; ++y) {
        const std::uint16_t* p = picture.row(y);
        std::uint8_t* to = result[y];
        for (int x = 0; x < result.cols; ++x, p += channels) {
            bool within = true;
            for (int c = 0; c < std::min(channels, 3); ++c) {
                const auto i = static_cast<std::size_t>(c);
                within = within && p[c] >= low[i] && p[c] <= high[i];
            }
            to[x] = within ? 255 : 0;
        }
    }
    return result;
}

/// GrabCut's verdict on `crop`, where `inside` is the box in the crop's pixels: 255 = object.
cv::Mat1b told(const cv::Mat3b& crop, cv::Rect inside) {
    cv::Mat1b labels(crop.size(), static_cast<std::uint8_t>(cv::GC_BGD));
    labels(inside).setTo(cv::GC_PR_FGD);
    cv::Mat background, foreground;
    cv::theRNG().state = 0x1f0c5;  // its first clusters are drawn at random: the same click gives the same mask
    cv::grabCut(crop, labels, inside, background, foreground, kRounds, cv::GC_INIT_WITH_MASK);
    cv::Mat1b object;
    cv::bitwise_and(labels, 1, object);  // GC_FGD and GC_PR_FGD are odd
    object *= 255;
    cv::medianBlur(object, object, 5);  // specks and pinholes, which nobody means by a box
    return object;
}

/// Carries a reduced verdict to full resolution: within a few pixels of its border the picture decides, by a guided
/// filter (K. He, J. Sun, X. Tang, "Guided Image Filtering", 2013) with the green channel as guide.
cv::Mat1b refined(const cv::Mat1b& coarse, const cv::Mat3b& picture, double reduction) {
    cv::Mat1b green;
    cv::extractChannel(picture, green, 1);
    cv::Mat1f guide, input;
    green.convertTo(guide, CV_32F, 1.0 / 255.0);
    cv::Mat upright;
    cv::resize(coarse, upright, picture.size(), 0, 0, cv::INTER_LINEAR);
    upright.convertTo(input, CV_32F, 1.0 / 255.0);

    const int side = 2 * std::max(2, static_cast<int>(std::lround(2.0 * reduction))) + 1;
    constexpr double kEdge = 1e-4;  // variance of the guide that counts as an edge: 1 % of full scale
    const auto mean = [&](const cv::Mat& m) {
        cv::Mat out;
        cv::boxFilter(m, out, CV_32F, {side, side});
        return out;
    };
    const cv::Mat meanG = mean(guide), meanI = mean(input);
    const cv::Mat covariance = mean(guide.mul(input)) - meanG.mul(meanI);
    const cv::Mat variance = mean(guide.mul(guide)) - meanG.mul(meanG);
    cv::Mat slope;
    cv::divide(covariance, variance + kEdge, slope);
    const cv::Mat offset = meanI - slope.mul(meanG);
    const cv::Mat smooth = mean(slope).mul(guide) + mean(offset);

    // The filter leaves a veil of a few per cent; stretching its middle makes a border two pixels wide of it.
    cv::Mat1b result;
    smooth.convertTo(result, CV_8U, 255.0 * 2.0, -0.5 * 255.0);
    return result;
}

tl::unexpected<Error> tooHard(const cv::Exception& e) {
    return fail(Fault::unsupported, std::string("The selection failed, paint the region instead: ") + e.what());
}

}  // namespace

Result<Mask> flooded(const Picture& picture, Point<CameraFrame> seed, double tolerance) {
    if (picture.empty()) return fail(Fault::notFound, "There is no picture to select in.");
    const bool inside = seed.x >= 0.0 && seed.y >= 0.0 && seed.x < picture.width() && seed.y < picture.height();
    if (!inside) return fail(Fault::outOfRange, "The click was outside the picture: click on what shall be selected.");
    if (!(tolerance >= 0.0 && tolerance <= 1.0)) {
        return fail(Fault::outOfRange, "The tolerance of a selection must be from 0 to 1.");
    }
    const int x = static_cast<int>(seed.x);
    const int y = static_cast<int>(seed.y);
    try {
        cv::Mat1b same = alike(picture, meanAbout(picture, x, y), tolerance);
        same(y, x) = 255;  // the click itself is always part of it
        cv::Rect reached;
        constexpr int kFlooded = 128;
        cv::floodFill(same, {x, y}, kFlooded, &reached, 0, 0, 4);
        const cv::Mat area = same == kFlooded;
        cv::Mat1b smooth;  // binomial, one pixel to each side
        cv::GaussianBlur(area, smooth, {3, 3}, 0.0);
        const PixelRect<CameraFrame> crop =
            PixelRect<CameraFrame>{reached.x, reached.y, reached.x + reached.width, reached.y + reached.height}
                .grown(1)
                .clipped(picture.size());
        return placed(smooth({crop.x0, crop.y0, crop.width(), crop.height()}), crop, picture.size());
    } catch (const cv::Exception& e) {
        return tooHard(e);
    }
}

Result<Mask> cutOut(const Picture& picture, PixelRect<CameraFrame> box) {
    if (picture.empty()) return fail(Fault::notFound, "There is no picture to select in.");
    constexpr int kThinnest = 8;
    const PixelRect<CameraFrame> object = box.clipped(picture.size());
    if (object.width() < kThinnest || object.height() < kThinnest) {
        return fail(Fault::outOfRange, "Draw a box of at least 8 x 8 pixels around what shall be selected.");
    }
    const int margin = 8 + static_cast<int>(kMargin * std::max(object.width(), object.height()));
    const PixelRect<CameraFrame> crop = object.grown(margin).clipped(picture.size());
    if (crop == object) {
        return fail(Fault::outOfRange,
                    "The box holds the whole picture: draw it so that some of the surroundings stay outside.");
    }
    try {
        const cv::Mat3b full = cropped(picture, crop);
        const double reduction =
            std::max(1.0, std::sqrt(static_cast<double>(crop.width()) * crop.height() / kWorkingPixels));
        cv::Mat small = full;
        if (reduction > 1.0) cv::resize(full, small, {}, 1.0 / reduction, 1.0 / reduction, cv::INTER_AREA);
        const auto reduced = [&](int v) { return static_cast<int>(std::lround(v / reduction)); };
        cv::Rect inside(reduced(object.x0 - crop.x0), reduced(object.y0 - crop.y0),
                        std::max(1, reduced(object.width())), std::max(1, reduced(object.height())));
        inside &= cv::Rect(0, 0, small.cols, small.rows);
        const cv::Mat1b coarse = told(small, inside);
        if (cv::countNonZero(coarse) == 0) {
            return fail(Fault::notFound,
                        "Nothing in the box stands out from its surroundings: draw it closer, or paint the region.");
        }
        return placed(refined(coarse, full, reduction), crop, picture.size());
    } catch (const cv::Exception& e) {
        return tooHard(e);
    }
}

}  // namespace ilf
