#include "tests/bench/perceived/truth.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <span>

#include "app/reference_cache.h"
#include "tests/bench/perceived/optics_of.h"

namespace ilf::bench {
namespace {

/// Random pixels over the whole view, and more within the band.
constexpr int kEverywhere = 6000, kInBand = 2000;

}  // namespace

Result<Truth> Truth::of(const BenchScene& scene) {
    const Size size = scene.shown.document.scene.size();
    const std::vector<unsigned char> band = boundaryBand(scene);
    const auto inBand = [&](cv::Point p) {
        return band[static_cast<std::size_t>(p.y) * static_cast<std::size_t>(size.width) +
                    static_cast<std::size_t>(p.x)];
    };
    Truth truth;
    std::mt19937 random(99);
    const auto anywhere = [&] {
        const int x = static_cast<int>(random() % static_cast<unsigned>(size.width));
        return cv::Point(x, static_cast<int>(random() % static_cast<unsigned>(size.height)));
    };
    for (int i = 0; i < kEverywhere; ++i)
        truth.places_.push_back(anywhere());
    for (int tries = 0, found = 0; tries < 200 * kInBand && found < kInBand; ++tries) {
        const cv::Point place = anywhere();
        if (!inBand(place)) continue;
        truth.places_.push_back(place);
        ++found;
    }
    for (const cv::Point place : truth.places_)
        truth.inBand_.push_back(inBand(place));

    std::vector<ViewPixel> pixels;
    for (const cv::Point place : truth.places_)
        pixels.push_back({place.x, place.y});
    const Shown& shown = scene.shown;
    const auto reference = Reference::of(shown.document, shown.plan, shown.program, scene.request);
    if (!reference) return tl::unexpected(reference.error());
    const app::ReferenceCache cache;
    const std::span<const ViewPixel> all(pixels);
    for (const auto part : {all.first(kEverywhere), all.subspan(kEverywhere)}) {
        const auto traced = cache.pixels(*reference, part, {scene.rays, 1});
        if (!traced) return tl::unexpected(traced.error());
        truth.radiance_.insert(truth.radiance_.end(), traced->radiance.begin(), traced->radiance.end());
        (part.data() == all.data() ? truth.floor_ : truth.bandFloor_) = traced->noiseFloor_dB;
    }
    return truth;
}

Errors Truth::against(const Radiance& view) const {
    std::vector<float> seen;
    for (const cv::Point place : places_)
        for (int c = 0; c < 3; ++c)
            seen.push_back(view.at(place.x, place.y, c));
    return against(seen);
}

Errors Truth::against(const std::vector<float>& radiance) const {
    double all = 0.0, band = 0.0, worst = 0.0;
    int inBand = 0;
    for (std::size_t i = 0; i < places_.size(); ++i) {
        for (std::size_t c = 0; c < 3; ++c) {
            const double apart = std::abs(static_cast<double>(radiance[3 * i + c]) - radiance_[i][c]);
            worst = std::max(worst, apart);
            if (i < kEverywhere) all += apart * apart;
            if (inBand_[i]) band += apart * apart;
        }
        inBand += inBand_[i];
    }
    const auto decibels = [](double sum, int pixels) {
        return pixels == 0 ? kNothing : sum == 0.0 ? HUGE_VAL : -10.0 * std::log10(sum / (3.0 * pixels));
    };
    return {decibels(all, kEverywhere), decibels(band, inBand), worst, floor_, bandFloor_};
}

}  // namespace ilf::bench
