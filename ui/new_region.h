// A region as the window adds it: named, blurred, empty.
#pragma once

#include "core/document/document.h"
#include "ui/studio.h"

namespace ilf::ui {

/// A random UUID.
RegionId newRegionId();
/// "Region 3", to be blurred, covering nothing yet.
Region newRegion(const Document& document);
/// Why a command can not be done now; empty when it can.
std::string whyNot(Command command, const View& view, const State& state);

/// What a distance may be typed or dragged to.
inline constexpr Metre kNearestTyped = 0.05_m, kFarthestTyped = 1000.0_m;
inline constexpr double kGrowStep = 4.0;  ///< camera pixels a "grow" adds
inline constexpr double kBrushStep = 1.2;
inline constexpr double kZoomStep = 1.25;

}  // namespace ilf::ui
