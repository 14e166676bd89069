// One tile of the view: surface by surface, light by light.
#include <algorithm>
#include <cmath>
#include <deque>
#include <numbers>
#include <span>

#include "core/perceived/engine_state.h"

namespace ilf::view {
namespace {

/// Share of a disc of radius `pupil` that a disc of radius `lens`, `apart` away, covers.
double overlap(double pupil, double lens, double apart) {
    if (apart <= lens - pupil) return 1.0;
    if (apart >= lens + pupil) return 0.0;
    if (apart <= pupil - lens) return lens * lens / (pupil * pupil);
    const double a = (apart * apart + pupil * pupil - lens * lens) / (2.0 * apart * pupil);
    const double b = (apart * apart + lens * lens - pupil * pupil) / (2.0 * apart * lens);
    const double kite = 0.5 * std::sqrt(std::max(0.0, (-apart + pupil + lens) * (apart + pupil - lens) *
                                                          (apart - pupil + lens) * (apart + pupil + lens)));
    const double area =
        pupil * pupil * std::acos(std::clamp(a, -1.0, 1.0)) + lens * lens * std::acos(std::clamp(b, -1.0, 1.0)) - kite;
    return area / (std::numbers::pi * pupil * pupil);
}

/// Work on one tile.
class TileWork {
public:
    TileWork(const EngineScene& scene, int tile, ViewTile& seen, ViewCounters& counters)
        : scene_(scene), tile_(tile), rect_(scene.tiles.rect(tile)), seen_(seen), counters_(counters),
          work_(workspace()) {}

    void run() {
        for (const EngineLight& light : scene_.lights)
            inLight(light);
        if (scene_.lensField) beyondLens();
    }
    bool any() const { return any_; }

private:
    void inLight(const EngineLight& light) {
        cellsPassing_.clear();
        for (std::size_t k = 0; k < scene_.surfaces.size(); ++k) {
            const EngineLook& look = light.looks[k];
            if (!look.takesPart) continue;
            const auto planes = scene_.planesOf(light, k);
            const ViewRect lit = litBox(look.shown.pixels(scene_.tiles, tile_), planes);
            const ViewRect part = look.shown.litSamples(scene_.tiles, tile_, lit);
            if (lit.empty() || part.empty()) {
                ++counters_.unlit;
                continue;
            }
            bool shared = false;
            if (!letPass(light, look, shared)) {
                ++counters_.hidden;
                continue;
            }
            if (scene_.lensField && !throughLens(look, shared)) continue;
            any_ = true;
            const float weight = static_cast<float>(light.light.weight);
            if (!conflicting_.empty()) {
                addCellwise(light, k, planes, part, shared, weight);
            } else {
                const std::array<CellShare, 1> whole{CellShare{shared ? work_.shares.data() : nullptr, weight, 0}};
                add(look, planes, part, whole);
            }
        }
        if (!cellsPassing_.empty()) ++counters_.conflicts;
    }

    /// What nearer surfaces let pass of a look, into work_.shares (if `shared`); false: nothing. Those that conflict
    /// with it are kept for its cells. Bands of a slope hide together.
    bool letPass(const EngineLight& light, const EngineLook& look, bool& shared) {
        conflicting_.clear();
        std::array<float, kTilePixels> slope;
        bool sloped = false;
        const auto hide = [&](const float* left) {
            share(work_.shares.data(), left, !shared);
            shared = true;
        };
        for (const int j : look.passedBy) {
            const EngineLook& nearer = light.looks[static_cast<std::size_t>(j)];
            const float* values = nearer.passing.values(tile_);
            std::array<float, kTilePixels> even;
            if (!values) {
                const float uniform = nearer.passing.uniform(tile_);
                if (uniform == 0.0F) return false;
                if (uniform == 1.0F) continue;
                even.fill(uniform);
                values = even.data();
            }
            if (scene_.surfaces[static_cast<std::size_t>(j)].sloped) {
                for (std::size_t i = 0; i < kTilePixels; ++i)
                    slope[i] = (sloped ? slope[i] : 1.0F) - (1.0F - values[i]);
                sloped = true;
            } else if (!scene_.cells.empty() && nearer.shown.kernels.size() > 1 && look.shown.kernels.size() > 1) {
                conflicting_.push_back(j);
            } else {
                hide(values);
            }
        }
        if (sloped) {
            for (float& left : slope)
                left = std::max(left, 0.0F);
            hide(slope.data());
        }
        return true;
    }

    /// A cell of the pupil (0: the whole), and what nearer surfaces let pass of it.
    struct CellShare {
        const float* shares = nullptr;
        float weight = 1.0F;
        std::size_t cell = 0;
    };

    void add(const EngineLook& look, const std::vector<const TilePlane*>& planes, ViewRect part,
             std::span<const CellShare> cells) {
        const Shown& shown = look.shown;
        ++(shown.sharp ? counters_.sharp : counters_.blurred);
        if (shown.still) {
            const Covered covered = coveredOver(work_, rect_, planes);
            for (std::size_t c = 0; c < 3; ++c) {
                addTile(plane(c), cells.front().shares, covered.mask, covered.stride,
                        scene_.albedo[c].at(rect_.x0, rect_.y0), scene_.albedo[c].stride(),
                        cells.front().weight * (covered.mask ? 1.0F : covered.even));
            }
            return;
        }
        const bool coarse = shown.placing.coarse != 1;
        const Covered covered = coarse ? Covered{} : coveredOver(work_, part.grown(shown.reach), planes);
        for (std::size_t c = 0; c < 3; ++c) {
            if (c + 1 < 3) fetchAhead(coarse ? look.averaged[c + 1] : scene_.albedo[c + 1], part.grown(shown.reach));
            if (!sumSource(work_, shown, part, {covered, coarse ? &look.averaged[c] : &scene_.albedo[c]})) continue;
            for (const CellShare& one : cells) {
                addSummed(plane(c), work_, shown, shown.kernel(one.cell, c), scene_.tiles, tile_, part, one.shares,
                          one.weight);
            }
        }
    }

    /// The pupil's cells one by one: within each, hiding and blur are closer to independent.
    void addCellwise(const EngineLight& light, std::size_t k, const std::vector<const TilePlane*>& planes,
                     ViewRect part, bool shared, float weight) {
        const EngineLook& look = light.looks[k];
        std::vector<const CellPlanes*> passing;
        for (const int j : conflicting_)
            passing.push_back(&cellPassing(light, j));
        CellPlanes shares(scene_.cells.size());
        std::vector<CellShare> cells;
        for (std::size_t cell = 0; cell < scene_.cells.size(); ++cell) {
            if (shared) shares[cell] = work_.shares;
            for (std::size_t n = 0; n < passing.size(); ++n)
                share(shares[cell].data(), (*passing[n])[cell].data(), !shared && n == 0);
            const double area = look.shown.kernel(cell + 1, 1)->area;
            cells.push_back({shares[cell].data(), weight * static_cast<float>(area), cell + 1});
        }
        add(look, planes, part, cells);
    }

    using CellPlanes = std::vector<std::array<float, kTilePixels>>;
    /// What each cell's rays meet of a nearer surface: worked out once for a light.
    const CellPlanes& cellPassing(const EngineLight& light, int nearer) {
        for (const auto& [surface, planes] : cellsPassing_) {
            if (surface == nearer) return planes;
        }
        const Shown& shown = light.looks[static_cast<std::size_t>(nearer)].shown;
        const EngineSurface& surface = scene_.surfaces[static_cast<std::size_t>(nearer)];
        CellPlanes made(scene_.cells.size());
        const std::array<const TilePlane*, 1> alpha{&surface.alpha};
        const ViewRect lit = litBox(shown.pixels(scene_.tiles, tile_), alpha);
        const ViewRect part = shown.litSamples(scene_.tiles, tile_, lit);
        for (auto& passing : made)
            passing.fill(1.0F);
        if (!part.empty() && sumSource(work_, shown, part, coverageOf(work_, surface, shown, part))) {
            for (std::size_t cell = 0; cell < made.size(); ++cell) {
                addSummed(made[cell].data(), work_, shown, shown.kernel(cell + 1, 1), scene_.tiles, tile_, part,
                          nullptr, -1.0F);
                for (float& value : made[cell])
                    value = std::clamp(value, 0.0F, 1.0F);
            }
        }
        return cellsPassing_.emplace_back(nearer, std::move(made)).second;
    }

    /// Of the rays of each pixel, those that meet the lens and not what lies beyond its rim.
    bool lensShares(const Appearance& look, std::array<float, kTilePixels>& into) const {
        const double middleX = rect_.x0 + 0.5 * kTileW - look.centreX, middleY = rect_.y0 + 0.5 * kTileH - look.centreY;
        const double farthest = std::hypot(middleX, middleY) + 0.5 * std::hypot(kTileW, kTileH);
        if (farthest + scene_.pupilRadius_px <= scene_.lensRadius_px) return false;
        for (int y = 0; y < kTileH; ++y) {
            for (int x = 0; x < kTileW; ++x) {
                const double apart = std::hypot(rect_.x0 + x + 0.5 - look.centreX, rect_.y0 + y + 0.5 - look.centreY);
                into[static_cast<std::size_t>(y * kTileW + x)] =
                    static_cast<float>(overlap(scene_.pupilRadius_px, scene_.lensRadius_px, apart));
            }
        }
        return true;
    }

    /// False: no ray of the tile meets the lens.
    bool throughLens(const EngineLook& look, bool& shared) {
        std::array<float, kTilePixels> lens;
        if (!lensShares(look.shown.looks[1], lens)) return true;
        if (std::ranges::all_of(lens, [](float share) { return share == 0.0F; })) return false;
        share(work_.shares.data(), lens.data(), !shared);
        shared = true;
        return true;
    }

    /// What is seen past the lens: the picture.
    void beyondLens() {
        if (scene_.lights.empty()) return;
        std::array<float, kTilePixels> left, slope{};  // of constant surfaces, and what bands took of it
        left.fill(1.0F);
        std::array<float, kTilePixels> lens;
        for (std::size_t k = 0; k < scene_.surfaces.size(); ++k) {
            const TilePlane& alpha = scene_.surfaces[k].alpha;
            if (alpha.isUniform(tile_, 0.0F)) continue;
            const bool sloped = scene_.surfaces[k].sloped;
            const bool rim = lensShares(scene_.lights.front().looks[k].shown.looks[1], lens);
            std::array<float, kTilePixels> mask;
            for (std::size_t i = 0; i < kTilePixels; ++i) {
                const float a = alpha.values(tile_) ? alpha.values(tile_)[i] : alpha.uniform(tile_);
                const float share = a * (sloped ? left[i] : left[i] - slope[i]);
                mask[i] = rim ? share * (1.0F - lens[i]) : 0.0F;
                (sloped ? slope[i] : left[i]) += sloped ? share : -share;
            }
            if (!rim) continue;
            any_ = true;
            for (std::size_t c = 0; c < 3; ++c) {
                addTile(plane(c), nullptr, mask.data(), kTileW, scene_.albedo[c].at(rect_.x0, rect_.y0),
                        scene_.albedo[c].stride(), 1.0F);
            }
        }
    }

    float* plane(std::size_t colour) { return seen_.v.data() + colour * kTilePixels; }

    const EngineScene& scene_;
    int tile_;
    ViewRect rect_;
    ViewTile& seen_;
    ViewCounters& counters_;
    Workspace& work_;
    std::vector<int> conflicting_;
    std::deque<std::pair<int, CellPlanes>> cellsPassing_;
    bool any_ = false;
};

/// Pixels beyond the view stay 0.
void trim(ViewTile& tile, ViewRect rect, Size size) {
    const int width = std::min(kTileW, size.width - rect.x0), height = std::min(kTileH, size.height - rect.y0);
    if (width == kTileW && height == kTileH) return;
    for (int c = 0; c < 3; ++c) {
        for (int y = 0; y < kTileH; ++y) {
            float* row = tile.v.data() + (c * kTileH + y) * kTileW;
            std::fill(row + (y < height ? width : 0), row + kTileW, 0.0F);
        }
    }
}

}  // namespace

std::vector<const TilePlane*> EngineScene::planesOf(const EngineLight& light, std::size_t surface) const {
    std::vector<const TilePlane*> planes{&surfaces[surface].alpha};
    if (light.light.level != Exposure::kAmbient)
        planes.push_back(&lightOfLevel[static_cast<std::size_t>(light.light.level)]);
    if (!light.looks[surface].visible.empty()) planes.push_back(&light.looks[surface].visible);
    return planes;
}

Box<ViewTile> tileSeen(const EngineScene& scene, int tile, SpareTiles& spare, ViewCounters& counters) {
    static const Box<ViewTile> dark{ViewTile{}};
    auto seen = spare.take();
    seen->v.fill(0.0F);
    TileWork work(scene, tile, *seen, counters);
    work.run();
    trim(*seen, scene.tiles.rect(tile), scene.size);
    Box<ViewTile> boxed = spare.boxed(std::move(seen));
    if (work.any()) return boxed;
    ++counters.dark;
    return dark;
}

}  // namespace ilf::view
