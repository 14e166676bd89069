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
    bool sloped = false;  ///< a band: bands add up where they meet, and hide each other nowhere
    bool operator==(const CutSurface&) const = default;
};

/// How a document's regions become surfaces: constant ones by their vergence, sloped ones cut into bands on one grid,
/// so that regions on one table lie on the same surfaces. A point between two bands belongs to both, by how near it is.
class SceneCut {
public:
    /// `step` is the vergence between two bands.
    SceneCut(const Document& document, const Plan& plan, double step);
    const std::vector<CutSurface>& surfaces() const { return surfaces_; }

    /// One number for each pixel of a tile, surface by surface; only those that `touched` are filled in.
    struct Tiles {
        std::vector<std::array<float, kTilePixels>> values;
        std::vector<bool> touched;
    };
    /// What each surface shows of the pixels of a tile of the picture, from its corner; adds up to at most 1.
    void shares(int x0, int y0, Tiles& shares) const;
    /// Shares become alphas, in place: what each covers of what nearer ones leave.
    void toAlphas(Tiles& shares) const;

    /// The same cut, over other masks.
    bool sameBut(const SceneCut& other) const;
    /// Surfaces may lie elsewhere, but where masks are the same each shows the same of every point.
    bool sameShares(const SceneCut& other) const;

private:
    /// A region that takes part, topmost first.
    struct Part {
        Box<Region> region;
        int constant = -1;  ///< its surface; -1: sloped
        AffineVergence affine;
        bool fromDepth = false;
        double nearest = 0.0, farthest = 0.0;  ///< vergences it is kept within, sloped only
    };
    /// Where a point lies between bands: the first one's number, and how much it belongs to the next.
    struct BetweenBands {
        long band = 0;
        float next = 0.0F;
    };
    BetweenBands between(const Part& part, int x, int y) const;
    Size size_;
    double step_ = 1.0;
    Box<DepthMap> depth_;
    std::vector<Part> parts_;
    std::vector<CutSurface> surfaces_;
    std::map<long, int> bands_;
};

/// What each surface shows of a whole picture, averaged to the view's size; one channel each.
std::vector<Image<float>> pictureShares(const SceneCut& cut, Size picture, Size view, int threads);

/// Vergence between two bands: half a view pixel of blur (`coarseness` times that), but no region in more than 24.
double bandStep(const Document& document, const Plan& plan, double scale, double coarseness);

}  // namespace ilf::view
