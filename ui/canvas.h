// The picture in the middle: what the canvas' parts share.
#pragma once

#include <imgui.h>

#include <optional>

#include "ui/panel.h"
#include "ui/viewport.h"

namespace ilf::ui {

/// The document as it is drawn and clicked: what follows something lies where the live picture shows it.
const Document& shown(const Panel& p);
/// From where a region is painted to where it is shown.
inline Motion motionOf(const Panel& p, const RegionId& region) { return motionOf(p.view.follow, region); }
/// The distance at which the optical centres are drawn: of the selected region, or of what the plan focuses on.
Metre markDistance(const Panel& p);
/// A distance whose every point is `ratio` times as far; nothing for a depth map, which is measured.
std::optional<Distance> scaled(const Distance& distance, double ratio);
/// The distance written on a region, in the middle of what it covers.
struct Badge {
    const Region* region = nullptr;
    Point<WidgetFrame> at;
};
/// Badges of all regions that take part; where two would lie on each other, the lower one gives way downwards.
std::vector<Badge> badges(const Panel& p, const Viewport& viewport);

/// Radius of handles in window pixels at scale 1; the reach of a click is a little more.
inline constexpr double kHandle = 7.0, kReach = 11.0;

void zoomTo(State& state, double zoom);
/// Turns the eye of perceived views to a point of the picture; it focuses on what is seen there.
void lookAt(State& state, const Document& document, Point<CameraFrame> at);
/// Closes the polygon being drawn into the selected region (a new one when none is selected).
void finishPolygon(const View& view, State& state, Requests& requests);

Viewport viewportOf(const Panel& p);
/// Presses, drags and releases of this frame, by the pointer's whole trail.
void canvasGestures(Panel& p, const Viewport& viewport, bool hovered, bool activated);
/// Textures of the current view.
void drawPictures(Panel& p, const Viewport& viewport, ImDrawList& draw);
/// What belongs to the scene but is no pixel: centres, lens field, star, anchors, outline, brush ring.
void drawMarks(Panel& p, const Viewport& viewport, ImDrawList& draw, bool hovered);

}  // namespace ilf::ui
