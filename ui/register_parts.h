// Pieces of the registering page that its files share.
#pragma once

#include <string>

#include "core/base/as_text.h"
#include "ui/panel.h"
#include "ui/request.h"

namespace ilf::ui {

/// Beside the button before it, or below where there is no room.
bool registerButton(Panel& p, const char* words, const char* help, bool enabled = true);
/// Asks for a step of the wizard, with what the operator set.
void ask(Panel& p, Register::Step step);

inline std::string px(double value) { return asText("%.2f px", value); }

/// The printed board, its poses with their residuals, and what they make of camera and projector.
void calibrationPart(Panel& p, const RegisterView& r);
/// The depth that a scan measured, and the tape that its metres can be checked with.
void depthFoundPart(Panel& p, const RegisterView& r);

/// What the colours of the picture mean, from the cursor on, in so many columns.
void registerLegend(Panel& p, const RegisterView& r, float width, int columns);

}  // namespace ilf::ui
