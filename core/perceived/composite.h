// Adds what one light shows of all surfaces to a view: blurred, magnified, hidden by what is nearer.
#pragma once

#include <vector>

#include "core/perceived/attention.h"
#include "core/perceived/disc_blur.h"
#include "core/perceived/surfaces.h"

namespace ilf::view {

/// `into`, `albedo`, `light` and the surfaces' coverage have one size; `into` has the albedo's channels (1 or 3).
/// `looks` holds each surface's appearance at the light's power.
///
/// A nearer surface hides a farther one by the product of its blurred coverage, except between surfaces blurred alike
/// (radii closer than the smaller of them): rays through one pupil point then meet both at nearly the same place, so
/// what the nearer one hides is settled on the surface, before blurring (perceived-view reference, "best frame").
void addLight(Block& into, const std::vector<Surface>& surfaces, const std::vector<Appearance>& looks,
              const Image<float>& albedo, const Light& light);

}  // namespace ilf::view
