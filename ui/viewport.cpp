#include "ui/viewport.h"

#include <algorithm>

namespace ilf::ui {

Viewport fitted(const Rect& area, Size picture) {
    constexpr double kMargin = 0.97;
    Viewport viewport{area, 1.0, {picture.width / 2.0, picture.height / 2.0}};
    if (picture.width > 0 && picture.height > 0 && !area.empty()) {
        viewport.zoom =
            std::clamp(kMargin * std::min(area.w / picture.width, area.h / picture.height), kMinZoom, kMaxZoom);
    }
    return viewport;
}

Viewport zoomedAbout(Viewport viewport, Point<WidgetFrame> about, double factor) {
    const Point<CameraFrame> still = viewport.toPicture(about);
    viewport.zoom = std::clamp(viewport.zoom * factor, kMinZoom, kMaxZoom);
    const Point<CameraFrame> moved = viewport.toPicture(about);
    viewport.centre = {viewport.centre.x + still.x - moved.x, viewport.centre.y + still.y - moved.y};
    return viewport;
}

}  // namespace ilf::ui
