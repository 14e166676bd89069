#include "core/compile/fade.h"

#include <algorithm>
#include <array>

#include "core/base/parallel.h"
#include "core/compile/parts.h"
#include "core/plan/fade.h"

namespace ilf {

namespace {

/// Every fading region as it is for `above`: in its other look if its share reaches beyond.
Document without(const Document& document, double above) {
    Document part = document;
    const auto settle = [&](Box<Region>& box) {
        if (!fading(*box)) return;
        Region region = *box;
        if (region.fade->share > above) {
            region.fade->share = 1.0;
        } else {
            region.fade.reset();
        }
        box = Box(std::move(region));
    };
    std::ranges::for_each(part.regions, settle);
    if (part.background) settle(part.background);
    return part;
}

Box<Tile> mixedTile(const std::vector<const Tile*>& tiles, const std::vector<double>& shares) {
    std::array<float, kTile * kTile> light{};
    for (std::size_t k = 0; k < tiles.size(); ++k) {
        const auto share = static_cast<float>(shares[k]);
        for (std::size_t i = 0; i < light.size(); ++i)
            light[i] += share * static_cast<float>(tiles[k]->v[i]);
    }
    Tile tile;
    for (std::size_t i = 0; i < light.size(); ++i)
        tile.v[i] = static_cast<std::uint8_t>(static_cast<int>(std::min(255.0F, light[i] + 0.5F)));
    return boxed(tile);
}

/// The parts' images, weighted. As many images of one size in each, and the shares add up to 1. Tiles equal to those of
/// `before` are shared with it.
std::vector<LightImage> mixedImages(const std::vector<const Program*>& programs, const std::vector<double>& shares,
                                    const std::vector<LightImage>& before) {
    std::vector<LightImage> images = programs.front()->images;
    const bool known = before.size() == images.size();
    parallelFor(static_cast<int>(images.size()), [&](int n) {
        const auto at = static_cast<std::size_t>(n);
        LightImage& image = images[at];
        const bool share = known && before[at].size() == image.size();
        std::vector<const Tile*> tiles(programs.size());
        for (int row = 0; row < image.rows(); ++row) {
            for (int column = 0; column < image.columns(); ++column) {
                const Box<Tile>& first = image.tile(column, row);
                bool equal = true;
                for (std::size_t k = 0; k < programs.size(); ++k) {
                    const Box<Tile>& tile = programs[k]->images[at].tile(column, row);
                    tiles[k] = &*tile;
                    equal = equal && (tile.same(first) || tile == first);
                }
                Box<Tile> made = equal ? first : mixedTile(tiles, shares);
                if (share && before[at].tile(column, row) == made) made = before[at].tile(column, row);
                image.setTile(column, row, std::move(made));
            }
        }
    });
    return images;
}

}  // namespace

std::vector<FadePart> fadeParts(const Document& document) {
    std::vector<double> ends;
    for (const Region* region : activeRegions(document))
        if (fading(*region)) ends.push_back(region->fade->share);
    if (document.background && fading(*document.background)) ends.push_back(document.background->fade->share);
    std::ranges::sort(ends);
    const auto same = std::ranges::unique(ends);
    ends.erase(same.begin(), same.end());
    if (ends.empty()) return {{document, 1.0}};
    ends.push_back(1.0);
    std::vector<FadePart> parts;
    double from = 0.0;
    for (const double to : ends) {
        parts.push_back({without(document, from), to - from});
        from = to;
    }
    return parts;
}

/// The earlier compile that serves best: itself, or one that it was mixed of.
const Compiled* likest(const Compiled* previous, const Document& document, const Plan& plan) {
    if (previous == nullptr || previous->parts == nullptr) return previous;
    for (const auto& part : previous->parts->mixedOf)
        if (sameButMasks(part->document, part->plan, document, plan)) return &*part;
    return previous;
}

Result<Compiled> compiledFading(const Document& document, const Plan& plan, const std::vector<FadePart>& parts,
                                const Compiled* previous) {
    Compiled compiled;
    std::vector<std::shared_ptr<const Compiled>> mixedOf;
    std::vector<const Program*> programs;
    std::vector<double> shares;
    for (const FadePart& part : parts) {
        auto one = compiledOne(part.document, plan, likest(previous, part.document, plan));
        if (!one) return one;
        mixedOf.push_back(std::make_shared<const Compiled>(*std::move(one)));
        programs.push_back(&mixedOf.back()->program);
        shares.push_back(part.share);
        compiled.counters.computed += mixedOf.back()->counters.computed;
        compiled.counters.seamTiles = std::max(compiled.counters.seamTiles, mixedOf.back()->counters.seamTiles);
    }
    compiled.document = document;
    compiled.plan = plan;
    compiled.program = *programs.front();
    compiled.program.images =
        mixedImages(programs, shares, previous ? previous->program.images : std::vector<LightImage>());
    const int tiles = mixedOf.front()->counters.tiles;
    compiled.counters.tiles = tiles;
    compiled.counters.computed = std::min(tiles, compiled.counters.computed);
    compiled.counters.unchanged = tiles - compiled.counters.computed;
    compiled.counters.uniform = uniformTiles(compiled.program.images);
    CompileParts own;
    if (mixedOf.front()->parts) own.sampler = mixedOf.front()->parts->sampler;
    own.mixedOf = std::move(mixedOf);
    compiled.parts = std::make_shared<const CompileParts>(std::move(own));
    return compiled;
}

}  // namespace ilf
