#include "core/perceived/composite.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/base/parallel.h"
#include "core/perceived/magnify.h"

namespace ilf::view {
namespace {

/// Discs smaller than this are no blur: less than a third of a pixel.
constexpr double kNoBlur = 0.3;
/// Magnification that moves nothing by more than this many pixels is none.
constexpr double kNoShift = 0.02;
/// Surfaces whose blur differs by less than about half a pixel are blurred alike, however small it is.
constexpr double kAlike = 0.6;

/// How far apart two surfaces show one point of the picture: at most, over a box.
double parted(const Appearance& a, const Appearance& b, PixelRect<ViewFrame> box) {
    const auto shown = [](double at, double centre, double s) { return centre + s * (at - centre); };
    double most = 0.0;
    for (const int x : {box.x0, box.x1}) {
        for (const int y : {box.y0, box.y1}) {
            most =
                std::max(most, std::hypot(shown(x, a.centreX, a.magnification) - shown(x, b.centreX, b.magnification),
                                          shown(y, a.centreY, a.magnification) - shown(y, b.centreY, b.magnification)));
        }
    }
    return most;
}

/// Over the nearer one's box.
bool blurredAlike(const Appearance& nearer, const Appearance& farther, PixelRect<ViewFrame> box) {
    const double smaller = std::min(std::abs(nearer.radius), std::abs(farther.radius));
    const double apart = std::abs(nearer.radius - farther.radius) + parted(nearer, farther, box);
    return apart < std::max(kAlike, smaller);
}

/// One light's contribution, surface by surface from the nearest.
class Compositing {
public:
    Compositing(Block& into, const std::vector<Surface>& surfaces, const std::vector<Appearance>& looks,
                const Image<float>& albedo, const Light& light)
        : into_(into), surfaces_(surfaces), looks_(looks), albedo_(albedo), light_(light) {
        for (const Surface& surface : surfaces)
            lit_.push_back(litPart(surface));
    }

    void run() {
        const auto lastLit =
            std::ranges::find_if(lit_.rbegin(), lit_.rend(), [](const auto& box) { return !box.empty(); });
        const auto end = static_cast<std::size_t>(lit_.rend() - lastLit);
        for (std::size_t first = 0; first < end;) {
            std::size_t last = first + 1;
            while (last < surfaces_.size() &&
                   blurredAlike(looks_[last - 1], looks_[last], surfaces_[last - 1].covered)) {
                ++last;
            }
            cluster(first, last, last < end);
            first = last;
        }
    }

private:
    /// Surfaces first..last-1 are blurred alike: they hide each other on the spot and what follows together.
    void cluster(std::size_t first, std::size_t last, bool hidesOthers) {
        std::vector<float> left;  // of each pixel, after the cluster's nearer surfaces; empty: all
        Block opacity;
        if (hidesOthers) opacity = Block(into_.width, into_.height, 1);
        for (std::size_t k = first; k < last; ++k) {
            add(k, left, hidesOthers ? &opacity : nullptr);
            if (k + 1 == last) continue;
            if (left.empty())
                left.assign(static_cast<std::size_t>(into_.width) * static_cast<std::size_t>(into_.height), 1.0F);
            const auto alpha = surfaces_[k].alpha.pixels();
            for (std::size_t i = 0; i < left.size(); ++i)
                left[i] *= 1.0F - alpha[i];
        }
        if (!hidesOthers) return;
        if (passing_.values.empty()) {
            passing_ = Block(into_.width, into_.height, 1);
            std::ranges::fill(passing_.values, 1.0F);
        }
        for (std::size_t i = 0; i < opacity.values.size(); ++i) {
            passing_.values[i] *= 1.0F - std::clamp(opacity.values[i], 0.0F, 1.0F);
        }
    }

    void add(std::size_t k, const std::vector<float>& left, Block* opacity) {
        const PixelRect<ViewFrame> box = opacity ? surfaces_[k].covered : lit_[k];
        if (box.empty()) return;
        const Appearance& look = looks_[k];
        const double farthest = std::max({std::abs(box.x0 - look.centreX), std::abs(box.x1 - look.centreX),
                                          std::abs(box.y0 - look.centreY), std::abs(box.y1 - look.centreY)});
        const bool sharp = std::abs(look.radius) < kNoBlur;
        const bool still = std::abs(look.magnification - 1.0) * farthest < kNoShift;
        const int colours = lit_[k].empty() ? 0 : into_.channels;
        if (sharp && still) return addInPlace(k, left, box, colours, opacity);

        const int coarser = coarseness(sharp ? 0.0 : std::abs(look.radius));
        Block block = gathered(k, left, box, colours, opacity != nullptr, coarser);
        double originX = box.x0, originY = box.y0;
        if (!sharp) {
            // Averaging spreads the light by (c^2 - 1) / 12 of variance, and the wider tents by (c^2 - 1) / 6; a disc
            // has r^2 / 4.
            const double c = coarser;
            const double radius = std::sqrt(look.radius * look.radius - (c * c - 1.0)) / c;
            const int reach = discReach(radius);
            block = discBlurred(block, radius);
            originX -= reach * c;
            originY -= reach * c;
        }
        addMagnified(into_, opacity, passing_, block, {originX, originY, static_cast<double>(coarser)}, look, sharp,
                     colours, static_cast<float>(light_.weight));
    }

    /// Large discs are laid over averaged pixels: their cost stays that of a disc of ten.
    static int coarseness(double radius) {
        int coarser = 1;
        while (radius / coarser > 10.0)
            coarser *= 2;
        return coarser;
    }

    float coverage(std::size_t k, const std::vector<float>& left, std::size_t i) const {
        const float alpha = surfaces_[k].alpha.pixels()[i];
        return left.empty() ? alpha : alpha * left[i];
    }

    /// Light times albedo times coverage (`colours` channels), then coverage if asked for, averaged over blocks of
    /// `coarser` pixels.
    Block gathered(std::size_t k, const std::vector<float>& left, PixelRect<ViewFrame> box, int colours,
                   bool withCoverage, int coarser) const {
        const int channels = colours + (withCoverage ? 1 : 0);
        Block block((box.width() + coarser - 1) / coarser, (box.height() + coarser - 1) / coarser, channels);
        const float part = 1.0F / static_cast<float>(coarser * coarser);
        parallelFor(block.height, [&](int row) {
            float* out = block.row(row);
            for (int y = box.y0 + row * coarser; y < std::min(box.y0 + (row + 1) * coarser, box.y1); ++y) {
                const std::size_t at = static_cast<std::size_t>(y) * static_cast<std::size_t>(into_.width);
                const float* reflect = albedo_.row(y);
                const float* lit = light_.light.row(y);
                for (int x = box.x0; x < box.x1; ++x) {
                    const float cover = part * coverage(k, left, at + static_cast<std::size_t>(x));
                    float* pixel = out + (x - box.x0) / coarser * channels;
                    for (int c = 0; c < colours; ++c)
                        pixel[c] += cover * lit[x] * reflect[x * colours + c];
                    if (withCoverage) pixel[colours] += cover;
                }
            }
        });
        return block;
    }

    void addInPlace(std::size_t k, const std::vector<float>& left, PixelRect<ViewFrame> box, int colours,
                    Block* opacity) {
        const auto weight = static_cast<float>(light_.weight);
        parallelFor(box.height(), [&](int row) {
            const int y = box.y0 + row;
            const std::size_t at = static_cast<std::size_t>(y) * static_cast<std::size_t>(into_.width);
            const float* reflect = albedo_.row(y);
            const float* lit = light_.light.row(y);
            float* out = into_.row(y);
            for (int x = box.x0; x < box.x1; ++x) {
                const std::size_t i = at + static_cast<std::size_t>(x);
                const float cover = coverage(k, left, i);
                const float passing = passing_.values.empty() ? 1.0F : passing_.values[i];
                const float light = weight * passing * cover * lit[x];
                for (int c = 0; c < colours; ++c)
                    out[x * colours + c] += light * reflect[x * colours + c];
                if (opacity) opacity->values[i] += cover;
            }
        });
    }

    /// Where both light and coverage are above 0.
    PixelRect<ViewFrame> litPart(const Surface& surface) const {
        PixelRect<ViewFrame> box;
        for (int y = surface.covered.y0; y < surface.covered.y1; ++y) {
            const float* lit = light_.light.row(y);
            const float* alpha = surface.alpha.row(y);
            const auto shows = [&](int x) { return lit[x] > 0.0F && alpha[x] > 0.0F; };
            int x0 = surface.covered.x0, x1 = surface.covered.x1;
            while (x0 < x1 && !shows(x0))
                ++x0;
            while (x1 > x0 && !shows(x1 - 1))
                --x1;
            if (x0 < x1) box = box.united({x0, y, x1, y + 1});
        }
        return box;
    }

    Block& into_;
    const std::vector<Surface>& surfaces_;
    const std::vector<Appearance>& looks_;
    const Image<float>& albedo_;
    const Light& light_;
    std::vector<PixelRect<ViewFrame>> lit_;
    Block passing_;  ///< share of each pixel's rays that nearer surfaces let pass; empty: all
};

}  // namespace

void addLight(Block& into, const std::vector<Surface>& surfaces, const std::vector<Appearance>& looks,
              const Image<float>& albedo, const Light& light) {
    Compositing(into, surfaces, looks, albedo, light).run();
}

}  // namespace ilf::view
