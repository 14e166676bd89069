// Where a region's surface lies: at a pixel, over the picture, and from its nearest to its farthest point seen.
#include <algorithm>
#include <bitset>
#include <cmath>
#include <limits>

#include "core/document/document.h"

namespace ilf {

namespace {

constexpr std::uint8_t kCovers = 128;  // at least half

/// The affine function through three values, or nothing when the anchors are on one line: less than half a pixel of
/// height over their longest side would turn a click's error into any slope.
std::optional<AffineVergence> through(const PlaneDistance& plane) {
    const auto& [a, b, c] = plane.anchors;
    const double bx = b.at.x - a.at.x, by = b.at.y - a.at.y;
    const double cx = c.at.x - a.at.x, cy = c.at.y - a.at.y;
    const double doubleArea = bx * cy - by * cx;
    const double longest = std::max({std::hypot(bx, by), std::hypot(cx, cy), std::hypot(cx - bx, cy - by)});
    if (!(std::abs(doubleArea) >= 0.5 * longest) || longest == 0.0) return std::nullopt;
    const double xa = (1.0 / a.distance).si();
    const double vb = (1.0 / b.distance).si() - xa;
    const double vc = (1.0 / c.distance).si() - xa;
    AffineVergence v;
    v.dx = (vb * cy - vc * by) / doubleArea;
    v.dy = (vc * bx - vb * cx) / doubleArea;
    v.at = xa - v.dx * a.at.x - v.dy * a.at.y;
    return v;
}

Metre metresAt(double vergence) { return Metre::fromSi(1.0 / std::max(vergence, 1.0 / kFarthestDistance.si())); }

/// The pixels of one tile at which a region is seen.
struct SeenTile {
    PixelRect<CameraFrame> pixels;
    bool all = false;
    std::bitset<kTile * kTile> some;

    bool at(int x, int y) const {  // picture coordinates
        return all || some[static_cast<std::size_t>((y - pixels.y0) * kTile + (x - pixels.x0))];
    }
};

/// Calls `visit(SeenTile)` for each tile where something is seen of `region`; an empty mask covers everything.
template <class Visit>
void forEachSeenTile(const Document& document, const Region& region, Visit&& visit) {
    const TileGrid everything = region.id == kBackgroundId ? TileGrid(document.scene.size(), 255) : TileGrid();
    const Mask& mask = region.id == kBackgroundId ? everything : region.mask;
    const std::vector<const Region*> active = activeRegions(document);
    std::vector<const Mask*> above;
    for (const Box<Region>& other : document.regions) {
        if (other->id == region.id) break;
        const bool takesPart = std::find(active.begin(), active.end(), &*other) != active.end();
        if (takesPart && other->mask.size() == mask.size()) above.push_back(&other->mask);
    }
    for (int row = 0; row < mask.rows(); ++row) {
        for (int column = 0; column < mask.columns(); ++column) {
            const Box<Tile>& own = mask.tile(column, row);
            if (own.same(uniformTile(0))) continue;
            std::vector<const Tile*> hiding;
            bool hidden = false;
            for (const Mask* m : above) {
                const Box<Tile>& t = m->tile(column, row);
                if (t.same(uniformTile(0))) continue;
                hidden = hidden || t.same(uniformTile(255));
                hiding.push_back(&*t);
            }
            if (hidden) continue;
            SeenTile seen;
            seen.pixels = mask.pixelsOf(column, row);
            seen.all = hiding.empty() && own.same(uniformTile(255));
            if (!seen.all) {
                for (int y = 0; y < seen.pixels.height(); ++y) {
                    for (int x = 0; x < seen.pixels.width(); ++x) {
                        bool on = own->at(x, y) >= kCovers;
                        for (const Tile* t : hiding)
                            on = on && t->at(x, y) < kCovers;
                        seen.some[static_cast<std::size_t>(y * kTile + x)] = on;
                    }
                }
                if (seen.some.none()) continue;
            }
            visit(seen);
        }
    }
}

struct VergenceSpan {
    double low = std::numeric_limits<double>::infinity();
    double high = -std::numeric_limits<double>::infinity();
    void take(double v) {
        low = std::min(low, v);
        high = std::max(high, v);
    }
    bool any() const { return low <= high; }
};

/// Least and greatest vergence over the centres of the pixels seen. An affine function is extreme at the ends of each
/// row, and over a whole rectangle at its corners.
VergenceSpan vergencesSeen(const Document& document, const Region& region, const AffineVergence& vergence) {
    VergenceSpan span;
    const auto take = [&](int x, int y) { span.take(vergence(x + 0.5, y + 0.5)); };
    forEachSeenTile(document, region, [&](const SeenTile& seen) {
        const auto& r = seen.pixels;
        for (int y = r.y0; y < r.y1; ++y) {
            if (seen.all && y != r.y0 && y != r.y1 - 1) continue;
            int first = r.x0;
            int last = r.x1 - 1;
            while (first <= last && !seen.at(first, y))
                ++first;
            while (last >= first && !seen.at(last, y))
                --last;
            if (first > last) continue;
            take(first, y);
            take(last, y);
        }
    });
    return span;
}

int wholeTiles(const Region& region, Size picture) {
    if (region.id == kBackgroundId) return TileGrid(picture).columns() * TileGrid(picture).rows();
    int whole = 0;
    for (int row = 0; row < region.mask.rows(); ++row) {
        for (int column = 0; column < region.mask.columns(); ++column)
            whole += region.mask.isUniform(column, row, 255);
    }
    return whole;
}

std::optional<DistanceRange> depthSeen(const Document& document, const Region& region, Metre tolerance) {
    const Box<DepthMap>& depth = document.scene.depth;
    if (!depth || depth->raw.size() != document.scene.size()) return std::nullopt;
    // A plan asks this after every dab. Of a large region every fourth pixel each way, where it is whole, tells the
    // quantiles; of a small one, a single stray pixel that was picked would weigh too much.
    constexpr int kSparse = 4;
    const bool large = wholeTiles(region, document.scene.size()) > 64;
    std::vector<std::uint32_t> histogram(65536);
    forEachSeenTile(document, region, [&](const SeenTile& seen) {
        const int step = large && seen.all ? kSparse : 1;
        const auto weight = static_cast<std::uint32_t>(step * step);
        for (int y = seen.pixels.y0; y < seen.pixels.y1; y += step) {
            const std::uint16_t* raw = depth->raw.row(y);
            for (int x = seen.pixels.x0; x < seen.pixels.x1; x += step) {
                if (seen.at(x, y)) histogram[raw[x]] += weight;
            }
        }
    });
    std::uint64_t measured = 0;
    for (std::size_t v = 1; v < histogram.size(); ++v)
        measured += histogram[v];
    if (measured == 0) return std::nullopt;
    const std::uint64_t strays = measured / 1000;
    const auto quantile = [&](auto begin, auto end) {
        std::uint64_t passed = 0;
        return std::find_if(begin, end, [&](std::uint32_t n) { return (passed += n) > strays; });
    };
    const auto low = quantile(histogram.begin() + 1, histogram.end()) - histogram.begin();
    const auto high = histogram.rend() - quantile(histogram.rbegin(), histogram.rend() - 1) - 1;
    const Metre unit = depth->metresPerUnit;
    const Metre nearest = static_cast<double>(low) * unit;
    // A tolerance as large as the nearest distance itself would put the surface at or behind the lens.
    return DistanceRange{nearest > tolerance ? nearest - tolerance : 0.5 * nearest,
                         static_cast<double>(high) * unit + tolerance,
                         static_cast<double>(histogram[0]) / static_cast<double>(histogram[0] + measured)};
}

}  // namespace

Result<std::optional<AffineVergence>> affineVergence(const Region& region) {
    if (const auto* constant = std::get_if<ConstantDistance>(&region.distance)) {
        return AffineVergence{(1.0 / constant->value).si(), 0.0, 0.0};
    }
    const auto* plane = std::get_if<PlaneDistance>(&region.distance);
    if (plane == nullptr) return std::nullopt;
    const std::optional<AffineVergence> vergence = through(*plane);
    if (!vergence) {
        return fail(Fault::outOfRange, "The three points of the plane of \"" + region.name +
                                           "\" are on one line: drag one of them aside.");
    }
    Document alone;  // the region by itself, nothing above it
    const VergenceSpan span = vergencesSeen(alone, region, *vergence);
    if (span.any() && span.low < 1.0 / kFarthestDistance.si()) {
        return fail(Fault::outOfRange, "The plane of \"" + region.name +
                                           "\" reaches infinity inside the region: bring the distances of its points "
                                           "closer together, or erase what lies beyond its horizon.");
    }
    return *vergence;
}

std::optional<Metre> distanceAt(const Document& document, const Region& region, Point<CameraFrame> at) {
    if (const auto* constant = std::get_if<ConstantDistance>(&region.distance)) return constant->value;
    if (const auto* plane = std::get_if<PlaneDistance>(&region.distance)) {
        const std::optional<AffineVergence> vergence = through(*plane);
        if (!vergence) return std::nullopt;
        return metresAt((*vergence)(at.x, at.y));
    }
    const Box<DepthMap>& depth = document.scene.depth;
    const int x = static_cast<int>(std::floor(at.x));
    const int y = static_cast<int>(std::floor(at.y));
    if (!depth || depth->raw.empty() || x < 0 || y < 0 || x >= depth->raw.width() || y >= depth->raw.height()) {
        return std::nullopt;
    }
    const std::uint16_t raw = depth->raw.at(x, y);
    if (raw == 0) return std::nullopt;
    return static_cast<double>(raw) * depth->metresPerUnit;
}

std::optional<DistanceRange> distanceRange(const Document& document, const Region& region) {
    if (const auto* constant = std::get_if<ConstantDistance>(&region.distance)) {
        return DistanceRange{constant->value - constant->tolerance, constant->value + constant->tolerance, 0.0};
    }
    if (const auto* plane = std::get_if<PlaneDistance>(&region.distance)) {
        const std::optional<AffineVergence> vergence = through(*plane);
        if (!vergence) return std::nullopt;
        const VergenceSpan span = vergencesSeen(document, region, *vergence);
        if (!span.any()) return std::nullopt;
        return DistanceRange{metresAt(span.high), metresAt(span.low), 0.0};
    }
    return depthSeen(document, region, std::get<FromDepthMap>(region.distance).tolerance);
}

}  // namespace ilf
