// Cutting the scene into surfaces of constant distance.
#include <algorithm>
#include <cmath>
#include <map>

#include "core/base/parallel.h"
#include "core/perceived/perceived.h"
#include "core/perceived/surfaces.h"

namespace ilf {
namespace {

/// Half a view pixel of blur: the step between layers of a sloped surface.
constexpr double kBlurStep = 0.5;
/// A sloped surface is cut into at most this many layers.
constexpr double kMostBands = 24.0;
/// Constant surfaces whose vergences differ by less are one surface.
constexpr double kSameVergence = 1e-6;

/// A region's surface and what it covers, full size, after the regions above took theirs.
struct Cover {
    const Region* region = nullptr;
    std::vector<float> share;
};

std::vector<Cover> covers(const Document& document) {
    const Size size = document.scene.size();
    const auto width = static_cast<std::size_t>(size.width);
    const std::size_t count = width * static_cast<std::size_t>(size.height);
    std::vector<Cover> covers;
    for (const Region* region : activeRegions(document)) {
        if (!region->mask.empty() && !region->mask.blank()) covers.push_back({region, std::vector<float>(count)});
    }
    if (document.background) covers.push_back({&*document.background, std::vector<float>(count)});
    parallelFor(size.height, [&](int y) {
        std::vector<float> left(width, 1.0F);
        for (Cover& cover : covers) {
            float* share = cover.share.data() + static_cast<std::size_t>(y) * width;
            if (cover.region->mask.empty()) {
                std::copy(left.begin(), left.end(), share);
                continue;
            }
            const TileGrid& mask = cover.region->mask;
            for (int column = 0; column < mask.columns(); ++column) {
                if (mask.isUniform(column, y / kTile, 0)) continue;
                const std::uint8_t* values = mask.tile(column, y / kTile)->v.data() + (y % kTile) * kTile;
                const int x0 = column * kTile, x1 = std::min(x0 + kTile, size.width);
                for (int x = x0; x < x1; ++x) {
                    const auto i = static_cast<std::size_t>(x);
                    share[i] = left[i] * (static_cast<float>(values[x - x0]) / 255.0F);
                    left[i] -= share[i];
                }
            }
        }
    });
    return covers;
}

/// Layers under construction, by vergence in steps of kSameVergence (constant) or of the band (sloped).
struct Building {
    RegionId region;
    Dioptre vergence;
    std::vector<float> share;
};

void addShare(std::map<long, Building>& building, long key, const RegionId& region, Dioptre vergence,
              std::vector<float>&& share) {
    auto [at, fresh] = building.try_emplace(key, Building{region, vergence, {}});
    if (fresh) {
        at->second.share = std::move(share);
        return;
    }
    for (std::size_t i = 0; i < share.size(); ++i)
        at->second.share[i] += share[i];
}

long keyOf(double vergence) { return std::lround(vergence / kSameVergence); }

/// Vergence of a sloped surface at a pixel; `fallback` at holes.
class SlopedVergence {
public:
    SlopedVergence(const Document& document, const Region& region, double fallback)
        : depth_(document.scene.depth), fallback_(fallback) {
        if (const auto affine = affineVergence(region); affine && *affine) affine_ = **affine;
        fromDepth_ = std::holds_alternative<FromDepthMap>(region.distance);
    }
    double operator()(int x, int y) const {
        if (!fromDepth_) return affine_(x + 0.5, y + 0.5);
        if (!depth_ || x >= depth_->raw.width() || y >= depth_->raw.height()) return fallback_;
        const double metres = depth_->raw.at(x, y) * depth_->metresPerUnit.si();
        return metres > 0.0 ? 1.0 / metres : fallback_;
    }

private:
    Box<DepthMap> depth_;
    double fallback_;
    AffineVergence affine_;
    bool fromDepth_ = false;
};

/// Cuts a sloped surface into bands of one vergence each, on a grid shared by all sloped surfaces, so that regions on
/// one table lie on the same layers.
void addBands(std::map<long, Building>& building, const Document& document, const Cover& cover, DistanceRange range,
              double step) {
    const double nearest = 1.0 / range.nearest.si(), farthest = 1.0 / range.farthest.si();
    const SlopedVergence vergence(document, *cover.region, 0.5 * (nearest + farthest));
    std::map<long, std::vector<float>> bands;
    const Size size = document.scene.size();
    std::vector<float>* band = nullptr;
    long current = 0;
    for (int y = 0; y < size.height; ++y) {
        for (int x = 0; x < size.width; ++x) {
            const std::size_t i =
                static_cast<std::size_t>(y) * static_cast<std::size_t>(size.width) + static_cast<std::size_t>(x);
            if (cover.share[i] <= 0.0F) continue;
            const double here = std::clamp(vergence(x, y), farthest, nearest);
            const long bin = static_cast<long>(std::floor(here / step));
            if (!band || bin != current) {
                current = bin;
                band = &bands.try_emplace(bin, cover.share.size()).first->second;
            }
            (*band)[i] = cover.share[i];
        }
    }
    for (auto& [bin, share] : bands) {
        const double middle = (static_cast<double>(bin) + 0.5) * step;
        addShare(building, keyOf(middle), cover.region->id, Dioptre::fromSi(middle), std::move(share));
    }
}

}  // namespace

std::vector<SceneLayer> layers(const Document& document, const Plan& plan, double scale) {
    const view::ViewScale viewScale = view::viewScale(document, scale);
    std::vector<Cover> all = covers(document);

    // Blur in view pixels changes by at most this much for each dioptre of distance.
    const double pixelsPerDioptre = document.scene.scale.focalPixels * scale * 0.5 * plan.input.eye.pupil.si();
    double step = kBlurStep / std::max(pixelsPerDioptre, 1e-9);
    for (const RegionPlan& region : plan.regions) {
        step = std::max(step, (1.0 / region.nearest - 1.0 / region.farthest).si() / kMostBands);
    }

    std::map<long, Building> building;
    for (Cover& cover : all) {
        if (const auto* constant = std::get_if<ConstantDistance>(&cover.region->distance)) {
            const Dioptre vergence = 1.0 / constant->value;
            addShare(building, keyOf(vergence.si()), cover.region->id, vergence, std::move(cover.share));
            continue;
        }
        const auto planned = std::ranges::find(plan.regions, cover.region->id, &RegionPlan::id);
        if (planned == plan.regions.end()) continue;  // nothing of it is seen
        addBands(building, document, cover, {planned->nearest, planned->farthest, 0.0}, step);
    }
    std::vector<SceneLayer> cut;
    for (auto layer = building.rbegin(); layer != building.rend(); ++layer) {
        const Image<float> full(document.scene.size(), 1, std::move(layer->second.share));
        cut.push_back({layer->second.region, 1.0 / layer->second.vergence, view::shrunk(full, viewScale.size)});
    }
    return cut;
}

}  // namespace ilf
