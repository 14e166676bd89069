// The even white scene around one place of a border, and what an eye that looks there receives of a program's light.
#pragma once

#include <vector>

#include "core/perceived/border_search.h"
#include "core/perceived/composite.h"
#include "core/perceived/seam_robustness.h"

namespace ilf::view {

/// Pixels of a patch: `pitch` picture pixels each, from the picture's (x0, y0) on. A patch may reach beyond the
/// picture; surfaces go on there as at its edge, and light falls as the projector gives it.
struct PatchWindow {
    double x0 = 0.0, y0 = 0.0;
    double pitch = 1.0;
    Size size;

    /// All within `halo` picture pixels of the box, in pixels of `pitch`.
    static PatchWindow around(double left, double top, double right, double bottom, double halo, double pitch);
    Point<ViewFrame> toPatch(Point<CameraFrame> p) const { return {(p.x - x0) / pitch, (p.y - y0) / pitch}; }
    Point<CameraFrame> toPicture(double x, double y) const { return {x0 + x * pitch, y0 + y * pitch}; }
};

/// Surfaces at the distances they have at `at`; nothing where a region has none there but kFarthestDistance.
std::vector<Surface> patchSurfaces(const Document& document, const LitRegions& regions, Point<CameraFrame> at,
                                   const PatchWindow& window);

/// Hard masks: each pixel is lit in its owner's level; neutral ones evenly in all lit slots.
std::vector<Light> hardLights(const LitRegions& regions, const Plan& plan, const PatchWindow& window);

/// The program's own images, through the registration. Beyond the raster its outermost pixels go on.
std::vector<Light> programLights(const Compiled& compiled, const PatchWindow& window);

/// Who looks at a patch: from where, and at which distance.
struct Looking {
    Eye eye = Eye::left;
    Metre attended;        ///< held sharp through the focus power; a camera keeps its own focus
    Metre centreDistance;  ///< the optical centre is taken on a surface at this distance
    Misplaced off;         ///< how eye and light differ from what the program was made for
};

/// How that eye sees a surface planned to be at `planned` through `lens`.
struct Seen {
    Metre radius;  ///< signed, of the disc on the lit surface, before magnification
    double magnification = 1.0;
};
Seen seenThrough(const Plan& plan, const Looking& looking, Metre planned, Dioptre lens);

/// The raster pixels that a patch can see; at least two on a side, and at least one of them on the raster.
PixelRect<ProjectorFrame> rasterUnder(const PatchWindow& window, const PixelMap& map, Size raster);

/// What that eye receives of a white scene; 1 is the light of a region away from borders. One channel.
Block seenPatch(const Compiled& compiled, const PatchWindow& window, const std::vector<Surface>& surfaces,
                const std::vector<Light>& lights, const Looking& looking);

/// The displaced light at a border; lengths in picture pixels.
struct Displacement {
    Metre distance;
    double pixelsPerMetre = 0.0;
    double radius = 0.0;            ///< of its blur disc
    double stretch = 0.0;           ///< s - 1
    std::array<double, 2> along{};  ///< shift along the normal, left and right eye, positive outwards
    double shift = 0.0;             ///< length of the shift for the eye where it is larger
    /// Along the normal, of the eye where it is larger.
    double seam() const { return std::abs(along[0]) > std::abs(along[1]) ? along[0] : along[1]; }
    /// Far enough to both sides of the border that all blending lies inside.
    double reach(const Seam& seam) const;
};
Displacement displacementAt(const Compiled& compiled, Point<CameraFrame> at, double nx, double ny, Metre distance,
                            Dioptre power);

/// Bilinear between pixel centres.
float sampled(const Block& image, double x, double y);

}  // namespace ilf::view
