// What a compile works out on the way and the next one can share.
#pragma once

#include "core/compile/compile.h"
#include "core/compile/coverage.h"
#include "core/compile/seam.h"

namespace ilf {

struct CompileParts {
    Box<CoverageSampler> sampler;
    Box<Lighting> light;
    std::vector<TileGrid> coverage;  ///< of each active region on the raster, topmost first, as if nothing lay above
    std::vector<TileGrid> visible;   ///< of each sheet of light: what is seen of it, 255 in all at every pixel
    LayerGrids layers;
};

/// True if two documents differ at most in masks, names and other things that reach no light, and their plans light
/// regions alike: then parts of the one serve the other.
bool sameButMasks(const Document& a, const Plan& planA, const Document& b, const Plan& planB);

}  // namespace ilf
