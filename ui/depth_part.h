// The scene page's lower part: depth map and the wearer's place.
#pragma once

#include "ui/panel.h"

namespace ilf::ui {

/// Loads and removes the scene's depth, says what it is, and holds the wearer's place as it is typed.
void depthPart(Panel& p);

}  // namespace ilf::ui
