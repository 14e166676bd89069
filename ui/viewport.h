// Where the picture lies in the window: zoom, pan, and the way between picture and window pixels.
#pragma once

#include "ui/layout.h"

namespace ilf::ui {

struct Viewport {
    Rect area;                  ///< the canvas
    double zoom = 1.0;          ///< window pixels per picture pixel
    Point<CameraFrame> centre;  ///< shown in the middle of `area`

    Point<WidgetFrame> toWindow(Point<CameraFrame> p) const {
        return {area.x + area.w / 2 + (p.x - centre.x) * zoom, area.y + area.h / 2 + (p.y - centre.y) * zoom};
    }
    Point<CameraFrame> toPicture(Point<WidgetFrame> p) const {
        return {centre.x + (p.x - area.x - area.w / 2) / zoom, centre.y + (p.y - area.y - area.h / 2) / zoom};
    }
};

/// The whole picture in the middle of `area`, with a small margin.
Viewport fitted(const Rect& area, Size picture);
/// `viewport` zoomed by `factor`; what lies under `about` stays there. Zoom stays inside [kMinZoom, kMaxZoom].
Viewport zoomedAbout(Viewport viewport, Point<WidgetFrame> about, double factor);

inline constexpr double kMinZoom = 0.02, kMaxZoom = 64.0;

}  // namespace ilf::ui
