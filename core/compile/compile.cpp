#include "core/compile/compile.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "core/base/parallel.h"
#include "core/compile/coverage.h"
#include "core/compile/fade.h"
#include "core/compile/parts.h"

namespace ilf {

namespace {

using Rects = std::vector<PixelRect<ProjectorFrame>>;

/// Where two tiles differ, as a rectangle of the raster.
PixelRect<ProjectorFrame> difference(const Tile& a, const Tile& b, int column, int row) {
    PixelRect<ProjectorFrame> differs;
    for (int y = 0; y < kTile; ++y) {
        const auto* p = &a.v[static_cast<std::size_t>(y * kTile)];
        const auto* q = &b.v[static_cast<std::size_t>(y * kTile)];
        if (std::memcmp(p, q, kTile) == 0) continue;
        const auto [first, unused] = std::mismatch(p, p + kTile, q);
        int last = kTile;
        while (p[last - 1] == q[last - 1])
            --last;
        const int x0 = column * kTile + static_cast<int>(first - p), y0 = row * kTile + y;
        differs = differs.united({x0, y0, column * kTile + last, y0 + 1});
    }
    return differs;
}

/// Puts a new tile in place. An equal one keeps the old box, so that what shares boxes downstream stays shared.
/// Gives the pixels that changed.
PixelRect<ProjectorFrame> replace(TileGrid& grid, int column, int row, const Box<Tile>& tile) {
    const Box<Tile> old = grid.tile(column, row);
    if (old.same(tile)) return {};
    grid.setTile(column, row, tile);
    const PixelRect<ProjectorFrame> differs = difference(*old, *grid.tile(column, row), column, row);
    if (differs.empty()) grid.setTile(column, row, old);
    return differs;
}

/// Tiles of the raster, as indices row by row.
class Raster {
public:
    explicit Raster(const Lighting& light) : columns_(light.columns), rows_(light.rows) {}
    std::vector<TilePart> all() const {
        std::vector<TilePart> parts;
        for (int row = 0; row < rows_; ++row) {
            for (int column = 0; column < columns_; ++column)
                parts.push_back({column, row, tileRect(column, row)});
        }
        return parts;
    }
    /// The parts of tiles that a change inside `changed` can reach from at most `reach` pixels away.
    std::vector<TilePart> reached(const Rects& changed, int reach) const {
        std::vector<PixelRect<ProjectorFrame>> hit(static_cast<std::size_t>(columns_ * rows_));
        for (const PixelRect<ProjectorFrame>& rect : changed) {
            const PixelRect<ProjectorFrame> r = rect.grown(reach).clipped({columns_ * kTile, rows_ * kTile});
            for (int row = r.y0 / kTile; row * kTile < r.y1; ++row) {
                for (int column = r.x0 / kTile; column * kTile < r.x1; ++column) {
                    const PixelRect<ProjectorFrame> tile = tileRect(column, row);
                    auto& part = hit[static_cast<std::size_t>(row * columns_ + column)];
                    part = part.united({std::max(r.x0, tile.x0), std::max(r.y0, tile.y0), std::min(r.x1, tile.x1),
                                        std::min(r.y1, tile.y1)});
                }
            }
        }
        std::vector<TilePart> parts;
        for (int row = 0; row < rows_; ++row) {
            for (int column = 0; column < columns_; ++column) {
                const PixelRect<ProjectorFrame>& r = hit[static_cast<std::size_t>(row * columns_ + column)];
                const auto up = [](int v) { return (v + kSquare - 1) / kSquare * kSquare; };
                const auto down = [](int v) { return v / kSquare * kSquare; };
                if (!r.empty()) parts.push_back({column, row, {down(r.x0), down(r.y0), up(r.x1), up(r.y1)}});
            }
        }
        return parts;
    }

private:
    int columns_, rows_;
};

/// Works out results side by side, then hands them over one after the other.
template <class Result, class Make, class Take>
void computed(const std::vector<TilePart>& tiles, Make&& make, Take&& take) {
    std::vector<Result> results(tiles.size());
    parallelFor(static_cast<int>(tiles.size()),
                [&](int i) { results[static_cast<std::size_t>(i)] = make(tiles[static_cast<std::size_t>(i)]); });
    for (std::size_t i = 0; i < tiles.size(); ++i)
        take(tiles[i], std::move(results[i]));
}

/// What each image of the program shows: first every level alone at full light, then what slots show besides: part of a
/// level's light, or several levels together.
std::vector<std::vector<LevelLight>> shownLights(const Plan& plan) {
    std::vector<std::vector<LevelLight>> shown;
    for (int level = 0; level < static_cast<int>(plan.levels.size()); ++level)
        shown.push_back({{level, 1.0}});
    for (const Slot& slot : plan.slots) {
        if (!slot.lit.empty() && std::ranges::find(shown, slot.lit) == shown.end()) shown.push_back(slot.lit);
    }
    return shown;
}

/// The sum of levels' tiles, each weighted. More than full light is cut off: levels that share a slot lie on different
/// pixels, but for blurs of different width at their common border.
Box<Tile> mixed(const std::vector<LevelLight>& lit, const std::vector<Box<Tile>>& levels) {
    const auto tileOf = [&](const LevelLight& one) -> const Box<Tile>& {
        return levels[static_cast<std::size_t>(one.level)];
    };
    const bool even = std::ranges::all_of(
        lit, [&](const LevelLight& one) { return tileOf(one).same(uniformTile(tileOf(one)->v[0])); });
    Tile sum;
    const std::size_t count = even ? 1 : sum.v.size();
    std::array<float, kTile * kTile> light{};
    for (const LevelLight& one : lit) {
        const auto weight = static_cast<float>(one.weight);
        const std::uint8_t* v = tileOf(one)->v.data();
        for (std::size_t i = 0; i < count; ++i)
            light[i] += weight * static_cast<float>(v[i]);
    }
    for (std::size_t i = 0; i < count; ++i)
        sum.v[i] = static_cast<std::uint8_t>(static_cast<int>(std::min(255.0F, light[i] + 0.5F)));
    return even ? uniformTile(sum.v[0]) : boxed(sum);
}

/// One compile in the making.
class Compiler {
public:
    /// `known`: a sampler of an earlier compile, or none; taken where it fits.
    Compiler(const Document& document, const Plan& plan, const Compiled* previous, const Box<CoverageSampler>& known)
        : document_(document), regions_(activeRegions(document)), map_(pixelMap(document)), shown_(shownLights(plan)),
          previous_(previous) {
        if (previous_ != nullptr) {
            parts_ = *previous_->parts;
            for (const Region* region : activeRegions(previous_->document))
                regionsBefore_.push_back(region);
            images_ = previous_->program.images;
            return;
        }
        const Size size = document.rig.projector;
        const bool fits = known && known->isFor(document.scene.size(), size, map_);
        parts_.sampler = fits ? known : Box<CoverageSampler>(CoverageSampler(document.scene.size(), size, map_));
        parts_.light = Box<Lighting>(lighting(document, plan));
        parts_.coverage.assign(regions_.size(), TileGrid(size));
        parts_.visible.assign(light().sheets.size(), TileGrid(size));
        parts_.layers.lit.assign(light().layers.size(), TileGrid(size));
        parts_.layers.seen = parts_.layers.lit;
        parts_.layers.hard = TileGrid(size);
        images_.assign(shown_.size(), TileGrid(size));
    }

    void run() {
        const Raster raster(light());
        const auto next = [&](const Rects& changed, int reach) {
            return previous_ == nullptr ? raster.all() : raster.reached(changed, reach);
        };
        const Rects covered = cover(raster);
        const Rects seen = uncover(next(covered, 0));
        const Rects lit = lightLayers(next(seen, light().layerReach));
        lightLevels(next(lit, light().blendReach));
    }

    Compiled result(const Plan& plan) && {
        Compiled compiled;
        compiled.document = document_;
        compiled.plan = plan;
        compiled.program.images = std::move(images_);
        const int tiles = light().columns * light().rows * static_cast<int>(shown_.size());
        compiled.counters.tiles = tiles;
        compiled.counters.computed = computed_;
        compiled.counters.unchanged = tiles - computed_;
        compiled.counters.seamTiles = light().blending == Blending::none ? 0 : seamTiles();
        compiled.parts = std::make_shared<const CompileParts>(std::move(parts_));
        return compiled;
    }

private:
    const Lighting& light() const { return *parts_.light; }

    /// From nothing, no one asks what changed.
    PixelRect<ProjectorFrame> put(TileGrid& grid, int column, int row, const Box<Tile>& tile) const {
        if (previous_ != nullptr) return replace(grid, column, row, tile);
        grid.setTile(column, row, tile);
        return {};
    }

    /// Every region's mask on the raster.
    Rects cover(const Raster& raster) {
        Rects changed;
        const CoverageSampler& sampler = *parts_.sampler;
        const Mask blank(document_.scene.size());
        for (std::size_t r = 0; r < regions_.size(); ++r) {
            const Mask& mask = regions_[r]->mask.size() == blank.size() ? regions_[r]->mask : blank;
            const Mask* before = nullptr;
            if (previous_ != nullptr)
                before = regionsBefore_[r]->mask.size() == blank.size() ? &regionsBefore_[r]->mask : &blank;
            std::vector<TilePart> tiles;
            for (const TilePart& tile : raster.all()) {
                if (before == nullptr || differ(*before, mask, sampler.source(tile.column, tile.row))) {
                    tiles.push_back(tile);
                }
            }
            computed<Box<Tile>>(
                tiles, [&](const TilePart& tile) { return sampler.tile(mask, tile.column, tile.row); },
                [&](const TilePart& tile, const Box<Tile>& made) {
                    const auto rect = put(parts_.coverage[r], tile.column, tile.row, made);
                    if (!rect.empty()) changed.push_back(rect);
                });
        }
        return changed;
    }

    static bool differ(const Mask& a, const Mask& b, PixelRect<CameraFrame> where) {
        const PixelRect<CameraFrame> r = where.clipped(a.size());
        for (int row = r.y0 / kTile; row * kTile < r.y1; ++row)
            for (int column = r.x0 / kTile; column * kTile < r.x1; ++column)
                if (!a.tile(column, row).same(b.tile(column, row))) return true;
        return false;
    }

    /// What is seen of each sheet: the topmost region wins, by coverage; what nothing covers is background.
    Rects uncover(const std::vector<TilePart>& tiles) {
        Rects changed;
        computed<std::vector<Box<Tile>>>(
            tiles, [&](const TilePart& tile) { return visibleTiles(tile.column, tile.row); },
            [&](const TilePart& tile, const std::vector<Box<Tile>>& made) {
                for (std::size_t s = 0; s < made.size(); ++s) {
                    const auto rect = put(parts_.visible[s], tile.column, tile.row, made[s]);
                    if (!rect.empty()) changed.push_back(rect);
                }
            });
        return changed;
    }

    std::vector<Box<Tile>> visibleTiles(int column, int row) const {
        const std::size_t sheets = light().sheets.size();
        std::vector<Tile> sums(sheets);
        std::vector<Box<Tile>> boxes(sheets, uniformTile(0));
        std::vector<char> touched(sheets, 0);
        std::array<std::uint8_t, kTile * kTile> left;
        left.fill(255);
        bool all = true, none = false;  // of the pixels still open to what lies below
        for (std::size_t r = 0; r <= regions_.size() && !none; ++r) {
            const auto sheet = static_cast<std::size_t>(light().sheetOf[r]);
            const bool last = r == regions_.size();
            const Box<Tile>& cover = last ? uniformTile(255) : parts_.coverage[r].tile(column, row);
            if (cover.same(uniformTile(0))) continue;
            if (all && cover.same(uniformTile(255))) {
                boxes[sheet] = cover;
                return boxes;
            }
            Tile& sum = sums[sheet];
            touched[sheet] = 1;
            all = false;
            const std::uint8_t* by = cover->v.data();
            std::uint8_t *to = sum.v.data(), *rest = left.data();
            std::uint8_t open = 0;
            for (std::size_t i = 0; i < left.size(); ++i) {
                // Exactly rounded division by 255, in 16 bits so that eight go at a time.
                const auto product = static_cast<std::uint16_t>(by[i] * rest[i] + 128);
                const auto take = static_cast<std::uint8_t>(static_cast<std::uint16_t>(product + (product >> 8)) >> 8);
                to[i] = static_cast<std::uint8_t>(to[i] + take);
                rest[i] = static_cast<std::uint8_t>(rest[i] - take);
                open |= rest[i];
            }
            none = open == 0;
        }
        for (std::size_t s = 0; s < sheets; ++s) {
            if (touched[s] != 0) boxes[s] = boxed(sums[s]);
        }
        return boxes;
    }

    Rects lightLayers(const std::vector<TilePart>& tiles) {
        Rects changed;
        const Visible visible{document_, light(), map_, parts_.visible};
        computed<LayerTiles>(
            tiles, [&](const TilePart& tile) { return layerTiles(visible, tile, parts_.layers); },
            [&](const TilePart& tile, const LayerTiles& made) {
                const auto take = [&](TileGrid& grid, const Box<Tile>& box) {
                    const auto rect = put(grid, tile.column, tile.row, box);
                    if (!rect.empty()) changed.push_back(rect);
                };
                for (std::size_t l = 0; l < made.lit.size(); ++l) {
                    take(parts_.layers.lit[l], made.lit[l]);
                    take(parts_.layers.seen[l], made.seen[l]);
                }
                take(parts_.layers.hard, made.hard);
            });
        return changed;
    }

    void lightLevels(const std::vector<TilePart>& tiles) {
        computed<std::vector<Box<Tile>>>(
            tiles,
            [&](const TilePart& tile) {
                auto made = levelTiles(light(), parts_.layers, tile, images_);
                for (std::size_t i = made.size(); i < shown_.size(); ++i)
                    made.push_back(mixed(shown_[i], made));
                darkenUnseen(tile.column, tile.row, made);
                return made;
            },
            [&](const TilePart& tile, const std::vector<Box<Tile>>& made) {
                for (std::size_t i = 0; i < made.size(); ++i)
                    put(images_[i], tile.column, tile.row, made[i]);
            });
        computed_ = static_cast<int>(tiles.size() * images_.size());
    }

    /// Light that the camera does not see falls on nobody knows what: none in any slot.
    void darkenUnseen(int column, int row, std::vector<Box<Tile>>& made) const {
        if (!map_.dense()) return;
        const Image<std::uint8_t>& seen = map_.dense()->seen;
        const PixelRect<ProjectorFrame> at = tileRect(column, row).clipped(seen.size());
        Tile mask;
        std::uint8_t all = 255, any = 0;
        for (int y = at.y0; y < at.y1; ++y) {
            for (int x = at.x0; x < at.x1; ++x) {
                const auto v = static_cast<std::uint8_t>(seen.at(x, y) != 0 ? 255 : 0);
                mask.at(x % kTile, y % kTile) = v;
                all = std::min(all, v), any = std::max(any, v);
            }
        }
        if (all == 255) return;
        for (Box<Tile>& box : made) {
            if (box.same(uniformTile(0))) continue;
            if (any == 0) {
                box = uniformTile(0);
                continue;
            }
            Tile tile = *box;
            for (std::size_t i = 0; i < tile.v.size(); ++i)
                tile.v[i] &= mask.v[i];
            box = boxed(tile);
        }
    }

    int seamTiles() const {
        int count = 0;
        for (int row = 0; row < light().rows; ++row) {
            for (int column = 0; column < light().columns; ++column) {
                count += std::ranges::any_of(parts_.layers.lit, [&](const TileGrid& lit) {
                    return !lit.isUniform(column, row, lit.tile(column, row)->v[0]);
                });
            }
        }
        return count;
    }

    const Document& document_;
    std::vector<const Region*> regions_, regionsBefore_;
    PixelMap map_;
    std::vector<std::vector<LevelLight>> shown_;  ///< of each image
    const Compiled* previous_;
    CompileParts parts_;
    std::vector<TileGrid> images_;
    int computed_ = 0;
};

Result<void> compilable(const Document& document) {
    const Size projector = document.rig.projector;
    if (projector.width <= 0 || projector.height <= 0)
        return fail(Fault::outOfRange, "The rig's projector has no pixels: type its width and height.");
    const PixelMap map = pixelMap(document);
    const double det = map.nearest().determinant();
    if (!std::isfinite(det) || det == 0.0)
        return fail(Fault::outOfRange, "The rig's registration maps the picture onto a line: register it again.");
    const auto pixels = [](Size size) { return std::to_string(size.width) + " x " + std::to_string(size.height); };
    if (map.dense() && map.dense()->projector() != projector) {
        return fail(Fault::outOfRange, "The rig's registration was scanned on a raster of " +
                                           pixels(map.dense()->projector()) + " pixels, and the projector has " +
                                           pixels(projector) + ": scan again.");
    }
    if (map.dense() && map.dense()->camera() != document.scene.size()) {
        return fail(Fault::outOfRange, "The rig's registration was scanned for pictures of " +
                                           pixels(map.dense()->camera()) + " pixels, and the scene's picture has " +
                                           pixels(document.scene.size()) +
                                           ": grab the picture with the scanned camera, or scan again.");
    }
    if (!isFinite(document.seam.feather) || document.seam.feather < 0.0_m)
        return fail(Fault::outOfRange, "The feather must be 0 mm or more.");
    std::vector<const Region*> surfaces = activeRegions(document);
    surfaces.push_back(&*document.background);
    for (const Region* region : surfaces) {
        if (const auto vergence = affineVergence(*region); !vergence) return tl::unexpected(vergence.error());
    }
    return {};
}

}  // namespace

int uniformTiles(const std::vector<LightImage>& images) {
    int count = 0;
    for (const LightImage& image : images) {
        for (int row = 0; row < image.rows(); ++row) {
            for (int column = 0; column < image.columns(); ++column)
                count += image.isUniform(column, row, image.tile(column, row)->v[0]) ? 1 : 0;
        }
    }
    return count;
}

Result<Compiled> compiledOne(const Document& document, const Plan& plan, const Compiled* previous) {
    const bool shared = previous != nullptr && previous->parts != nullptr && previous->parts->light &&
                        sameButMasks(previous->document, previous->plan, document, plan);
    Compiled compiled;
    if (!plan.sweeps() || plan.levels.empty()) {
        // Nothing to blur: all light is one even picture, whatever was painted.
        const Size size = document.rig.projector;
        compiled.document = document;
        compiled.plan = plan;
        compiled.program.images = {TileGrid(size, 255)};
        compiled.counters.tiles = compiled.program.images.front().columns() * compiled.program.images.front().rows();
        compiled.counters.unchanged = compiled.counters.tiles;
        compiled.program.imageOfSlot.assign(static_cast<std::size_t>(slotsPerSweep(document.rig)), 0);
    } else {
        const bool knows = previous != nullptr && previous->parts != nullptr;
        Compiler compiler(document, plan, shared ? previous : nullptr,
                          knows ? previous->parts->sampler : Box<CoverageSampler>());
        compiler.run();
        compiled = std::move(compiler).result(plan);
        const std::vector<std::vector<LevelLight>> shown = shownLights(plan);
        for (const Slot& slot : plan.slots) {
            const auto image = std::ranges::find(shown, slot.lit) - shown.begin();
            compiled.program.imageOfSlot.push_back(slot.lit.empty() ? Program::kDark : static_cast<int>(image));
        }
    }
    compiled.counters.uniform = uniformTiles(compiled.program.images);
    compiled.program.waveform = plan.waveform;
    compiled.program.slotRate = document.rig.slotRate;
    compiled.program.projectorDelay = document.rig.projectorDelay;
    compiled.program.projector = document.rig.projector;
    return compiled;
}

Result<Compiled> compile(const Document& document, const Plan& plan, const Compiled* previous) {
    if (!document.background) return fail(Fault::notFound, "The project has no background: add one.");
    if (const auto good = compilable(document); !good) return tl::unexpected(good.error());
    const auto parts = fadeParts(document);
    auto compiled = parts.size() > 1 ? compiledFading(document, plan, parts, previous)
                                     : compiledOne(document, plan, likest(previous, document, plan));
    if (!compiled) return compiled;
    if (const auto good = checked(compiled->program); !good) return tl::unexpected(good.error());
    return compiled;
}

}  // namespace ilf
