// What the camera sees, with the raster's corners to drag and the crosses that were clicked.
#include <algorithm>
#include <cmath>

#include "ui/register_page.h"
#include "ui/register_parts.h"
#include "ui/widgets.h"

namespace ilf::ui {
namespace {

constexpr double kGrip = 9.0, kWithin = 16.0;

Point<WidgetFrame> pointer() {
    const ImVec2 at = ImGui::GetMousePos();
    return {at.x, at.y};
}

void label(ImDrawList& draw, ImVec2 at, const std::string& words, ImU32 ink) {
    const ImVec2 size = ImGui::CalcTextSize(words.c_str());
    draw.AddRectFilled({at.x - 3, at.y - 1}, {at.x + size.x + 3, at.y + size.y + 1}, faded(colour::ground, 0.75), 3);
    draw.AddText(at, ink, words.c_str());
}

void corners(Panel& p, const RegisterView& r, const Viewport& viewport, ImDrawList& draw, bool hovered) {
    static constexpr const char* kNames[] = {"1 upper left", "2 upper right", "3 lower right", "4 lower left"};
    const ImU32 ink = r.found ? colour::good : colour::warn;
    std::array<ImVec2, 4> at;
    for (std::size_t i = 0; i < 4; ++i)
        at[i] = vec(viewport.toWindow(r.corners[i]));
    draw.AddPolyline(at.data(), 4, ink, ImDrawFlags_Closed, p.px(1.5));
    int nearest = -1;
    double least = kWithin * p.scale;
    for (std::size_t i = 0; i < 4; ++i) {
        const double away = std::hypot(pointer().x - at[i].x, pointer().y - at[i].y);
        if (away < least) least = away, nearest = static_cast<int>(i);
    }
    int& held = p.state.registerCorner;
    if (hovered && ImGui::IsMouseClicked(ImGuiMouseButton_Left)) held = nearest;
    if (!ImGui::IsMouseDown(ImGuiMouseButton_Left)) held = -1;
    if (held >= 0) p.requests.push_back(PlaceCorner{held, viewport.toPicture(pointer())});
    for (std::size_t i = 0; i < 4; ++i) {
        const bool on = held == static_cast<int>(i) || (held < 0 && hovered && nearest == static_cast<int>(i));
        draw.AddCircle(at[i], p.px(kGrip), colour::ground, 0, p.px(4));
        draw.AddCircle(at[i], p.px(kGrip), on ? colour::safe : ink, 0, p.px(2));
        draw.AddLine({at[i].x - p.px(4), at[i].y}, {at[i].x + p.px(4), at[i].y}, ink);
        draw.AddLine({at[i].x, at[i].y - p.px(4)}, {at[i].x, at[i].y + p.px(4)}, ink);
        label(draw, {at[i].x + p.px(kGrip + 4), at[i].y - p.px(8)}, kNames[i], colour::text);
    }
}

void pairs(Panel& p, const RegisterView& r, const Viewport& viewport, ImDrawList& draw, bool hovered) {
    for (std::size_t i = 0; i < r.pairs.size(); ++i) {
        const RegisterPair& pair = r.pairs[i];
        const ImU32 ink = !pair.used ? colour::fault : static_cast<int>(i) == r.worst ? colour::warn : colour::good;
        const ImVec2 at = vec(viewport.toWindow(pair.at.camera));
        draw.AddLine({at.x - p.px(8), at.y}, {at.x + p.px(8), at.y}, ink, p.px(1.5));
        draw.AddLine({at.x, at.y - p.px(8)}, {at.x, at.y + p.px(8)}, ink, p.px(1.5));
        const std::string words = std::to_string(i + 1) + (!pair.fitted ? ""
                                                           : pair.used  ? "  " + px(pair.residual_px)
                                                                        : "  left out");
        label(draw, {at.x + p.px(8), at.y + p.px(4)}, words, ink);
    }
    if (!hovered) return;
    const ImVec2 at = vec(pointer());
    draw.AddCircle(at, p.px(10), colour::focus, 0, p.px(1));
    if (r.targetsLeft && r.showsMarks && ImGui::IsMouseClicked(ImGuiMouseButton_Left))
        p.requests.push_back(PlaceCross{viewport.toPicture(pointer())});
}

/// Corners of the newest pose, joined in their order, so that a board that was found the wrong way round shows.
void boardMarks(Panel& p, const RegisterView& r, const Viewport& viewport, ImDrawList& draw) {
    std::vector<ImVec2> at;
    for (const auto& corner : r.calibration.corners)
        at.push_back(vec(viewport.toWindow(corner)));
    if (at.empty()) return;
    draw.AddPolyline(at.data(), static_cast<int>(at.size()), faded(colour::focus, 0.5), 0, p.px(1));
    for (const ImVec2& one : at)
        draw.AddCircle(one, p.px(4), colour::good, 0, p.px(1.5));
}

void tape(Panel& p, const RegisterView& r, const Viewport& viewport, ImDrawList& draw, bool hovered) {
    std::vector<ImVec2> at;
    for (const auto& end : r.tape.ends)
        at.push_back(vec(viewport.toWindow(end)));
    if (at.size() == 2) {
        draw.AddLine(at[0], at[1], colour::ground, p.px(4));
        draw.AddLine(at[0], at[1], colour::safe, p.px(2));
        if (r.tape.length > 0.0_m)
            label(draw, {(at[0].x + at[1].x) / 2 + p.px(8), (at[0].y + at[1].y) / 2}, formatted(r.tape.length),
                  colour::text);
    }
    for (const ImVec2& one : at) {
        draw.AddCircle(one, p.px(6), colour::ground, 0, p.px(4));
        draw.AddCircle(one, p.px(6), colour::safe, 0, p.px(2));
    }
    if (!hovered) return;
    draw.AddCircle(vec(pointer()), p.px(10), colour::focus, 0, p.px(1));
    if (ImGui::IsMouseClicked(ImGuiMouseButton_Left)) p.requests.push_back(PlaceTape{viewport.toPicture(pointer())});
}

/// What was measured under the pointer.
void depthHere(Panel& p, const RegisterView& r, const Viewport& viewport, ImDrawList& draw) {
    const RegisterDepth& depth = *r.found->depth;
    const Point<CameraFrame> at = viewport.toPicture(pointer());
    const int x = static_cast<int>(std::floor(at.x)), y = static_cast<int>(std::floor(at.y));
    if (x < 0 || y < 0 || x >= depth.metres.width() || y >= depth.metres.height()) return;
    const auto metres = static_cast<double>(depth.metres.at(x, y));
    std::string words = "no depth";
    if (metres > 0.0) {
        words = formatted(metres, Unit::metre);
        if (!depth.spread.empty())
            words += " \u00b1 " + formatted(static_cast<double>(depth.spread.at(x, y)), Unit::millimetre);
    }
    label(draw, {static_cast<float>(pointer().x) + p.px(14), static_cast<float>(pointer().y) - p.px(8)}, words,
          colour::text);
}

std::string whyEmpty(const Panel& p, const RegisterView& r) {
    if (r.state != RegisterView::State::ready && r.state != RegisterView::State::accepted)
        return r.emulated ? "The emulated camera works out where light goes: some seconds."
                          : "The scan has the camera and waits for its first picture.";
    if (!p.view.camera.open) return "No camera is open.";
    return r.emulated ? "The emulated camera works out where light goes: some seconds."
                      : "The camera has not given a picture yet.";
}

}  // namespace

Viewport registerViewport(const RegisterView& r, const Rect& area) {
    // At the area's upper edge, so that a legend beneath it is near.
    const Size size = r.picture.size();
    const double height = size.width > 0 ? std::min(area.h, area.w * size.height / size.width) : area.h;
    return fitted({area.x, area.y, area.w, height}, size);
}

void registerPicture(Panel& p, const RegisterView& r, const Rect& area) {
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    if (r.picture.empty()) {
        const std::string words = whyEmpty(p, r);
        const ImVec2 size = ImGui::CalcTextSize(words.c_str());
        draw.AddText(vec(area.x + (area.w - size.x) / 2, area.y + area.h / 2), colour::dim, words.c_str());
        return;
    }
    const Viewport viewport = registerViewport(r, area);
    const Size size = r.picture.size();
    const ImVec2 from = vec(viewport.toWindow({0, 0}));
    const ImVec2 to = vec(viewport.toWindow({static_cast<double>(size.width), static_cast<double>(size.height)}));
    if (p.view.registerPicture.id != 0)
        draw.AddImage(reinterpret_cast<ImTextureID>(p.view.registerPicture.id), from, to);
    ImGui::SetCursorScreenPos(from);
    ImGui::InvisibleButton("###registerPicture", {to.x - from.x, to.y - from.y});
    const bool hovered = ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenBlockedByActiveItem);
    const bool ready = r.state == RegisterView::State::ready, settled = ready && r.shows == RegisterPicture::live;
    if (r.way == RegisterWay::corners && settled) corners(p, r, viewport, draw, hovered);
    if (r.way == RegisterWay::pairs && settled) pairs(p, r, viewport, draw, hovered);
    if (r.way == RegisterWay::calibration && r.state != RegisterView::State::working) boardMarks(p, r, viewport, draw);
    if (ready && r.tape.placing) tape(p, r, viewport, draw, hovered);
    const bool depth = r.shows == RegisterPicture::depth || r.shows == RegisterPicture::spread;
    if (depth && hovered && r.found && r.found->depth) depthHere(p, r, viewport, draw);
    if (registerLegendBelow(p.at, p.scale)) {
        ImGui::SetCursorScreenPos({from.x, to.y + p.px(8)});
        registerLegend(p, r, to.x - from.x, 2);
    }
    if (r.shows != RegisterPicture::quality) return;
    for (const ScanFinding& finding : r.findings) {
        const auto& a = finding.area;
        if (a.empty()) continue;
        const auto corner = [&](int x, int y) {
            return vec(viewport.toWindow({static_cast<double>(x), static_cast<double>(y)}));
        };
        draw.AddRect(corner(a.x0, a.y0), corner(a.x1, a.y1),
                     finding.weight == ScanFinding::Weight::failure ? colour::fault : colour::warn, 0, 0, p.px(1.5));
    }
}

}  // namespace ilf::ui
