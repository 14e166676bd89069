#include "app/headless/render_error.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdio>
#include <limits>
#include <vector>

#include "core/optics/eye.h"
#include "core/perceived/border_search.h"

namespace ilf::app {
namespace {

/// PSNR of a sum of squares over that many numbers.
double decibels(double squares, std::int64_t count) {
    if (count == 0 || squares == 0.0) return std::numeric_limits<double>::infinity();
    return -10.0 * std::log10(squares / static_cast<double>(count));
}

}  // namespace

int bandReach(const Compiled& compiled, const ViewRequest& request) {
    const Plan& plan = compiled.plan;
    const EyeOptics& eye = plan.input.eye;
    const RegionPlan* attended = nullptr;
    for (const RegionPlan& region : plan.regions) {
        if (!plan.input.camera && request.attending == region.id) attended = &region;
    }
    double largest = 0.0;
    for (const RegionPlan& region : plan.regions) {
        for (const Level& level : plan.levels) {
            for (const Metre distance : {region.nearest, region.farthest}) {
                const Dioptre off = attended == nullptr ? defocus(eye, distance, level.power)
                                                        : defocusAttending(eye, distance, level.power,
                                                                           attended->nearest, attended->levelPower);
                const double seen = magnification(eye, distance, plan.focusPower, level.power) /
                                    magnification(eye, distance, {}, level.power);
                const double angle = 0.5 * std::abs(eye.pupil * off) * seen;
                if (std::isfinite(angle)) largest = std::max(largest, angle);
            }
        }
    }
    return static_cast<int>(std::ceil(largest * compiled.document.scene.scale.focalPixels * request.scale + 2.0));
}

Image<std::uint8_t> bordersOf(const Compiled& compiled, Size view, int reach) {
    const view::LitRegions regions(compiled);
    const Size picture = compiled.document.scene.size();
    const auto width = static_cast<std::size_t>(view.width), height = static_cast<std::size_t>(view.height);
    std::vector<std::size_t> owner(width * height);
    for (int y = 0; y < view.height; ++y) {
        for (int x = 0; x < view.width; ++x) {
            owner[static_cast<std::size_t>(y) * width + static_cast<std::size_t>(x)] =
                regions.owner(x * picture.width / view.width, y * picture.height / view.height);
        }
    }
    std::vector<std::uint8_t> band(width * height, 0);
    const auto mark = [&](int x, int y) {
        const int y1 = std::min(view.height, y + reach + 1);
        for (int j = std::max(0, y - reach); j < y1; ++j) {
            const int half = static_cast<int>(std::sqrt(reach * reach - (j - y) * (j - y)));
            auto* row = band.data() + static_cast<std::size_t>(j) * width;
            std::fill(row + std::max(0, x - half), row + std::min(view.width, x + half + 1), std::uint8_t{255});
        }
    };
    for (int y = 0; y < view.height; ++y) {
        for (int x = 0; x < view.width; ++x) {
            const std::size_t at = static_cast<std::size_t>(y) * width + static_cast<std::size_t>(x);
            if ((x + 1 < view.width && owner[at] != owner[at + 1]) ||
                (y + 1 < view.height && owner[at] != owner[at + width])) {
                mark(x, y);
            }
        }
    }
    return Image<std::uint8_t>(view, 1, std::move(band));
}

ErrorMap errorMap(const Radiance& seen, const Radiance& reference, const Image<std::uint8_t>& band) {
    assert(seen.size() == reference.size() && seen.channels() == reference.channels() && band.size() == seen.size());
    std::vector<float> difference(seen.pixels().size());
    ErrorFigures figures;
    double squares = 0.0, bandSquares = 0.0;
    std::int64_t bandCount = 0;
    const auto channels = static_cast<std::size_t>(seen.channels());
    for (std::size_t i = 0; i < difference.size(); ++i) {
        const double d = static_cast<double>(seen.pixels()[i]) - static_cast<double>(reference.pixels()[i]);
        difference[i] = static_cast<float>(d);
        squares += d * d;
        const std::size_t pixel = i / channels;
        if (band.pixels()[pixel] != 0) {
            bandSquares += d * d;
            ++bandCount;
        }
        if (std::abs(d) > figures.worst) {
            figures.worst = std::abs(d);
            figures.worstX = static_cast<int>(pixel) % seen.width();
            figures.worstY = static_cast<int>(pixel) / seen.width();
        }
    }
    figures.psnr_dB = decibels(squares, static_cast<std::int64_t>(difference.size()));
    figures.bandPsnr_dB = decibels(bandSquares, bandCount);
    return {Radiance(seen.size(), seen.channels(), std::move(difference)), figures};
}

double whiteFor(double worst) {
    if (!(worst > 0.0)) return 1e-3;
    const double decade = std::pow(10.0, std::floor(std::log10(worst)));
    for (const double step : {1.0, 2.0, 5.0}) {
        if (worst <= step * decade) return step * decade;
    }
    return 10.0 * decade;
}

std::string spokenPsnr(double psnr_dB, double noiseFloor_dB) {
    constexpr double kOfNoise_dB = 3.0;  // at this distance half of what is measured is the reference's noise
    char text[40];
    const bool drowned = psnr_dB > noiseFloor_dB - kOfNoise_dB;
    if (std::isinf(psnr_dB) && !drowned) return "no difference";
    std::snprintf(text, sizeof text, "%s%.1f dB", drowned ? "above " : "",
                  drowned ? noiseFloor_dB - kOfNoise_dB : psnr_dB);
    return std::isinf(noiseFloor_dB) && std::isinf(psnr_dB) ? "no difference" : text;
}

}  // namespace ilf::app
