// One picture of a project, worked out.
#pragma once

#include <string>

#include "app/headless/render_shots.h"
#include "core/compile/compile.h"
#include "projects/picture_export.h"

namespace ilf::app {

struct Rendered {
    projects::ExportPixels pixels;
    projects::PictureFacts facts;  ///< always with "shows" and "provenance"
    std::string spoken;            ///< "perceived, left eye, at rest, simulated, 1280x800"
    std::string figures;           ///< of an error map, a sentence or two; else empty
};

/// Refusals of `shotsOf` and `requestOf` are outOfRange; others are of the view's own making.
Result<Rendered> rendered(const Compiled& compiled, const Shot& shot, const RenderOptions& options);

}  // namespace ilf::app
