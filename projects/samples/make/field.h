// The nearest of many solids, found fast: a grid remembers which of them can be nearest in each of its cells.
#pragma once

#include <cstdint>

#include "scene.h"

namespace ilf::samples {

class Field {
public:
    explicit Field(const Scene& scene);

    struct Nearest {
        float distance = 1e9f;
        int object = -1;
    };
    Nearest nearest(V3 p) const;
    float distance(V3 p) const { return nearest(p).distance; }
    bool inside(V3 p) const;
    /// Unit normal by central differences over `reach` metres.
    V3 normal(V3 p, float reach) const;

private:
    std::size_t cellOf(V3 p) const;

    const Scene& scene_;
    V3 cell_;
    std::vector<std::vector<std::uint16_t>> candidates_;
};

}  // namespace ilf::samples
