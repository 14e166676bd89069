// The compiler: a document and its plan become a program, tile by tile, and only the tiles an edit can reach.
#pragma once

#include <memory>

#include "core/compile/program.h"
#include "core/document/document.h"
#include "core/plan/plan.h"

namespace ilf {

/// How much work a compile did and what it could skip.
struct CompileCounters {
    int tiles = 0;      ///< tiles of all images together
    int computed = 0;   ///< worked out now
    int unchanged = 0;  ///< taken from the previous compile
    int uniform = 0;    ///< same everywhere: nothing but a box
    int seamTiles = 0;  ///< of the raster: where light that an eye sees displaced or blurred ends
    bool operator==(const CompileCounters&) const = default;
};

struct CompileParts;  // core/compile/parts.h

/// The result, with all it was made from, so that the next compile can tell by comparison what changed.
struct Compiled {
    Document document;
    Plan plan;
    Program program;
    CompileCounters counters;
    /// Pictures on the way from masks to light, which the next compile shares where nothing changed.
    std::shared_ptr<const CompileParts> parts;

    /// Counters and parts tell how the result was reached, not what it is.
    bool operator==(const Compiled& o) const {
        return document == o.document && plan == o.plan && program == o.program;
    }
};

/// Compiles. With `previous`, tiles that no difference between the two documents can reach are shared with it; the
/// result is bit-identical to a compile from nothing (a law).
///
/// Model (closed form): with m_i(x) the blurred light of region i as it appears, the eye receives w0 + sum PSF_i * m_i,
/// which must be 1:  w0 = 1 - sum PSF_i * m_i,  and the projector lights  w_p(y) = m_i(c + s_i (y - c)).
/// The perceived boundary lies halfway between the painted one and its magnified image; m is a linear ramp of the
/// feather's width on the signed distance to it; a brush softer than the feather keeps its own softness. Across a depth
/// step nothing is feathered. The centre c is midway between the two eyes' optical centres on that surface: the light
/// is shared, and the midpoint makes the worse eye as good as it can be.
Result<Compiled> compile(const Document& document, const Plan& plan, const Compiled* previous = nullptr);

/// Two surfaces farther apart than this at a border are a depth step.
inline constexpr Dioptre kDepthStep = 0.15_D;

}  // namespace ilf
