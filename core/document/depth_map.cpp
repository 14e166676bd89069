// Depth maps to and from the whole numbers of files.
#include <cmath>
#include <utility>
#include <vector>

#include "core/document/distance.h"

namespace ilf {

DepthMap depthOf(const Image<std::uint16_t>& raw, Metre step) {
    std::vector<float> metres;
    metres.reserve(raw.pixels().size());
    for (const std::uint16_t value : raw.pixels())
        metres.push_back(static_cast<float>(value * step.si()));
    return {Image<float>(raw.size(), 1, std::move(metres)), {}, step};
}

Image<std::uint16_t> wholeSteps(const DepthMap& depth) {
    const double step = depth.step.si();
    if (!(step > 0.0)) return {};
    std::vector<std::uint16_t> raw;
    raw.reserve(depth.metres.pixels().size());
    for (const float metres : depth.metres.pixels()) {
        const double steps = std::round(static_cast<double>(metres) / step);
        if (!(steps >= 0.0 && steps <= 65535.0) || static_cast<float>(steps * step) != metres) return {};
        raw.push_back(static_cast<std::uint16_t>(steps));
    }
    return {depth.metres.size(), 1, std::move(raw)};
}

}  // namespace ilf
