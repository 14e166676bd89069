// What the engine remembers between views: surfaces, light on them, who hides whom, and the view itself.
#pragma once

#include <optional>

#include "core/perceived/engine_raster.h"
#include "core/perceived/engine_shown.h"
#include "core/perceived/engine_spare.h"
#include "core/perceived/setting.h"

namespace ilf::view {

/// Looks are averaged over so many pixels, and their averages kept in this order.
inline constexpr std::array<int, 2> kCoarse{2, 4};
constexpr std::size_t averagedAt(int coarse) { return coarse == 2 ? 0 : 1; }

/// A surface of constant distance.
struct EngineSurface {
    RegionId region;
    Metre distance;
    bool sloped = false;
    TilePlane alpha;
    std::array<PaddedPlane, 2> averaged;  ///< alpha, by averagedAt, if anything asks for it
    std::vector<ViewRect> changed;        ///< of alpha, since the view before
};

/// A nearer surface as it lies before points of a farther one, for rays through one pupil point to either.
struct Before {
    int nearer = 0;
    Shown shown;
};

/// A surface in one light.
struct EngineLook {
    Shown shown;
    bool takesPart = true;                   ///< false: its light is divided among other powers
    std::vector<Before> visibleBehind;       ///< nearer ones blurred alike: settled on the surface
    std::vector<int> passedBy;               ///< nearer ones blurred otherwise: settled in the view
    bool hides = false;                      ///< some farther one asks for `passing`
    TilePlane visible;                       ///< of each point, the share of rays that no alike one stops; empty: all
    TilePlane passing;                       ///< of each view pixel, the share of rays that this surface lets pass
    std::vector<std::uint8_t> averagedDark;  ///< tiles of `averaged` that hold nothing
    std::array<PaddedPlane, 3> averaged;     ///< light * albedo * alpha * visible, where the look is coarse
    std::vector<ViewRect> changedVisible, changedPassing;
};

/// Averages that a look of a former geometry leaves to the next one: fresh memory costs more than to fill it.
struct SpareAverages {
    std::array<PaddedPlane, 3> averaged;
    std::vector<std::uint8_t> dark;
};

struct EngineLight {
    PowerLight light;
    std::vector<EngineLook> looks;  ///< by surface
};

/// Everything a frame is made of.
struct EngineScene {
    TileCount tiles;
    Size size;
    RungRules rules;
    std::array<PaddedPlane, 3> albedo;
    std::array<std::array<PaddedPlane, 3>, 2> averagedAlbedo;  ///< by averagedAt, if anything asks for it
    std::vector<EngineSurface> surfaces;                       ///< nearest first
    std::vector<TilePlane> lightOfLevel;
    std::vector<std::vector<ViewRect>> changedLight;  ///< by level
    std::vector<EngineLight> lights;
    std::array<std::vector<SpareAverages>, 2> spareAverages;  ///< by averagedAt
    std::vector<TilePlane> spareShares;
    std::vector<PupilCell> cells;  ///< empty: the whole pupil at once
    bool lensField = false;
    double lensRadius_px = 0.0, pupilRadius_px = 0.0;  ///< across the lens, as seen from the pupil, in view pixels

    /// Light, alpha and visibility of a surface in a light; those that are 1 everywhere are left out.
    std::vector<const TilePlane*> planesOf(const EngineLight& light, std::size_t surface) const;
};

/// What a surface covers of `part` (of shown.samples), all of it that `shown` reaches. May lie in `work`.
Source coverageOf(Workspace& work, const EngineSurface& surface, const Shown& shown, ViewRect part);

/// Works out one tile. Adds to `counters` what it skipped.
Box<ViewTile> tileSeen(const EngineScene& scene, int tile, SpareTiles& spare, ViewCounters& counters);

/// Works out `visible`, `averaged` and `passing` where what they are made of changed; everywhere if `all`.
void updateVisibility(EngineScene& scene, bool all, int threads);
void updateAveraged(EngineScene& scene, bool all, int threads);

}  // namespace ilf::view
