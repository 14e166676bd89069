#include <algorithm>
#include <array>
#include <cmath>
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

Mask faded(const Mask& mask, double fade, const Mask* before) {
    std::array<std::uint8_t, 256> table{};
    for (std::size_t v = 0; v < table.size(); ++v)
        table[v] = static_cast<std::uint8_t>(std::lround(static_cast<double>(v) * (1.0 - fade)));
    Mask result = mask;
    if (before != nullptr && before->size() != mask.size()) before = nullptr;
    for (int row = 0; row < mask.rows(); ++row) {
        for (int column = 0; column < mask.columns(); ++column) {
            if (mask.isUniform(column, row, 0)) continue;
            Tile tile = *mask.tile(column, row);
            for (std::uint8_t& v : tile.v)
                v = table[v];
            Box<Tile> made = boxed(tile);
            if (before != nullptr && before->tile(column, row) == made) made = before->tile(column, row);
            result.setTile(column, row, std::move(made));
        }
    }
    return result;
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
        const Look lostLook = lookOf(box->follow->whenLost);
        const double fade = std::clamp(motion->fade, 0.0, 1.0);
        const RegionId copyId = box->id + kFadedSuffix;
        const Region* lastCopy = last(copyId);
        const bool changesLook = lostLook != region.look || (lostLook == Look::blur && region.strength);
        const bool between = changesLook && fade > 0.0 && fade < 1.0;
        // While a region fades, its whole mask is the copy's.
        const Region* lastWhole = lastCopy != nullptr ? lastCopy : lastRegion;
        Mask mask = moved(region.mask, motion->motion, lastWhole != nullptr ? &lastWhole->mask : nullptr);
        if (!mask.empty() && !(mask == region.mask)) carry(region, motion->motion);
        region.mask = std::move(mask);
        Region lost = region;
        lost.look = lostLook;
        lost.strength.reset();
        if (changesLook && fade >= 1.0) {
            result.regions.push_back(boxedAs(std::move(lost), lastRegion, boxes));
            continue;
        }
        if (between) region.mask = faded(region.mask, fade, lastRegion != nullptr ? &lastRegion->mask : nullptr);
        result.regions.push_back(boxedAs(std::move(region), lastRegion, boxes));
        if (between) {
            lost.id = copyId;
            result.regions.push_back(boxedAs(std::move(lost), lastCopy, boxes));
        }
    }
    return result;
}

}  // namespace ilf
