// Where a region's surface lies: at a pixel, over the picture, and from its nearest to its farthest point seen.
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/document/depth_seen.h"
#include "core/document/document.h"
#include "core/document/seen_pixels.h"

namespace ilf {

namespace {

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

/// Nearer by `by`, but in front of the lens: an uncertainty as large as the distance itself would put it behind.
Metre nearer(Metre distance, Metre by) { return distance > by ? distance - by : 0.5 * distance; }

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
    if (!depth || depth->metres.empty() || x < 0 || y < 0 || x >= depth->metres.width() ||
        y >= depth->metres.height()) {
        return std::nullopt;
    }
    const float metres = depth->metres.at(x, y);
    if (!(metres > 0.0F)) return std::nullopt;
    return Metre::fromSi(static_cast<double>(metres));
}

std::optional<DistanceRange> distanceRange(const Document& document, const Region& region) {
    if (const auto* constant = std::get_if<ConstantDistance>(&region.distance)) {
        const Metre off = constant->tolerance;
        return DistanceRange{constant->value - off, constant->value + off, 0.0, 0.5 * off};
    }
    if (const auto* plane = std::get_if<PlaneDistance>(&region.distance)) {
        const std::optional<AffineVergence> vergence = through(*plane);
        if (!vergence) return std::nullopt;
        const VergenceSpan span = vergencesSeen(document, region, *vergence);
        if (!span.any()) return std::nullopt;
        const Metre off = plane->tolerance;
        return DistanceRange{nearer(metresAt(span.high), off), metresAt(span.low) + off, 0.0, 0.5 * off};
    }
    const std::optional<DepthSeen> seen = depthSeen(document, region);
    if (!seen) return std::nullopt;
    const Metre off = std::get<FromDepthMap>(region.distance).tolerance;
    return DistanceRange{nearer(seen->nearest, off), seen->farthest + off, seen->holes,
                         Metre::fromSi(std::hypot(seen->sigma.si(), 0.5 * off.si()))};
}

}  // namespace ilf
