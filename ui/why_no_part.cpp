#include "ui/why_no_part.h"

#include <algorithm>

#include "core/document/seen_pixels.h"

namespace ilf::ui {

namespace {

/// Half of a pixel and more is the region's own, as in the plan.
bool coversAnywhere(const Mask& mask) {
    for (int row = 0; row < mask.rows(); ++row) {
        for (int column = 0; column < mask.columns(); ++column) {
            if (mask.isUniform(column, row, 0)) continue;
            if (std::ranges::any_of(mask.tile(column, row)->v, [](std::uint8_t v) { return v >= 128; })) return true;
        }
    }
    return false;
}

}  // namespace

std::string whyNoPart(const Document& document, const Region& region) {
    if (region.id == kBackgroundId) return "The regions hide all of it.";
    if (!region.visible) return "It is hidden, and so takes no part.";
    const auto active = activeRegions(document);
    if (std::ranges::none_of(active, [&](const Region* other) { return other->id == region.id; }))
        return "Others are shown alone (solo), so it takes no part.";
    if (region.mask.blank()) return "Covers nothing yet: paint it.";
    if (!coversAnywhere(region.mask))
        return "It covers less than half of every pixel, too little to count: paint again at a higher opacity.";
    bool seen = false;
    forEachSeenTile(document, region, [&](const SeenTile&) { seen = true; });
    if (!seen) return "Regions above it hide all of it.";
    return "The depth map knows no distance where it is seen: paint where there is depth, or type the distance.";
}

}  // namespace ilf::ui
