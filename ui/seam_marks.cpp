#include "ui/seam_marks.h"

#include "ui/widgets.h"

namespace ilf::ui {

ImU32 seamColour(double weber) {
    switch (sight(weber)) {
    case SeamSight::hidden:
        return colour::good;
    case SeamSight::faint:
        return colour::warn;
    case SeamSight::visible:
        break;
    }
    return colour::fault;
}

void drawBorderSeams(Panel& p, const Viewport& viewport, ImDrawList& draw) {
    const State& state = p.state;
    const auto& seams = p.view.computed.seams;
    const bool asSeen = state.mode == ViewMode::perceived;
    if (!seams || !state.seamMarks || !(asSeen || state.mode == ViewMode::scene) || state.overlayHidden ||
        state.plainHeld || p.view.previewing || !p.view.computed.forCurrent) {
        return;
    }
    const std::size_t eye = state.eye == Eye::left ? 0 : 1;
    for (const BorderSeam& seam : *seams) {
        for (const BorderPoint& point : seam.points) {
            const double weber = asSeen ? point.weber[eye] : point.worst();
            const SeamSight seen = sight(weber);
            if (seen == SeamSight::hidden && state.page != Page::seam) continue;
            const float radius = p.px(seen == SeamSight::hidden ? 1.0 : seen == SeamSight::faint ? 1.5 : 2.1);
            const ImVec2 at = vec(viewport.toWindow(point.at));
            draw.AddCircleFilled(at, radius + 1, rgb(0x000000, 110), 8);
            draw.AddCircleFilled(at, radius, faded(seamColour(weber), 0.9), 8);
        }
    }
}

}  // namespace ilf::ui
