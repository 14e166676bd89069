// Which surfaces are lit at which level, and where an eye sees that light: all the seam work needs besides the masks.
#pragma once

#include <optional>
#include <vector>

#include "core/compile/disc.h"
#include "core/document/document.h"
#include "core/plan/plan.h"

namespace ilf {

/// A surface with one role in the light: regions of the same role on the same surface have no seam between them.
struct Sheet {
    std::optional<int> level;  ///< none: neutral, lit in every level
    Distance distance;
    Dioptre fallback;  ///< vergence where its depth map has a hole
    bool operator==(const Sheet&) const = default;
};

/// A displacement on the raster, in projector pixels.
struct Shift {
    float x = 0.0F, y = 0.0F;
    bool operator==(const Shift&) const = default;
};

/// How a layer is seen around one point of the raster.
struct LayerNode {
    Shift toPainted;       ///< from a lit pixel to the painted point whose share of the halfway border it carries
    Shift toSeen;          ///< from a lit pixel to where it appears
    Shift toLit;           ///< from an apparent place to the pixel seen there
    float feather = 0.0F;  ///< W, projector pixels
    float blurRadius =
        0.0F;  ///< R of the apparent disc over s: the disc as it lies on the lit pixels, projector pixels
    bool operator==(const LayerNode&) const = default;
};

/// Light of one sheet in one level that an eye sees displaced, blurred or both.
struct Layer {
    int sheet = 0;
    int level = 0;
    double share = 1.0;            ///< of the sheet's light
    std::vector<LayerNode> nodes;  ///< at tile corners, (columns + 1) x (rows + 1), row by row
    std::vector<int> discOf;       ///< for each tile, row by row: its blur, as an index into Lighting::discs
    bool operator==(const Layer&) const = default;
};

/// Everything seam work depends on besides masks; made once for a document and its plan.
struct Lighting {
    Size projector;
    int columns = 0, rows = 0;  ///< tiles of the raster
    Blending blending = Blending::closedForm;
    int levels = 0;
    int base = 0;  ///< the level the eye looks through at rest: it gives whatever light layers do not
    std::vector<Sheet> sheets;
    std::vector<int> sheetOf;  ///< for each active region, topmost first, then the background
    std::vector<Layer> layers;
    std::vector<Disc> discs;
    std::vector<bool> stepBetween;  ///< sheets x sheets: their border may be a depth step somewhere
    float distanceReach = 0.0F;     ///< how far from a border its distance matters, projector pixels
    int layerReach = 0;             ///< a tile of a layer depends on visible weights at most this many pixels away
    int blendReach = 0;             ///< a tile of the base level depends on layers at most this many pixels away
    bool operator==(const Lighting&) const = default;

    const Disc& disc(const Layer& layer, int column, int row) const {
        return discs[static_cast<std::size_t>(layer.discOf[static_cast<std::size_t>(row * columns + column)])];
    }
    const LayerNode& node(const Layer& layer, int column, int row) const {
        return layer.nodes[static_cast<std::size_t>(row * (columns + 1) + column)];
    }
    bool mayStep(int a, int b) const {
        return stepBetween[static_cast<std::size_t>(a) * sheets.size() + static_cast<std::size_t>(b)];
    }
};

/// Precondition: the plan was made for this document and has at least one level.
Lighting lighting(const Document& document, const Plan& plan);

/// Vergence of a sheet at a point of the picture, dioptres.
double vergenceAt(const Document& document, const Sheet& sheet, Point<CameraFrame> at);

}  // namespace ilf
