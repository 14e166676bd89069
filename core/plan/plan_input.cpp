#include <algorithm>
#include <utility>

#include "core/plan/fade.h"
#include "core/plan/plan.h"

namespace ilf {
namespace {

/// Half of full coverage and above counts as the region's own pixel, as in `distanceRange`.
constexpr std::uint8_t kCovers = 128;

bool shows(const std::vector<const Region*>& above, const Mask* own, int x, int y) {
    if (own && own->at(x, y) < kCovers) return false;
    return std::ranges::none_of(above, [&](const Region* region) { return region->mask.at(x, y) >= kCovers; });
}

/// True if some pixel is left to it by the regions above. Uniform tiles decide without looking at pixels.
bool seen(Size size, const std::vector<const Region*>& above, const Mask* own) {
    for (int y0 = 0; y0 < size.height; y0 += kTile) {
        for (int x0 = 0; x0 < size.width; x0 += kTile) {
            const int column = x0 / kTile, row = y0 / kTile;
            if (own && own->isUniform(column, row, 0)) continue;
            if (std::ranges::any_of(above, [&](const Region* r) { return r->mask.isUniform(column, row, 255); })) {
                continue;
            }
            for (int y = y0; y < std::min(y0 + kTile, size.height); ++y) {
                for (int x = x0; x < std::min(x0 + kTile, size.width); ++x) {
                    if (shows(above, own, x, y)) return true;
                }
            }
        }
    }
    return false;
}

void add(PlanInput& input, const Document& document, const Region& region) {
    const auto range = distanceRange(document, region);
    if (!range) return;
    const auto lit = [&](const RegionId& id, Look look, std::optional<Dioptre> strength) {
        input.objects.push_back({id, region.name, look, strength, range->nearest, range->farthest, range->sigma});
    };
    if (!faded(region)) lit(region.id, region.look, region.strength);
    if (faded(region) || fading(region)) lit(fadedId(region.id), region.fade->look, std::nullopt);
}

}  // namespace

RegionId fadedId(const RegionId& id) { return id + "~faded"; }

PlanInput planInput(const Document& document, std::shared_ptr<const LensCalibration> lens) {
    PlanInput input;
    input.lens = std::move(lens);
    input.ageYears = document.wearer.ageYears;
    input.eye = eyeOptics(document.wearer);
    input.camera = document.wearer.camera.has_value();
    input.rig = document.rig;
    input.alpha = document.alpha;

    std::vector<const Region*> above;
    for (const Region* region : activeRegions(document)) {
        if (region->mask.empty()) continue;
        if (seen(document.scene.size(), above, &region->mask)) add(input, document, *region);
        above.push_back(region);
    }
    if (document.background && seen(document.scene.size(), above, nullptr)) {
        add(input, document, *document.background);
    }
    return input;
}

}  // namespace ilf
