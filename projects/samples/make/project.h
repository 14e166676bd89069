// The project of a sample: its regions with looks and distances over a rendered scene.
#pragma once

#include "core/document/document.h"
#include "render.h"

namespace ilf::samples {

/// `scene` must be one of those of scenes.h and `rendering` its rendering. Distances are those of the rendering;
/// those of the paper's four objects are the paper's.
Document project(const Scene& scene, const Rendering& rendering);

}  // namespace ilf::samples
