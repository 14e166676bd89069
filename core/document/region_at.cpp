#include "core/document/region_at.h"

#include <cmath>

namespace ilf {

const Region* regionAt(const Document& document, Point<CameraFrame> at) {
    const int x = static_cast<int>(std::floor(at.x)), y = static_cast<int>(std::floor(at.y));
    for (const Region* region : activeRegions(document)) {
        if (region->mask.at(x, y) >= 128) return region;
    }
    return nullptr;
}

}  // namespace ilf
