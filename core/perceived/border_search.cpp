#include "core/perceived/border_search.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace ilf::view {
namespace {

/// The normal is read from the mask within this many pixels of the border.
constexpr int kNormalReach = 4;

/// What is blurred is displaced more than what is neutral.
bool isBorder(const Lit& here, const Lit& there) {
    return here.displaced && here.level != there.level && (here.blurred || !there.blurred);
}

std::optional<Crossing> crossingAt(const LitRegions& regions, int x, int y) {
    if (!regions.inside(x, y)) return std::nullopt;
    const std::size_t here = regions.owner(x, y);
    if (!regions.all()[here].displaced) return std::nullopt;
    for (const auto& [dx, dy] : {std::pair(1, 0), std::pair(-1, 0), std::pair(0, 1), std::pair(0, -1)}) {
        if (!regions.inside(x + dx, y + dy)) continue;
        const std::size_t there = regions.owner(x + dx, y + dy);
        if (isBorder(regions.all()[here], regions.all()[there])) return Crossing{here, there, x, y, dx, dy};
    }
    return std::nullopt;
}

}  // namespace

LitRegions::LitRegions(const Compiled& compiled) : size_(compiled.document.scene.size()) {
    for (const Region* region : activeRegions(compiled.document))
        add(compiled.plan, region);
    if (compiled.document.background) add(compiled.plan, &*compiled.document.background);
}

std::size_t LitRegions::owner(int x, int y) const {
    for (std::size_t i = 0; i < all_.size(); ++i) {
        if (all_[i].region->mask.empty() || all_[i].region->mask.at(x, y) >= 128) return i;
    }
    return all_.size() - 1;
}

void LitRegions::shares(int x, int y, std::vector<float>& shares) const {
    float left = 1.0F;
    for (std::size_t i = 0; i < all_.size(); ++i) {
        const Mask& mask = all_[i].region->mask;
        shares[i] = mask.empty() ? left : left * (static_cast<float>(mask.at(x, y)) / 255.0F);
        left -= shares[i];
    }
}

void LitRegions::add(const Plan& plan, const Region* region) {
    const auto planned = std::ranges::find(plan.regions, region->id, &RegionPlan::id);
    Lit lit{region, planned == plan.regions.end() ? std::nullopt : planned->level, false, std::nullopt};
    for (std::size_t l = 0; l < plan.levels.size(); ++l) {
        const Level& level = plan.levels[l];
        if (level.kind != LevelKind::blur || (lit.level && *lit.level != static_cast<int>(l))) continue;
        lit.blurred = lit.level.has_value();
        lit.displaced = std::max(lit.displaced.value_or(level.power), level.power);
    }
    all_.push_back(lit);
}

std::vector<WholeBorder> wholeBorders(const LitRegions& regions) {
    const auto width = static_cast<std::size_t>(regions.size().width);
    std::map<std::pair<std::size_t, std::size_t>, WholeBorder> found;
    const auto add = [&](std::size_t here, std::size_t there, int x, int y, int dx, int dy) {
        if (here == there) return;
        const Lit &a = regions.all()[here], &b = regions.all()[there];
        const bool outwards = isBorder(a, b), inwards = isBorder(b, a);
        if (!outwards && !inwards) return;
        const bool swaps = !outwards || (inwards && there < here);
        const Crossing crossing =
            swaps ? Crossing{there, here, x + dx, y + dy, -dx, -dy} : Crossing{here, there, x, y, dx, dy};
        WholeBorder& border = found[{crossing.blurred, crossing.other}];
        border.blurred = crossing.blurred;
        border.other = crossing.other;
        border.crossings.push_back(crossing);
    };
    std::vector<std::size_t> above(width), row(width);
    for (int y = 0; y < regions.size().height; ++y) {
        for (std::size_t x = 0; x < width; ++x) {
            const int i = static_cast<int>(x);
            row[x] = regions.owner(i, y);
            if (x > 0) add(row[x - 1], row[x], i - 1, y, 1, 0);
            if (y > 0) add(above[x], row[x], i, y - 1, 0, 1);
        }
        std::swap(above, row);
    }
    std::vector<WholeBorder> borders;
    for (auto& [pair, border] : found)
        borders.push_back(std::move(border));
    return borders;
}

std::optional<Crossing> nearestCrossing(const LitRegions& regions, Point<CameraFrame> cursor, double within) {
    // Rings of growing size around the cursor, until nothing nearer can come.
    std::optional<Crossing> nearest;
    double best = within;
    const int cx = static_cast<int>(std::floor(cursor.x)), cy = static_cast<int>(std::floor(cursor.y));
    const auto look = [&](int x, int y) {
        const double distance = std::hypot(x + 0.5 - cursor.x, y + 0.5 - cursor.y);
        if (distance > best) return;
        if (const auto crossing = crossingAt(regions, x, y)) {
            nearest = crossing;
            best = distance;
        }
    };
    look(cx, cy);
    for (int ring = 1; ring - 1 <= best; ++ring) {
        for (int along = -ring; along <= ring; ++along) {
            look(cx + along, cy - ring);
            look(cx + along, cy + ring);
            look(cx - ring, cy + along);
            look(cx + ring, cy + along);
        }
    }
    return nearest;
}

std::pair<double, double> normalAt(const LitRegions& regions, const Crossing& crossing) {
    // The slope of the least-squares plane through the share; at the picture's edge half of the disc is missing, so the
    // means are taken off.
    double n = 0.0, x1 = 0.0, y1 = 0.0, x2 = 0.0, y2 = 0.0, s1 = 0.0, sx = 0.0, sy = 0.0;
    std::vector<float> shares(regions.all().size());
    for (int dy = -kNormalReach; dy <= kNormalReach; ++dy) {
        for (int dx = -kNormalReach; dx <= kNormalReach; ++dx) {
            const int x = crossing.x + dx, y = crossing.y + dy;
            if (dx * dx + dy * dy > kNormalReach * kNormalReach || !regions.inside(x, y)) continue;
            regions.shares(x, y, shares);
            const auto share = static_cast<double>(shares[crossing.blurred]);
            n += 1.0;
            x1 += dx;
            y1 += dy;
            x2 += dx * dx;
            y2 += dy * dy;
            s1 += share;
            sx += share * dx;
            sy += share * dy;
        }
    }
    const double nx = -(n * sx - x1 * s1) / std::max(1.0, n * x2 - x1 * x1);
    const double ny = -(n * sy - y1 * s1) / std::max(1.0, n * y2 - y1 * y1);
    const double length = std::hypot(nx, ny);
    if (length < 1e-6) return {crossing.dx, crossing.dy};
    return {nx / length, ny / length};
}

}  // namespace ilf::view
