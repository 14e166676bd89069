// How large a solid is: its box, its triangles.
#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "core/solid/mesh.h"

namespace ilf {

/// A box along the axes, in the scene's metres.
struct Extent {
    std::array<float, 3> least{}, most{};
    bool operator==(const Extent&) const = default;
};

/// Of all vertices, drawn or not; nothing where there are none.
std::optional<Extent> extentOf(const Solid& solid);

std::size_t triangleCount(const Solid& solid);

}  // namespace ilf
