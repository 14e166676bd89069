// Where everything is: a pure function from window size to rectangles.
#pragma once

#include "core/base/geometry.h"

namespace ilf::ui {

/// Pixels of the window, origin at its upper left corner.
struct Rect {
    double x = 0, y = 0, w = 0, h = 0;
    bool operator==(const Rect&) const = default;
    double right() const { return x + w; }
    double bottom() const { return y + h; }
    bool empty() const { return w <= 0 || h <= 0; }
    bool holds(Point<WidgetFrame> p) const { return p.x >= x && p.x < right() && p.y >= y && p.y < bottom(); }
};

/// What the operator can drag. Pixels at scale 1; `layout` clamps them to what the window can give.
struct PanelSizes {
    double side = 324;      ///< width of the panels on the right
    double charts = 190;    ///< height of the charts
    double regions = 0.34;  ///< share of the side column given to the list
    bool hidden = false;    ///< only the picture (Tab)
    bool operator==(const PanelSizes&) const = default;
};

/// Touch targets that must be hit blind, at scale 1.
inline constexpr double kLiveTarget = 44;

struct Layout {
    Rect top;                     ///< menu, chips, TAKE, SAFE LIGHT
    Rect tools;                   ///< left
    Rect header;                  ///< canvas tabs
    Rect canvas;                  ///< the picture
    Rect regions;                 ///< list
    Rect selected;                ///< the selected region; empty when it is a page among `pages`
    Rect pages;                   ///< wearer, seam, rig, scene, history
    Rect sweep, blurRange, seam;  ///< charts
    Rect status;
    Rect sideSplitter, chartSplitter, regionsSplitter;  ///< overlay the borders; a drag changes PanelSizes
};

/// Rectangles (splitters aside) never overlap and lie inside the window. With `hidden`, only `top` (where SAFE LIGHT
/// and TAKE stay) and `canvas` are left. Windows smaller than 1280x720 at scale 1 lose charts before anything else.
/// `onePage`: `canvas` has the places of tools, tabs and charts as well, and the columns their height.
Layout layout(Size window, double scale, const PanelSizes& sizes, bool onePage = false);

}  // namespace ilf::ui
