// Edits that paint: dabs and shapes on a mask, kept out of other regions when asked.
#include <algorithm>
#include <cmath>

#include "core/document/edit_parts.h"

namespace ilf {

namespace {

constexpr double kFarOutside = 1e6;  // pixels; a point farther out is a mistake, not a gesture
constexpr std::size_t kMostVertices = 100000;

Result<void> checkedPoint(const std::string& spoken, Point<CameraFrame> p) {
    if (std::abs(p.x) <= kFarOutside && std::abs(p.y) <= kFarOutside) return {};
    return fail(Fault::outOfRange, capitalised(spoken) + " lies nowhere near the picture: draw it again.");
}

Result<void> checkedDab(const Dab& dab) {
    if (auto ok = inRange("the brush's radius", dab.brush.radius, 0.5, 2000.0, "px"); !ok) return ok;
    if (auto ok = inRange("the brush's hardness", dab.brush.hardness, 0.0, 1.0, ""); !ok) return ok;
    if (auto ok = inRange("the brush's opacity", dab.brush.opacity, 0.0, 1.0, ""); !ok) return ok;
    return checkedPoint("a brush stroke", dab.at);
}

Result<void> checkedShape(const Shape& shape) {
    if (const auto* outline = std::get_if<Outline>(&shape)) return checked(*outline);
    const auto corners = [](const auto& s) -> Result<void> {
        if (auto ok = checkedPoint("the shape", s.a); !ok) return ok;
        return checkedPoint("the shape", s.b);
    };
    if (const auto* ellipse = std::get_if<Ellipse>(&shape)) return corners(*ellipse);
    return corners(std::get<Rectangle>(shape));
}

/// What the other visible regions cover, in the tiles that touch `within`; 0 elsewhere.
Mask coverageOfOthers(const Document& document, const RegionId& id, PixelRect<CameraFrame> within) {
    Mask covered(document.scene.size());
    const PixelRect<CameraFrame> pixels = within.clipped(covered.size());
    if (pixels.empty()) return covered;
    for (const Box<Region>& other : document.regions) {
        if (other->id == id || !other->visible) continue;
        for (int row = pixels.y0 / kTile; row <= (pixels.y1 - 1) / kTile; ++row) {
            for (int column = pixels.x0 / kTile; column <= (pixels.x1 - 1) / kTile; ++column) {
                const Box<Tile>& theirs = other->mask.tile(column, row);
                if (theirs.same(uniformTile(0)) || covered.isUniform(column, row, 255)) continue;
                if (covered.isUniform(column, row, 0)) {
                    covered.setTile(column, row, theirs);
                    continue;
                }
                Tile most = *covered.tile(column, row);
                for (std::size_t i = 0; i < most.v.size(); ++i)
                    most.v[i] = std::max(most.v[i], theirs->v[i]);
                covered.setTile(column, row, boxed(most));
            }
        }
    }
    return covered;
}

}  // namespace

Result<void> checked(const Outline& outline) {
    if (outline.vertices.size() < 3) return fail(Fault::outOfRange, "An outline needs at least three points.");
    if (outline.vertices.size() > kMostVertices) {
        return fail(Fault::outOfRange, "An outline can have at most 100000 points, and this one has " +
                                           std::to_string(outline.vertices.size()) + ": draw it in parts.");
    }
    for (const Point<CameraFrame>& p : outline.vertices) {
        if (auto ok = checkedPoint("a point of the outline", p); !ok) return ok;
    }
    return {};
}

Result<Mask> withPaint(const Document& document, const Region& region, const Paint& paint) {
    PixelRect<CameraFrame> reached;
    for (const Dab& dab : paint.dabs) {
        if (auto ok = checkedDab(dab); !ok) return tl::unexpected(ok.error());
        reached = reached.united(reach(dab));
    }
    if (!paint.protectOthers || paint.mode == PaintMode::erase) return painted(region.mask, paint.dabs, paint.mode);
    const Mask keepOut = coverageOfOthers(document, region.id, reached);
    return painted(region.mask, paint.dabs, paint.mode, &keepOut);
}

Result<Mask> withShape(const Document& document, const Region& region, const FillShape& fill) {
    if (auto ok = checkedShape(fill.shape); !ok) return tl::unexpected(ok.error());
    const Mask shape = rasterised(fill.shape, region.mask.size());
    if (fill.mode == PaintMode::erase) return subtracted(region.mask, shape);
    if (!fill.protectOthers) return united(region.mask, shape);
    return united(region.mask, subtracted(shape, coverageOfOthers(document, region.id, shape.coveredPixels())));
}

}  // namespace ilf
