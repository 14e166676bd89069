#include "core/solid/extent.h"

#include <algorithm>

namespace ilf {

std::optional<Extent> extentOf(const Solid& solid) {
    std::optional<Extent> extent;
    for (const Box<Mesh>& mesh : solid.meshes) {
        for (const auto& position : mesh->positions) {
            if (!extent) extent = Extent{position, position};
            for (std::size_t i = 0; i < 3; ++i) {
                extent->least[i] = std::min(extent->least[i], position[i]);
                extent->most[i] = std::max(extent->most[i], position[i]);
            }
        }
    }
    return extent;
}

std::size_t triangleCount(const Solid& solid) {
    std::size_t count = 0;
    for (const Box<Mesh>& mesh : solid.meshes)
        count += mesh->triangles.size();
    return count;
}

}  // namespace ilf
