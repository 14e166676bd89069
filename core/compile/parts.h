// What a compile works out on the way and the next one can share.
#pragma once

#include <memory>
#include <vector>

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
    /// What the light is mixed of while a region fades: then there is nothing above but the sampler.
    std::vector<std::shared_ptr<const Compiled>> mixedOf;
};

/// True if two documents differ at most in masks, names and other things that reach no light, and their plans light
/// regions alike: then parts of the one serve the other.
bool sameButMasks(const Document& a, const Plan& planA, const Document& b, const Plan& planB);

/// Compiles a document in which nothing fades; compile.h has the rest.
Result<Compiled> compiledOne(const Document& document, const Plan& plan, const Compiled* previous);

int uniformTiles(const std::vector<LightImage>& images);

}  // namespace ilf
