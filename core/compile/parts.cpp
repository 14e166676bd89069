#include "core/compile/parts.h"

#include <algorithm>

namespace ilf {

namespace {

bool sameSurface(const Region& a, const Region& b) {
    return a.id == b.id && a.look == b.look && a.strength == b.strength && a.distance == b.distance && a.fade == b.fade;
}

bool sameLevels(const Plan& a, const Plan& b) {
    if (a.waveform != b.waveform || a.focusPower != b.focusPower || a.levels != b.levels || a.slots != b.slots)
        return false;
    return std::ranges::equal(a.regions, b.regions, [](const RegionPlan& x, const RegionPlan& y) {
        return x.id == y.id && x.look == y.look && x.level == y.level && x.nearest == y.nearest &&
               x.farthest == y.farthest;
    });
}

}  // namespace

bool sameButMasks(const Document& a, const Plan& planA, const Document& b, const Plan& planB) {
    const std::vector<const Region*> before = activeRegions(a), after = activeRegions(b);
    const bool sameDepth = a.scene.depth.same(b.scene.depth);
    return a.scene.size() == b.scene.size() && a.scene.scale == b.scene.scale && sameDepth && a.seam == b.seam &&
           a.wearer == b.wearer && a.rig == b.rig && sameLevels(planA, planB) &&
           std::ranges::equal(before, after, [](const Region* x, const Region* y) { return sameSurface(*x, *y); }) &&
           sameSurface(*a.background, *b.background);
}

}  // namespace ilf
