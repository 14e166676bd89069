#include "core/perceived/border_search.h"

#include <algorithm>
#include <cmath>

namespace ilf::view {
namespace {

/// The normal is read from the mask within this many pixels of the border.
constexpr int kNormalReach = 4;

std::optional<Crossing> crossingAt(const LitRegions& regions, int x, int y) {
    if (!regions.inside(x, y)) return std::nullopt;
    const std::size_t here = regions.owner(x, y);
    if (!regions.all()[here].blurred) return std::nullopt;
    for (const auto& [dx, dy] : {std::pair(1, 0), std::pair(-1, 0), std::pair(0, 1), std::pair(0, -1)}) {
        if (!regions.inside(x + dx, y + dy)) continue;
        const std::size_t there = regions.owner(x + dx, y + dy);
        if (regions.all()[there].level != regions.all()[here].level) return Crossing{here, there, x, y, dx, dy};
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
    const auto level = planned == plan.regions.end() ? std::nullopt : planned->level;
    all_.push_back({region, level, level && plan.levels[static_cast<std::size_t>(*level)].kind == LevelKind::blur});
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
    double nx = 0.0, ny = 0.0;
    std::vector<float> shares(regions.all().size());
    for (int dy = -kNormalReach; dy <= kNormalReach; ++dy) {
        for (int dx = -kNormalReach; dx <= kNormalReach; ++dx) {
            const int x = crossing.x + dx, y = crossing.y + dy;
            if (dx * dx + dy * dy > kNormalReach * kNormalReach || !regions.inside(x, y)) continue;
            regions.shares(x, y, shares);
            nx -= static_cast<double>(shares[crossing.blurred]) * dx;
            ny -= static_cast<double>(shares[crossing.blurred]) * dy;
        }
    }
    const double length = std::hypot(nx, ny);
    if (length < 1e-6) return {crossing.dx, crossing.dy};
    return {nx / length, ny / length};
}

}  // namespace ilf::view
