// Where a seam will be visible, along the borders on the canvas.
#pragma once

#include <imgui.h>

#include "ui/panel.h"
#include "ui/viewport.h"

namespace ilf::ui {

/// By how visible it is: hidden, faint or visible. Marks differ in size as well.
ImU32 seamColour(double weber);

/// The borders as last looked at: in the scene for the worse eye, in a perceived view for the eye shown. Hidden ones
/// only while the seam page is open; nothing while the operator paints, since marks would lag behind the brush.
void drawBorderSeams(Panel& p, const Viewport& viewport, ImDrawList& draw);

}  // namespace ilf::ui
