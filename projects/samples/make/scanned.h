// A sample as a registered rig knows it: what a Gray-code scan of the drawn scene measures, instead of what is true.
#pragma once

#include "core/base/result.h"
#include "core/document/document.h"
#include "render.h"

namespace ilf::samples {

/// The document with a projector beside its camera: pictures of its patterns on the drawn scene (shading, shadow,
/// noise) are decoded, checked and triangulated with the program's own means. Depth becomes the measured one, with its
/// uncertainty, and the rig gets the scanned map. Numbers are rounded (1/16 px, 2^-13 m), so that files are small.
Result<Document> scanned(Document document, const Scene& scene, const Rendering& rendering);

}  // namespace ilf::samples
