// What belongs to the scene but is no pixel of it: optical centres, lens field, driver star, anchors, outline, ring.
#include <algorithm>
#include <cmath>

#include "ui/canvas.h"
#include "ui/icons.h"
#include "ui/seam_marks.h"
#include "ui/widgets.h"

namespace ilf::ui {

namespace {

using Kind = CanvasGesture::Kind;

constexpr ImU32 kShadow = rgb(0x000000, 150);

struct Marks {
    Panel& p;
    const Viewport& viewport;
    ImDrawList& draw;

    ImVec2 at(Point<CameraFrame> point) const { return vec(viewport.toWindow(point)); }
    float px(double value) const { return p.px(value); }

    void handle(Point<CameraFrame> point, ImU32 ink, const char* letter = nullptr, bool small = false) const {
        const ImVec2 c = at(point);
        const float radius = px(small ? kHandle * 0.6 : letter != nullptr ? kHandle * 1.4 : kHandle);
        draw.AddCircleFilled(c, radius + 1, kShadow, 24);
        draw.AddCircleFilled(c, radius, rgb(0x101317, 220), 24);
        draw.AddCircle(c, radius, ink, 24, px(1.6));
        if (letter == nullptr) return;
        ImFont* face = font(Font::small);
        const ImVec2 extent = face->CalcTextSizeA(face->FontSize, 99, 0, letter);
        draw.AddText(face, face->FontSize, {c.x - extent.x / 2, c.y - extent.y / 2}, ink, letter);
    }

    void label(ImVec2 centre, const std::string& words, ImU32 ink, bool strong) const {
        ImFont* face = font(Font::small);
        const ImVec2 extent = face->CalcTextSizeA(face->FontSize, 4096, 0, words.c_str());
        const ImVec2 from{centre.x - extent.x / 2, centre.y - extent.y / 2};
        draw.AddRectFilled({from.x - px(7), from.y - px(4)}, {from.x + extent.x + px(7), from.y + extent.y + px(4)},
                           rgb(0x101317, strong ? 235 : 190), px(9));
        if (strong) {
            draw.AddRect({from.x - px(7), from.y - px(4)}, {from.x + extent.x + px(7), from.y + extent.y + px(4)}, ink,
                         px(9), 0, px(1.2));
        }
        draw.AddText(face, face->FontSize, from, strong ? ink : faded(ink, 0.85), words.c_str());
    }
};

void drawBadges(const Marks& m) {
    const auto driver = m.p.plan() != nullptr ? m.p.plan()->driver : std::nullopt;
    for (const auto& [region, place] : badges(m.p, m.viewport)) {
        std::string words;
        if (driver == region->id) words += std::string(hasIcons() ? icon::star : "*") + " ";
        const RegionPlan* planned = m.p.planOf(region->id);
        if (const auto* constant = std::get_if<ConstantDistance>(&region->distance)) {
            words += formatted(constant->value);
        } else if (planned != nullptr) {
            words += formatted(planned->nearest) + " \u2013 " + formatted(planned->farthest);
        } else {
            words += "depth map";
        }
        m.label(vec(place), words, lookColour(region->look), region->id == m.p.state.selected);
    }
}

void drawOptics(const Marks& m) {
    const Document& document = m.p.document();
    const Metre distance = markDistance(m.p);
    const bool live = m.p.state.tool == Tool::move;
    // Half the lens aperture seen from the pupil behind it: 16 mm at 20 mm is a half field of 21.8 degrees.
    const Wearer& wearer = document.wearer;
    const double radius = document.scene.scale.focalPixels * (0.5 * wearer.lensAperture / wearer.lensToPupil);
    for (const Eye eye : {Eye::left, Eye::right}) {
        const Point<CameraFrame> centre = opticalCentre(document, eye, distance);
        const bool shown =
            m.p.state.mode == ViewMode::scene || m.p.state.mode == ViewMode::light || m.p.state.eye == eye;
        if (!shown) continue;
        const ImVec2 c = m.at(centre);
        // Dashes: the circle is where the effect ends, not something painted.
        const auto r = static_cast<float>(radius * m.viewport.zoom);
        const int dashes = 2 * std::clamp(static_cast<int>(r / m.px(3)), 24, 400);
        for (int i = 0; i < dashes; i += 2) {
            const float a = 6.2831853f * static_cast<float>(i) / static_cast<float>(dashes),
                        b = 6.2831853f * static_cast<float>(i + 1) / static_cast<float>(dashes);
            m.draw.AddLine({c.x + r * std::cos(a), c.y + r * std::sin(a)},
                           {c.x + r * std::cos(b), c.y + r * std::sin(b)}, rgb(0xC9D1DB, live ? 110 : 55), m.px(1.2));
        }
        const ImU32 ink = live ? colour::text : faded(colour::text, 0.55);
        m.draw.AddLine({c.x - m.px(15), c.y}, {c.x + m.px(15), c.y}, faded(ink, 0.6));
        m.draw.AddLine({c.x, c.y - m.px(15)}, {c.x, c.y + m.px(15)}, faded(ink, 0.6));
        m.handle(centre, ink, eye == Eye::left ? "L" : "R");
    }
}

void drawSelected(const Marks& m) {
    const State& state = m.p.state;
    const Region* region = m.p.selected();
    if (region == nullptr) return;
    const Motion motion = motionOf(m.p, region->id);
    if (const auto* plane = std::get_if<PlaneDistance>(&region->distance)) {
        for (std::size_t i = 0; i < plane->anchors.size(); ++i) {
            const ImVec2 a = m.at(motion(plane->anchors[i].at)),
                         b = m.at(motion(plane->anchors[(i + 1) % plane->anchors.size()].at));
            m.draw.AddLine(a, b, rgb(0x58C48A, 120), m.px(1));
        }
        for (std::size_t i = 0; i < plane->anchors.size(); ++i) {
            const DistanceAnchor& anchor = plane->anchors[i];
            const auto at = motion(anchor.at);
            m.handle(at, colour::good);
            const ImVec2 c = m.at(at);
            m.label({c.x, c.y - m.px(20)}, std::to_string(i + 1) + ":  " + formatted(anchor.distance), colour::good,
                    false);
        }
    }
    if (!region->outline || (state.tool != Tool::move && state.tool != Tool::polygon)) return;
    auto vertices = state.gesture.kind == Kind::moveVertex ? state.gesture.points : region->outline->vertices;
    for (auto& vertex : vertices)
        vertex = motion(vertex);
    const ImU32 ink = lookColour(region->look);
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        const auto& next = vertices[(i + 1) % vertices.size()];
        m.draw.AddLine(m.at(vertices[i]), m.at(next), ink, m.px(1.2));
        m.handle({(vertices[i].x + next.x) / 2, (vertices[i].y + next.y) / 2}, faded(ink, 0.5), nullptr, true);
    }
    for (const auto& vertex : vertices)
        m.handle(vertex, ink);
}

void drawGesture(const Marks& m) {
    const State& state = m.p.state;
    const CanvasGesture& gesture = state.gesture;
    const ImVec2 a = m.at(gesture.start), b = m.at(gesture.now);
    const ImVec2 low{std::min(a.x, b.x), std::min(a.y, b.y)}, high{std::max(a.x, b.x), std::max(a.y, b.y)};
    const float width = m.px(1.5);
    if (gesture.kind == Kind::drawBox || (gesture.kind == Kind::drawShape && state.tool == Tool::rectangle)) {
        m.draw.AddRect(low, high, kShadow, 0, 0, width + 2);
        m.draw.AddRect(low, high, colour::text, 0, 0, width);
    } else if (gesture.kind == Kind::drawShape) {
        constexpr int kSides = 64;
        for (int i = 0; i <= kSides; ++i) {
            const float t = 6.2831853f * static_cast<float>(i) / kSides;
            m.draw.PathLineTo({(low.x + high.x) / 2 + (high.x - low.x) / 2 * std::cos(t),
                               (low.y + high.y) / 2 + (high.y - low.y) / 2 * std::sin(t)});
        }
        m.draw.PathStroke(colour::text, 0, width);
    } else if (gesture.kind == Kind::drawLasso) {
        for (const auto& point : gesture.points)
            m.draw.PathLineTo(m.at(point));
        m.draw.PathStroke(colour::text, ImDrawFlags_Closed, width);
    }
    if (state.polygon.empty()) return;
    for (const auto& vertex : state.polygon)
        m.draw.PathLineTo(m.at(vertex));
    if (state.cursor) m.draw.PathLineTo(m.at(*state.cursor));
    m.draw.PathStroke(colour::text, 0, width);
    for (const auto& vertex : state.polygon)
        m.handle(vertex, colour::text, nullptr, true);
}

void drawCursor(const Marks& m, bool hovered) {
    const State& state = m.p.state;
    if (!hovered && state.gesture.kind != Kind::paint) return;
    if (state.panHeld || state.gesture.kind == Kind::pan) return ImGui::SetMouseCursor(ImGuiMouseCursor_Hand);
    if (state.distanceHeld || state.gesture.kind == Kind::distance) {
        return ImGui::SetMouseCursor(ImGuiMouseCursor_ResizeNS);
    }
    if (state.tool != Tool::brush && state.tool != Tool::erase) return;
    const ImVec2 c = ImGui::GetMousePos();
    const Brush& brush = state.tool == Tool::erase ? state.eraser : state.brush;
    const auto radius = static_cast<float>(brush.radius * m.viewport.zoom);
    m.draw.AddCircle(c, radius + 1, kShadow, 0, m.px(2));
    m.draw.AddCircle(c, radius, colour::text, 0, m.px(1.2));
    if (brush.hardness < 0.95)
        m.draw.AddCircle(c, radius * static_cast<float>(brush.hardness), rgb(0xC9D1DB, 90), 0, 1);
    if (state.tool == Tool::erase) {
        m.draw.AddLine({c.x - m.px(4), c.y}, {c.x + m.px(4), c.y}, colour::text, m.px(1.2));
    }
    if (ImGui::GetIO().KeyShift && state.lastPoint && state.gesture.kind == Kind::none) {
        m.draw.AddLine(m.at(*state.lastPoint), c, rgb(0xC9D1DB, 150), m.px(1.2));
    }
}

}  // namespace

void drawMarks(Panel& p, const Viewport& viewport, ImDrawList& draw, bool hovered) {
    const Marks marks{p, viewport, draw};
    const bool asSeen = p.state.mode == ViewMode::perceived || p.state.mode == ViewMode::compare;
    if (!p.state.overlayHidden) {
        if (!asSeen || p.state.tool == Tool::move) drawOptics(marks);
        if (!asSeen) drawBadges(marks);
        drawSelected(marks);
    }
    drawBorderSeams(p, viewport, draw);
    if (p.view.computed.seam && !asSeen && !p.state.overlayHidden) {
        // Where the seam chart is taken, and along which line.
        const SeamProfile& seam = *p.view.computed.seam;
        const ImVec2 at = marks.at(seam.at);
        const auto nx = static_cast<float>(seam.nx) * p.px(18), ny = static_cast<float>(seam.ny) * p.px(18);
        draw.AddLine({at.x - nx, at.y - ny}, {at.x + nx, at.y + ny}, colour::warn, p.px(1.5));
    }
    drawGesture(marks);
    drawCursor(marks, hovered);
}

}  // namespace ilf::ui
