#include "core/perceived/reference_hits.h"

#include <algorithm>
#include <cmath>

namespace ilf::reference {
namespace {

constexpr double kLeastVergence = 1e-3;  // 1 / kFarthestDistance
/// A vergence is found when it stands still to this, dioptres: far less than a millionth of a pixel.
constexpr double kFound = 1e-10;
constexpr int kIterations = 40;

/// The four pixels around a view position and their bilinear weights.
struct Corners {
    static constexpr int kFar = 1 << 20;
    int left, top;
    double fx, fy;

    /// Whole numbers by cutting off, which is far quicker than std::floor without SSE 4.1; no ray strays that far.
    explicit Corners(Pair at)
        : left(static_cast<int>(at.x + (kFar - 0.5)) - kFar), top(static_cast<int>(at.y + (kFar - 0.5)) - kFar),
          fx(at.x - 0.5 - left), fy(at.y - 0.5 - top) {}
    int x(int corner) const { return left + (corner & 1); }
    int y(int corner) const { return top + (corner >> 1); }
    double weight(int corner) const {
        return ((corner & 1) != 0 ? fx : 1.0 - fx) * ((corner >> 1) != 0 ? fy : 1.0 - fy);
    }
};

/// Vergence of a depth map between pixel centres: bilinear over the corners that belong together with the one that
/// weighs most; 0: no surface.
double vergenceAt(const Frame& frame, const Surface& map, Pair at) {
    const Corners corners(at);
    std::array<double, 4> values{};
    double anchor = 0.0, most = 0.0;
    for (int c = 0; c < 4; ++c) {
        const int x = corners.x(c), y = corners.y(c);
        if (!frame.holds(x, y)) continue;
        const double value = values[static_cast<std::size_t>(c)] = map.map[frame.index(x, y)];
        if (value > 0.0 && corners.weight(c) > most) {
            most = corners.weight(c);
            anchor = value;
        }
    }
    if (most <= 0.0) return 0.0;
    double sum = 0.0, weights = 0.0;
    for (int c = 0; c < 4; ++c) {
        const double value = values[static_cast<std::size_t>(c)];
        if (value <= 0.0 || std::abs(value - anchor) > map.tear) continue;
        sum += corners.weight(c) * value;
        weights += corners.weight(c);
    }
    return sum / weights;
}

/// A point of a path beside the map's surface there.
struct Beside {
    double vergence = 0.0;  ///< of the path
    double surface = 0.0;   ///< of the map; 0: none
    bool before() const { return surface == 0.0 || surface < vergence; }
};

}  // namespace

Met met(const Frame& frame, const Surface& surface, const Light& light, Pair at, double vergence) {
    Met met;
    const Corners corners(at);
    const bool tears = surface.kind == Surface::Kind::map;
    double torn = 0.0;
    for (int c = 0; c < 4; ++c) {
        const int x = corners.x(c), y = corners.y(c);
        if (!frame.holds(x, y)) continue;
        const std::size_t i = frame.index(x, y);
        const double weight = corners.weight(c), covered = weight * surface.alpha[i];
        if (tears && surface.map[i] > 0.0 && std::abs(surface.map[i] - vergence) > surface.tear) {
            torn += weight;
            continue;
        }
        if (covered <= 0.0) continue;
        met.coverage += covered;
        const double* from = light.radiance.data() + 3 * i;
        for (std::size_t k = 0; k < 3; ++k)
            met.light[k] += covered * from[k];
    }
    if (torn <= 0.0 || torn >= 1.0) return met;
    // The edge of a torn surface runs halfway between its pixels: up to there it covers as it does at them.
    met.coverage /= 1.0 - torn;
    for (double& one : met.light)
        one /= 1.0 - torn;
    return met;
}

Pair Path::at(double vergence) const {
    const double distance = 1.0 / vergence;
    return traced(Shown(optics, distance), backTo(distance, power, optics.lensToPupil),
                  chiefRay(optics, view, distance), aside, surplus);
}

std::optional<Meeting> meetsPlane(const Surface& plane, const Path& path) {
    const auto next = [&](double vergence, Pair& at) {
        at = path.at(vergence);
        return std::max(plane.vergence(at.x, at.y), kLeastVergence);
    };
    // x = f(x) where f is nearly constant: the secant of f(x) - x takes three or four steps.
    Pair at;
    double before = std::max(plane.vergence(path.view.x, path.view.y), kLeastVergence);
    double offBefore = next(before, at) - before;
    double now = before + offBefore;
    for (int i = 0; i < kIterations; ++i) {
        if (std::abs(offBefore) < kFound) return Meeting{before, at};
        const double off = next(now, at) - now;
        if (std::abs(off) < kFound) return Meeting{now, at};
        if (off == offBefore) return std::nullopt;
        const double step = off * (now - before) / (off - offBefore);
        before = now;
        offBefore = off;
        now = std::max(now - step, kLeastVergence);
    }
    return std::nullopt;
}

void meetsMap(const Frame& frame, const Surface& map, const Path& path, std::vector<Meeting>& into) {
    const Pair first = path.at(map.nearest), last = path.at(map.farthest);
    if (std::max(first.x, last.x) < map.x0 || std::max(first.y, last.y) < map.y0 ||
        std::min(first.x, last.x) > map.x1 || std::min(first.y, last.y) > map.y1) {
        return;
    }
    const auto beside = [&](double vergence) { return Beside{vergence, vergenceAt(frame, map, path.at(vergence))}; };
    const auto meet = [&](double vergence) { into.push_back({vergence, path.at(vergence)}); };
    // Between two points of one sheet, one before it and one on or behind it.
    const auto refined = [&](Beside before, Beside behind) {
        for (int i = 0; i < kIterations && before.vergence - behind.vergence > kFound; ++i) {
            const double gapBefore = before.vergence - before.surface, gapBehind = behind.surface - behind.vergence;
            // Every third step halves, so that no end stays where it is.
            const double part = i % 3 == 2 ? 0.5 : gapBefore / (gapBefore + gapBehind);
            const Beside middle = beside(before.vergence + part * (behind.vergence - before.vergence));
            if (middle.surface == 0.0) break;
            if (std::abs(middle.surface - middle.vergence) < kFound) return middle.vergence;
            (middle.before() ? before : behind) = middle;
        }
        return behind.vergence;
    };

    const int steps = 1 + static_cast<int>(std::ceil(2.0 * std::hypot(last.x - first.x, last.y - first.y)));
    Beside before = beside(map.nearest);
    if (!before.before() || std::abs(before.surface - before.vergence) < kFound) meet(before.vergence);
    for (int i = 1; i <= steps && map.nearest > map.farthest; ++i) {
        const double part = static_cast<double>(i) / steps;
        const Beside now = beside(i == steps ? map.farthest : map.nearest + part * (map.farthest - map.nearest));
        const bool oneSheet =
            before.surface > 0.0 && now.surface > 0.0 && std::abs(now.surface - before.surface) <= map.tear;
        const double reached = now.vergence - kFound;  // what lies at the farthest vergence itself is met
        if (before.before() && oneSheet) {
            if (now.surface >= reached) meet(refined(before, now));
        } else if (before.before()) {
            // Over a tear or an edge each sheet goes on, level, as far as it covers anything.
            if (before.surface >= reached && before.surface > 0.0) {
                const Beside there = beside(before.surface);
                if (there.surface > 0.0 && std::abs(there.surface - before.surface) <= map.tear) meet(before.surface);
            }
            if (now.surface >= reached && now.surface < before.vergence) meet(now.surface);
        }
        before = now;
    }
}

}  // namespace ilf::reference
