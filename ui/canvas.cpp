#include "ui/canvas.h"

#include <algorithm>
#include <cmath>

#include "core/document/region_at.h"
#include "ui/new_region.h"
#include "ui/widgets.h"

namespace ilf::ui {

namespace {

ImTextureID textureId(const Texture& texture) { return reinterpret_cast<ImTextureID>(texture.id); }

void drawOver(const Viewport& viewport, ImDrawList& draw, const Texture& texture, Size picture, double from = 0.0,
              double to = 1.0, ImU32 tint = rgb(0xffffff)) {
    if (texture.id == 0 || to <= from) return;
    const auto a = viewport.toWindow({from * picture.width, 0}),
               b = viewport.toWindow({to * picture.width, 1.0 * picture.height});
    draw.AddImage(textureId(texture), vec(a), vec(b), vec(from, 0), vec(to, 1), tint);
}

/// A slot's light lies in the projector's raster; a mesh carries it into the picture, since ImGui draws triangles
/// affinely and a homography is not affine.
void drawLight(const Viewport& viewport, ImDrawList& draw, const Texture& light, const Document& document) {
    if (light.id == 0) return;
    const PixelMap map = pixelMap(document);
    const Size raster = document.rig.projector;
    // A scanned map bends; cells that the camera does not see whole show no light.
    const int cells = map.dense() ? 64 : 10;
    const auto onRaster = [&](int i, int j) {
        return Point<ProjectorFrame>{raster.width * static_cast<double>(i) / cells,
                                     raster.height * static_cast<double>(j) / cells};
    };
    const auto at = [&](int i, int j) { return vec(viewport.toWindow(map.toCamera(onRaster(i, j)))); };
    const auto seen = [&](int i, int j) {
        if (!map.dense()) return true;
        const Size scanned = map.dense()->projector();
        const auto pixel = onRaster(i, j);
        return map.seen(std::min(static_cast<int>(pixel.x), scanned.width - 1),
                        std::min(static_cast<int>(pixel.y), scanned.height - 1));
    };
    const auto uv = [&](int i, int j) {
        return ImVec2(static_cast<float>(i) / static_cast<float>(cells),
                      static_cast<float>(j) / static_cast<float>(cells));
    };
    for (int j = 0; j < cells; ++j) {
        for (int i = 0; i < cells; ++i) {
            if (!seen(i, j) || !seen(i + 1, j) || !seen(i, j + 1) || !seen(i + 1, j + 1)) continue;
            draw.AddImageQuad(textureId(light), at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1), uv(i, j),
                              uv(i + 1, j), uv(i + 1, j + 1), uv(i, j + 1));
        }
    }
}

std::optional<std::size_t> imageOfSlot(const Panel& p) {
    const Compiled* compiled = p.view.computed.compiled;
    if (compiled == nullptr) return std::nullopt;
    const auto& slots = compiled->program.imageOfSlot;
    const auto slot = static_cast<std::size_t>(p.state.slot);
    if (slot >= slots.size() || slots[slot] == Program::kDark) return std::nullopt;
    return static_cast<std::size_t>(slots[slot]);
}

void caption(Panel& p, ImDrawList& draw, double x, double y, const std::string& words, ImU32 ink = colour::dim) {
    ImFont* small = font(Font::small);
    const float size = small->FontSize;
    const ImVec2 extent = small->CalcTextSizeA(size, 4096, 0, words.c_str());
    const ImVec2 from = vec(x, y);
    draw.AddRectFilled({from.x - p.px(6), from.y - p.px(3)}, {from.x + extent.x + p.px(6), from.y + extent.y + p.px(3)},
                       rgb(0x101317, 200), p.px(4));
    draw.AddText(small, size, from, ink, words.c_str());
}

void drawEmpty(Panel& p, ImDrawList& draw) {
    const Rect& area = p.at.canvas;
    const char* lines[] = {"No picture yet",
                           "Drop a picture, video or project here, press Ctrl+O, or open a camera on the Scene page."};
    double y = area.y + area.h / 2 - p.scale * 24;
    for (int i = 0; i < 2; ++i) {
        ImFont* face = font(i == 0 ? Font::strong : Font::body);
        const ImVec2 extent = face->CalcTextSizeA(face->FontSize, 4096, 0, lines[i]);
        draw.AddText(face, face->FontSize, vec(area.x + (area.w - static_cast<double>(extent.x)) / 2, y),
                     i == 0 ? colour::text : colour::dim, lines[i]);
        y += p.scale * 26;
    }
}

/// What a perceived view is, and how carefully it was made: nobody may take a coarse one for the truth.
std::string viewCaption(const Panel& p) {
    const State& state = p.state;
    const Computed& computed = p.view.computed;
    std::string words = state.eye == Eye::left ? "perceived, left eye, computed" : "perceived, right eye, computed";
    if (!computed.viewRung.empty()) words += ", " + computed.viewRung;
    if (computed.viewScale < 1.0) {
        words += ", " + std::to_string(std::lround(computed.viewScale * p.document().scene.size().width)) + " px wide";
    }
    if (p.document().wearer.camera) return words;
    if (state.seeing.gaze == Gaze::fixed) words += ", looking at the cross";
    if (state.seeing.gaze == Gaze::follows) words += ", gaze follows";
    return words;
}

/// Where the eye is turned.
void drawGaze(Panel& p, const Viewport& viewport, ImDrawList& draw) {
    if (p.state.seeing.gaze != Gaze::fixed || p.document().wearer.camera) return;
    const ImVec2 at = vec(viewport.toWindow(p.state.seeing.gazeAt));
    const float inner = p.px(4), outer = p.px(12);
    for (const auto& [ink, width] : {std::pair(rgb(0x000000, 150), p.px(3.5)), std::pair(colour::text, p.px(1.5))}) {
        draw.AddLine({at.x - outer, at.y}, {at.x - inner, at.y}, ink, width);
        draw.AddLine({at.x + inner, at.y}, {at.x + outer, at.y}, ink, width);
        draw.AddLine({at.x, at.y - outer}, {at.x, at.y - inner}, ink, width);
        draw.AddLine({at.x, at.y + inner}, {at.x, at.y + outer}, ink, width);
    }
}

/// Mode colours the frame of the picture.
ImU32 frameColour(const View& view) {
    if (!view.core.faultSeen && !view.core.lastFault.empty()) return colour::fault;
    if (view.core.connected && view.core.light == Light::steady) return colour::safe;
    if (view.liveTake) return colour::warn;
    return colour::line;
}

}  // namespace

const Document& shown(const Panel& p) { return p.view.follow.shown != nullptr ? *p.view.follow.shown : p.document(); }

Metre markDistance(const Panel& p) {
    if (const RegionPlan* planned = p.planOf(p.state.selected)) return planned->nearest;
    if (const Region* region = p.selected()) {
        if (const auto* constant = std::get_if<ConstantDistance>(&region->distance)) return constant->value;
    }
    if (const Plan* plan = p.plan()) {
        for (const RegionPlan& region : plan->regions) {
            if (region.look == Look::focus) return region.nearest;
        }
    }
    return 1.0_m;
}

std::optional<Distance> scaled(const Distance& distance, double ratio) {
    const auto kept = [](Metre value) { return std::clamp(value, kNearestTyped, kFarthestTyped); };
    if (const auto* constant = std::get_if<ConstantDistance>(&distance)) {
        ConstantDistance moved = *constant;
        moved.value = kept(constant->value * ratio);
        return moved;
    }
    if (const auto* plane = std::get_if<PlaneDistance>(&distance)) {
        PlaneDistance moved = *plane;
        for (DistanceAnchor& anchor : moved.anchors)
            anchor.distance = kept(anchor.distance * ratio);
        return moved;
    }
    return std::nullopt;
}

std::vector<Badge> badges(const Panel& p, const Viewport& viewport) {
    std::vector<Badge> placed;
    const double wide = 84 * p.scale, high = 25 * p.scale;
    const Size size = p.document().scene.size();
    for (const Region* region : activeRegions(p.document())) {
        const PixelRect<CameraFrame> covered = region->mask.coveredPixels().clipped(size);
        if (covered.empty()) continue;
        const auto middle = motionOf(p, region->id)(
            Point<CameraFrame>{(covered.x0 + covered.x1) / 2.0, (covered.y0 + covered.y1) / 2.0});
        if (!(middle.x >= 0.0 && middle.y >= 0.0 && middle.x <= size.width && middle.y <= size.height)) continue;
        Badge badge{region, viewport.toWindow(middle)};
        // Every move clears at least one of those placed before, so as many rounds as there are badges suffice.
        for (std::size_t round = 0; round < placed.size(); ++round) {
            for (const Badge& other : placed) {
                const bool hides = std::abs(badge.at.x - other.at.x) < wide && std::abs(badge.at.y - other.at.y) < high;
                if (hides) badge.at.y = other.at.y + high;
            }
        }
        placed.push_back(badge);
    }
    return placed;
}

void zoomTo(State& state, double zoom) {
    state.fitted = false;
    state.zoom = std::clamp(zoom, kMinZoom, kMaxZoom);
}

void lookAt(State& state, const Document& document, Point<CameraFrame> at) {
    const Region* region = regionAt(document, at);
    state.seeing.gaze = Gaze::fixed;
    state.seeing.gazeAt = at;
    state.seeing.attending = region != nullptr     ? std::optional(region->id)
                             : document.background ? std::optional(kBackgroundId)
                                                   : std::nullopt;
    state.placingGaze = false;
}

Viewport viewportOf(const Panel& p) {
    if (p.state.fitted) return fitted(p.at.canvas, p.document().scene.size());
    return {p.at.canvas, p.state.zoom, p.state.centre};
}

void drawPictures(Panel& p, const Viewport& viewport, ImDrawList& draw) {
    const Document& document = p.document();
    const Size size = document.scene.size();
    const View& view = p.view;
    const State& state = p.state;
    const Texture& ground = view.camera.live && view.live.id != 0 ? view.live : view.scene;
    const Texture& seen = view.perceived[state.eye == Eye::left ? 0 : 1];
    const Texture& plain = view.plain.id != 0 ? view.plain : view.scene;
    const double left = p.at.canvas.x + 14 * p.scale, top = p.at.canvas.y + 12 * p.scale;
    const auto missing = [&] {
        const std::string why = view.computed.planError.empty() ? "working it out ..." : view.computed.planError;
        caption(p, draw, left, top, why, view.computed.planError.empty() ? colour::dim : colour::fault);
    };
    switch (state.mode) {
    case ViewMode::scene:
        drawOver(viewport, draw, state.plainHeld ? plain : ground, size);
        break;
    case ViewMode::perceived:
        if (state.plainHeld || seen.id == 0) drawOver(viewport, draw, plain, size);
        if (!state.plainHeld) drawOver(viewport, draw, seen, size);
        if (!state.plainHeld && seen.id == 0) return missing();
        caption(p, draw, left, top, state.plainHeld ? "plain view" : viewCaption(p));
        break;
    case ViewMode::light: {
        drawOver(viewport, draw, ground, size, 0, 1, rgb(0x303030));
        const auto image = imageOfSlot(p);
        if (image && *image < view.lights.size()) drawLight(viewport, draw, view.lights[*image], document);
        if (!image && view.computed.compiled == nullptr) return missing();
        caption(p, draw, left, top, "slot " + std::to_string(state.slot) + (image ? ", projector light" : ", dark"));
        break;
    }
    case ViewMode::compare: {
        const auto edge = viewport.toPicture({p.at.canvas.x + state.divider * p.at.canvas.w, 0});
        const double at = size.width > 0 ? std::clamp(edge.x / size.width, 0.0, 1.0) : 0.0;
        drawOver(viewport, draw, plain, size, 0, state.plainHeld || seen.id == 0 ? 1.0 : at);
        if (!state.plainHeld) drawOver(viewport, draw, seen, size, at, 1);
        const double x = std::round(p.at.canvas.x + state.divider * p.at.canvas.w);
        draw.AddLine(vec(x, p.at.canvas.y), vec(x, p.at.canvas.bottom()), rgb(0xffffff, 150), p.px(1.5));
        draw.AddCircleFilled(vec(x, p.at.canvas.y + p.at.canvas.h / 2), p.px(8), rgb(0xffffff, 200));
        caption(p, draw, left, top, "plain");
        caption(p, draw, x + 14 * p.scale, top, viewCaption(p));
        break;
    }
    }
    // Perceived views and light are looked at for their own pixels; while painting, the marks come back.
    const bool pictureOnly = state.mode != ViewMode::scene;
    const bool painting = state.gesture.kind == CanvasGesture::Kind::paint;
    if (!state.overlayHidden && (!pictureOnly || painting)) drawOver(viewport, draw, view.overlay, size);
    const bool seenByAnEye = (state.mode == ViewMode::perceived || state.mode == ViewMode::compare) && !state.plainHeld;
    if (seenByAnEye && !state.overlayHidden) drawGaze(p, viewport, draw);
    if (state.placingGaze) {
        caption(p, draw, left, p.at.canvas.bottom() - 30 * p.scale, "click what is looked at, Esc to leave it",
                colour::warn);
    }
    if (view.busySelecting)
        caption(p, draw, left, p.at.canvas.bottom() - 30 * p.scale, "finding the outline ...", colour::warn);
    if (view.camera.frozen) {
        caption(p, draw, left, p.at.canvas.bottom() - 30 * p.scale, "the camera's picture stands still", colour::fault);
    }
}

void canvas(Panel& p) {
    const Rect& area = p.at.canvas;
    beginPanel("###canvas", area, colour::ground, false);
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    ImGui::InvisibleButton("###picture", vec(std::max(1.0, area.w), std::max(1.0, area.h)),
                           ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonRight |
                               ImGuiButtonFlags_MouseButtonMiddle);
    const bool hovered = ImGui::IsItemHovered(), activated = ImGui::IsItemActivated();

    const bool empty = !p.document().scene.picture;
    if (empty) {
        drawEmpty(p, draw);
    } else {
        Viewport viewport = viewportOf(p);
        const float wheel = ImGui::GetIO().MouseWheel;
        if (hovered && wheel != 0.0f) {
            const ImVec2 at = ImGui::GetMousePos();
            viewport = zoomedAbout(viewport, {at.x, at.y}, std::pow(1.15, static_cast<double>(wheel)));
            p.state.fitted = false;
        }
        p.state.zoom = viewport.zoom;
        p.state.centre = viewport.centre;
        canvasGestures(p, viewport, hovered, activated);
        viewport = viewportOf(p);  // a pan may have moved it
        draw.PushClipRect(vec(area.x, area.y), vec(area.right(), area.bottom()), true);
        drawPictures(p, viewport, draw);
        drawMarks(p, viewport, draw, hovered);
        draw.PopClipRect();
    }
    const ImU32 frame = frameColour(p.view);
    const float width = frame == colour::line ? 1.0f : p.px(2);
    draw.AddRect(vec(area.x + 0.5, area.y + 0.5), vec(area.right() - 0.5, area.bottom() - 0.5), frame, 0, 0, width);
    ImGui::End();
}

void canvasHeader(Panel& p) {
    beginPanel("###header", p.at.header, colour::ground, false);
    State& state = p.state;
    const float gap = p.px(12), height = ImGui::GetFrameHeight();
    ImGui::SetCursorPos({p.px(10), (static_cast<float>(p.at.header.h) - height) / 2});
    if (const auto picked =
            choice("###views", {"Scene", "Perceived", "Light", "Compare"}, static_cast<int>(state.mode), p.px(320))) {
        state.mode = static_cast<ViewMode>(*picked);
    }
    if (state.mode == ViewMode::perceived || state.mode == ViewMode::compare) {
        ImGui::SameLine(0, gap);
        if (const auto eye = choice("###eyes", {"L", "R"}, state.eye == Eye::left ? 0 : 1, p.px(72))) {
            state.eye = *eye == 0 ? Eye::left : Eye::right;
        }
    }
    const Plan* plan = p.plan();
    if (state.mode == ViewMode::light && plan != nullptr && !plan->slots.empty()) {
        ImGui::SameLine(0, gap);
        const int slots = static_cast<int>(plan->slots.size());
        state.slot = std::clamp(state.slot, 0, slots - 1);
        const float each =
            std::min(p.px(22), (static_cast<float>(p.at.header.w) - p.px(560)) / static_cast<float>(slots));
        ImDrawList& draw = *ImGui::GetWindowDrawList();
        for (int i = 0; i < slots && each > 4; ++i) {
            const auto level = plan->slots[static_cast<std::size_t>(i)].level();
            const ImU32 ink = !level                                                                    ? colour::dim
                              : plan->levels[static_cast<std::size_t>(*level)].kind == LevelKind::focus ? colour::focus
                                                                                                        : colour::blur;
            if (i > 0) ImGui::SameLine(0, 0);
            ImGui::PushID(i);
            if (ImGui::InvisibleButton("###slot", {each, height})) state.slot = i;
            tooltip("Slot " + std::to_string(i));
            ImGui::PopID();
            const ImVec2 a = ImGui::GetItemRectMin(), b = ImGui::GetItemRectMax();
            const bool on = i == state.slot;
            const float inset = on ? p.px(2) : p.px(7);
            draw.AddRectFilled({a.x + 1, a.y + inset}, {b.x - 1, b.y - inset},
                               faded(ink, on      ? 1.0
                                          : level ? 0.55
                                                  : 0.25),
                               2);
        }
    }
    const std::string percent = std::to_string(static_cast<int>(std::lround(state.zoom * 100 / p.scale))) + " %";
    const float right = static_cast<float>(p.at.header.w) - p.px(10);
    ImGui::SameLine(right - p.px(150));
    if (ImGui::Button("Fit###fit", {p.px(44), 0})) p.run(Command::fit);
    commandTooltip(Command::fit);
    ImGui::SameLine(0, p.px(6));
    if (ImGui::Button("1:1###actual", {p.px(44), 0})) p.run(Command::actualSize);
    commandTooltip(Command::actualSize);
    ImGui::SameLine(0, p.px(8));
    ImGui::AlignTextToFramePadding();
    text(percent, colour::dim);
    ImGui::End();
}

}  // namespace ilf::ui
