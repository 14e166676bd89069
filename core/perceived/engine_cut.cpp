#include "core/perceived/engine_cut.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace ilf::view {
namespace {

/// Constant surfaces whose vergences differ by less are one surface.
constexpr double kSameVergence = 1e-6;
/// Less than this is left of a pixel only by rounding.
constexpr float kNothing = 1.0F / 512.0F;

std::vector<Box<Region>> taking(const Document& document) {
    std::vector<Box<Region>> taking;
    for (const Region* active : activeRegions(document)) {
        if (active->mask.empty() || active->mask.blank()) continue;
        const auto box = std::ranges::find_if(document.regions, [&](const Box<Region>& r) { return &*r == active; });
        taking.push_back(*box);
    }
    if (document.background) taking.push_back(document.background);
    return taking;
}

}  // namespace

std::vector<Image<float>> pictureShares(const SceneCut& cut, Size picture, Size view, int threads) {
    const TileCount tiles = tileCount(picture);
    const std::size_t width = static_cast<std::size_t>(picture.width),
                      count = width * static_cast<std::size_t>(picture.height);
    std::vector<std::vector<float>> shares(cut.surfaces().size(), std::vector<float>(count));
    shareOut(tiles.count(), threads, [&](int tile) {
        const ViewRect rect = tiles.rect(tile);
        thread_local SceneCut::Tiles one;
        cut.shares(rect.x0, rect.y0, one);
        for (std::size_t k = 0; k < shares.size(); ++k) {
            if (!one.touched[k]) continue;
            for (int y = rect.y0; y < std::min(rect.y1, picture.height); ++y) {
                std::copy_n(one.values[k].data() + (y - rect.y0) * kTileW, std::min(kTileW, picture.width - rect.x0),
                            shares[k].data() + static_cast<std::size_t>(y) * width + static_cast<std::size_t>(rect.x0));
            }
        }
    });
    std::vector<Image<float>> resized;
    for (auto& share : shares)
        resized.push_back(shrunk(Image<float>(picture, 1, std::move(share)), view));
    return resized;
}

double bandStep(const Document& document, const Plan& plan, double scale, double coarseness) {
    constexpr double kBlurStep = 0.5, kMostBands = 24.0;
    const double pixelsPerDioptre = document.scene.scale.focalPixels * scale * 0.5 * plan.input.eye.pupil.si();
    double step = coarseness * kBlurStep / std::max(pixelsPerDioptre, 1e-9);
    for (const RegionPlan& region : plan.regions)
        step = std::max(step, (1.0 / region.nearest - 1.0 / region.farthest).si() / kMostBands);
    return step;
}

SceneCut::SceneCut(const Document& document, const Plan& plan, double step)
    : size_(document.scene.size()), step_(step), depth_(document.scene.depth) {
    std::map<long, CutSurface> byVergence;  // ascending: farthest first
    const auto keyOf = [](double vergence) { return std::lround(vergence / kSameVergence); };
    std::map<long, long> bandKeys;
    for (const Box<Region>& region : taking(document)) {
        Part part;
        part.region = region;
        if (const auto* constant = std::get_if<ConstantDistance>(&region->distance)) {
            const double vergence = (1.0 / constant->value).si();
            byVergence.try_emplace(keyOf(vergence), CutSurface{region->id, 1.0 / Dioptre::fromSi(vergence), false});
            part.nearest = part.farthest = vergence;
            part.constant = 0;  // known once all surfaces are
            parts_.push_back(std::move(part));
            continue;
        }
        const auto planned = std::ranges::find(plan.regions, region->id, &RegionPlan::id);
        if (planned == plan.regions.end()) continue;  // nothing of it is seen
        if (const auto affine = affineVergence(*region); affine && *affine) part.affine = **affine;
        part.fromDepth = std::holds_alternative<FromDepthMap>(region->distance);
        part.nearest = (1.0 / planned->nearest).si();
        part.farthest = (1.0 / planned->farthest).si();
        const auto first = static_cast<long>(std::floor(part.farthest / step_));
        const auto last = static_cast<long>(std::floor(part.nearest / step_));
        for (long bin = first; bin <= last; ++bin) {
            const double middle = (static_cast<double>(bin) + 0.5) * step_;
            byVergence.try_emplace(keyOf(middle), CutSurface{region->id, 1.0 / Dioptre::fromSi(middle), true});
            bandKeys[bin] = keyOf(middle);
        }
        parts_.push_back(std::move(part));
    }
    std::map<long, int> indexOf;
    for (auto surface = byVergence.rbegin(); surface != byVergence.rend(); ++surface) {
        indexOf[surface->first] = static_cast<int>(surfaces_.size());
        surfaces_.push_back(surface->second);
    }
    for (const auto& [bin, key] : bandKeys)
        bands_[bin] = indexOf[key];
    for (Part& part : parts_) {
        if (part.constant == 0) part.constant = indexOf[keyOf(part.nearest)];
    }
}

bool SceneCut::sameBut(const SceneCut& other) const {
    if (size_ != other.size_ || step_ != other.step_ || !depth_.same(other.depth_) || surfaces_ != other.surfaces_ ||
        parts_.size() != other.parts_.size()) {
        return false;
    }
    return std::ranges::equal(parts_, other.parts_, [](const Part& a, const Part& b) {
        return a.region->id == b.region->id && a.constant == b.constant && a.region->distance == b.region->distance &&
               a.nearest == b.nearest && a.farthest == b.farthest;
    });
}

bool SceneCut::sameShares(const SceneCut& other) const {
    if (size_ != other.size_ || surfaces_.size() != other.surfaces_.size()) return false;
    return std::ranges::equal(parts_, other.parts_, [](const Part& a, const Part& b) {
        return a.region->id == b.region->id && a.constant >= 0 && a.constant == b.constant;
    });
}

SceneCut::BetweenBands SceneCut::between(const Part& part, int x, int y) const {
    double vergence = 0.5 * (part.nearest + part.farthest);  // at holes of a depth map
    if (!part.fromDepth) {
        vergence = part.affine(x + 0.5, y + 0.5);
    } else if (depth_ && x < depth_->metres.width() && y < depth_->metres.height()) {
        const double metres = static_cast<double>(depth_->metres.at(x, y));
        if (metres > 0.0) vergence = 1.0 / metres;
    }
    vergence = std::clamp(vergence, part.farthest, part.nearest);
    const double first = std::floor(part.farthest / step_), last = std::floor(part.nearest / step_);
    const double at = std::clamp(vergence / step_ - 0.5, first, last), band = std::floor(at);
    return {static_cast<long>(band), static_cast<float>(at - band)};
}

void SceneCut::shares(int x0, int y0, Tiles& shares) const {
    auto& [alphas, touched] = shares;
    alphas.resize(surfaces_.size());
    touched.assign(surfaces_.size(), false);
    const int width = std::min(kTileW, size_.width - x0), height = std::min(kTileH, size_.height - y0);
    const auto touch = [&](int surface) -> std::array<float, kTilePixels>& {
        const auto k = static_cast<std::size_t>(surface);
        if (!touched[k]) {
            touched[k] = true;
            alphas[k].fill(0.0F);
        }
        return alphas[k];
    };
    std::array<float, kTilePixels> left;
    left.fill(1.0F);
    for (const Part& part : parts_) {
        const TileGrid& mask = part.region->mask;
        const std::uint8_t* covers = nullptr;
        bool whole = mask.empty();
        if (!mask.empty()) {
            const int column = x0 / kTile, row = y0 / kTile;
            if (mask.isUniform(column, row, 0)) continue;
            whole = mask.isUniform(column, row, 255);
            covers = mask.tile(column, row)->v.data() + (y0 % kTile) * kTile + x0 % kTile;
        }
        if (part.constant >= 0) {
            float* into = touch(part.constant).data();
            for (int y = 0; y < height; ++y) {
                for (int x = 0; x < width; ++x) {
                    const int i = y * kTileW + x;
                    float& rest = left[static_cast<std::size_t>(i)];
                    const float share = whole ? rest : rest * (static_cast<float>(covers[y * kTile + x]) / 255.0F);
                    into[i] += share;
                    rest -= share;
                }
            }
            if (whole) break;  // nothing is left for those beneath
            continue;
        }
        for (int y = 0; y < height; ++y) {
            for (int x = 0; x < width; ++x) {
                const auto i = static_cast<std::size_t>(y * kTileW + x);
                const float share = whole ? left[i] : left[i] * (static_cast<float>(covers[y * kTile + x]) / 255.0F);
                if (share <= 0.0F) continue;
                const BetweenBands at = between(part, x0 + x, y0 + y);
                touch(bands_.find(at.band)->second)[i] += (1.0F - at.next) * share;
                if (at.next > 0.0F) touch(bands_.find(at.band + 1)->second)[i] += at.next * share;
                left[i] -= share;
            }
        }
        if (whole) break;  // nothing is left for those beneath
    }
}

void SceneCut::toAlphas(Tiles& shares) const {
    // From the nearest: `rest` is what constant ones leave, `sloped` what bands took of it.
    std::array<float, kTilePixels> rest, sloped{};
    rest.fill(1.0F);
    for (std::size_t k = 0; k < surfaces_.size(); ++k) {
        if (!shares.touched[k]) continue;
        const bool band = surfaces_[k].sloped;
        for (std::size_t i = 0; i < kTilePixels; ++i) {
            float& value = shares.values[k][i];
            const float share = value, left = band ? rest[i] : rest[i] - sloped[i];
            const bool covers = share > 0.0F && left > kNothing;
            value = covers ? std::min(1.0F, share / left) : 0.0F;
            if (covers) (band ? sloped[i] : rest[i]) += band ? share : -share;
        }
    }
}

}  // namespace ilf::view
