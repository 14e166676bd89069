// What the picture shows at a point.
#pragma once

#include "core/document/document.h"

namespace ilf {

/// The topmost active region that covers at least half of the pixel at `at`; null: the background, or outside.
const Region* regionAt(const Document& document, Point<CameraFrame> at);

}  // namespace ilf
