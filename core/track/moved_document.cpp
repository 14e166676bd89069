#include <algorithm>
#include <variant>

#include "core/track/moved_mask.h"

namespace ilf {

namespace {

Look lookOf(Follow::WhenLost whenLost) {
    switch (whenLost) {
    case Follow::WhenLost::blur:
        return Look::blur;
    case Follow::WhenLost::neutral:
        return Look::neutral;
    case Follow::WhenLost::focus:
        return Look::focus;
    }
    return Look::neutral;
}

void carry(Region& region, const Motion& motion) {
    if (region.outline) {
        for (auto& vertex : region.outline->vertices)
            vertex = motion(vertex);
    }
    if (auto* plane = std::get_if<PlaneDistance>(&region.distance)) {
        for (DistanceAnchor& anchor : plane->anchors)
            anchor.at = motion(anchor.at);
    }
}

/// The same box when nothing differs: what compares boxes then need not look inside.
Box<Region> boxedAs(Region region, const Region* before, const std::vector<Box<Region>>& boxes) {
    if (before != nullptr && *before == region) {
        for (const auto& box : boxes) {
            if (&*box == before) return box;
        }
    }
    return Box(std::move(region));
}

}  // namespace

Document moved(const Document& document, std::span<const RegionMotion> motions, const Document* before) {
    Document result = document;
    result.regions.clear();
    static const std::vector<Box<Region>> none;
    const auto& boxes = before != nullptr ? before->regions : none;
    const auto last = [&](const RegionId& id) { return before != nullptr ? findRegion(*before, id) : nullptr; };
    for (const Box<Region>& box : document.regions) {
        const auto motion = std::ranges::find(motions, box->id, &RegionMotion::region);
        if (motion == motions.end() || !box->follow) {
            result.regions.push_back(box);
            continue;
        }
        Region region = *box;
        const Region* lastRegion = last(box->id);
        Mask mask = moved(region.mask, motion->motion, lastRegion != nullptr ? &lastRegion->mask : nullptr);
        if (!mask.empty() && !(mask == region.mask)) carry(region, motion->motion);
        region.mask = std::move(mask);
        const Look lostLook = lookOf(box->follow->whenLost);
        const bool changes = lostLook != region.look || (lostLook == Look::blur && region.strength);
        if (changes && motion->fade >= 1.0) {
            region.look = lostLook;
            region.strength.reset();
        } else if (changes && motion->fade > 0.0) {
            region.fade = LookFade{lostLook, motion->fade};
        }
        result.regions.push_back(boxedAs(std::move(region), lastRegion, boxes));
    }
    return result;
}

}  // namespace ilf
