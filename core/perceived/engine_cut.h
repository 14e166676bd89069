// The scene cut into surfaces of constant distance, worked out again only in the tiles whose masks changed.
#pragma once

#include <map>
#include <optional>

#include "core/perceived/engine_planes.h"

namespace ilf::view {

/// One surface: where it lies and whose it is (the first region's at that distance).
struct CutSurface {
    RegionId region;
    Metre distance;
    bool operator==(const CutSurface&) const = default;
};

/// How a document's regions become surfaces at full size: constant ones by their vergence, sloped ones cut into bands
/// on one grid, so that regions on one table lie on the same surfaces.
class SceneCut {
public:
    /// `step` is the vergence between two bands.
    SceneCut(const Document& document, const Plan& plan, double step);
    const std::vector<CutSurface>& surfaces() const { return surfaces_; }

    /// alphas[k] (kTilePixels, row by row) for each surface of one tile of the view: what it covers of what nearer ones
    /// leave. `touched[k]` tells which are not 0 everywhere.
    void alphas(int x0, int y0, std::vector<std::array<float, kTilePixels>>& alphas, std::vector<bool>& touched) const;

    /// The same cut, over other masks.
    bool sameBut(const SceneCut& other) const;

private:
    /// A region that takes part, topmost first.
    struct Part {
        Box<Region> region;
        int constant = -1;  ///< its surface; -1: sloped
        AffineVergence affine;
        bool fromDepth = false;
        double nearest = 0.0, farthest = 0.0;  ///< vergences it is kept within, sloped only
    };
    int surfaceOf(const Part& part, int x, int y) const;
    Size size_;
    double step_ = 1.0;
    Box<DepthMap> depth_;
    std::vector<Part> parts_;
    std::vector<CutSurface> surfaces_;
    std::map<long, int> bands_;
};

/// Vergence between two bands: half a view pixel of blur (`coarseness` times that), but no region in more than 24.
double bandStep(const Document& document, const Plan& plan, double scale, double coarseness);

}  // namespace ilf::view
