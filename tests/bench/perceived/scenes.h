// What is looked at: documents with their plans and programs, and the small changes an operator makes to them.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/compile/compile.h"
#include "core/perceived/perceived.h"

namespace ilf::bench {

/// All that one view depends on.
struct Shown {
    Document document;
    Plan plan;
    Program program;
    std::shared_ptr<const Compiled> compiled;  ///< what the program came from; none: made by hand
};

struct BenchScene {
    std::string name;
    Shown shown;
    ViewRequest request;  ///< its rung is set by the row
    RegionId painted;     ///< a blurred region whose light and outline a dab changes; empty: none
    RegionId moved;       ///< the region whose distance a geometry change moves
    int rays = 4096;      ///< of the reference, for each pixel
    bool byHand = false;  ///< the program does not come from the compiler, so only its light can be edited
};

/// How long each level is lit: in the one slot where the lens turns round, as the figures have it; or in all slots that
/// the rig's usual error budget allows, through which the lens moves on.
enum class Light { oneSlotEach, usualBudget };

/// Pixels are the scene's width; its height is three quarters of it, its angles stay (so radii grow along).
Result<BenchScene> seamScene();
Result<BenchScene> fourObjectsEye(int width = 1024, Light light = Light::oneSlotEach);
Result<BenchScene> fourObjectsCamera(int width = 1024, Light light = Light::oneSlotEach);
Result<BenchScene> fourSlotsCamera();
Result<BenchScene> litTwice();
Result<BenchScene> slantedDesk();
/// Each region at a distance of its own, 0.35 to 2 m, every second one blurred.
Result<BenchScene> manyRegions(int count);
Result<BenchScene> nothingToBlur();

/// Everything lit in `slots` levels of a camera, each pixel in just one of them, all of it blurred about alike: what a
/// slot more costs at equal lit area.
Result<BenchScene> splitLight(int slots);
/// One blurred surface that fills the picture, with a disc of `radius` pixels, lit alone.
Result<BenchScene> oneRadius(double radius);

/// A copy in which the light of every lit pixel is a little less: no tile of any light image stays the same.
Shown dimmed(const Shown& shown);
/// A copy in which the light of the strongest level is halved on a disc of `diameter` picture pixels about the `step`th
/// place inside the painted region.
Shown dabbedLight(const BenchScene& scene, const Shown& from, double diameter, int step);
/// Erases or adds at the painted region's outline, and compiles what that changes.
Result<Shown> dabbedMask(const BenchScene& scene, const Shown& from, double diameter, int step);
/// The moved region 2 % of its vergence nearer for each step; planned and compiled.
Result<Shown> moved(const BenchScene& scene, int step);

/// Level with the greatest power.
std::size_t strongestLevel(const Plan& plan);

}  // namespace ilf::bench
