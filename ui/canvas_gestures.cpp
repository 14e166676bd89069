// Presses, drags and releases on the canvas become edits, by the tool in hand.
#include <algorithm>
#include <cmath>

#include "core/document/region_at.h"
#include "ui/canvas.h"
#include "ui/new_region.h"

namespace ilf::ui {

namespace {

using Kind = CanvasGesture::Kind;

double apart(Point<WidgetFrame> a, Point<WidgetFrame> b) { return std::hypot(a.x - b.x, a.y - b.y); }

/// The region that is painted on: the selected one, or a new one.
RegionId paintTarget(const View& view, State& state, Requests& requests) {
    const Region* region = findRegion(view.document, state.selected);
    if (region != nullptr && region->id != kBackgroundId) return region->id;
    Region fresh = newRegion(view.document);
    state.selected = fresh.id;
    requests.push_back(EditRequest{EditRequest::When::commit, AddRegion{std::move(fresh), 0}});
    return state.selected;
}

PaintMode shapeMode() { return ImGui::GetIO().KeyAlt ? PaintMode::erase : PaintMode::add; }

/// A point of the canvas where the region is painted.
Point<CameraFrame> paintedAt(const Panel& p, const RegionId& region, Point<CameraFrame> at) {
    return motionOf(p, region).inverted()(at);
}

/// Strokes land on the thing as it is shown: dabs go back the way that it moved, and are as large on it as the ring.
/// `gesture.now` is where it is painted, so that a stroke on a thing that moves meanwhile has no gaps on the thing.
void paintTo(Panel& p, Point<CameraFrame> to) {
    CanvasGesture& gesture = p.state.gesture;
    const bool erasing = p.state.tool == Tool::erase;
    Brush brush = erasing ? p.state.eraser : p.state.brush;
    if (const Motion motion = motionOf(p, gesture.region); motion != Motion{}) {
        const Motion back = motion.inverted();
        brush.radius = std::clamp(brush.radius * scaleAt(back, to), 0.5, 2000.0);
        to = back(to);
    }
    std::vector<Dab> dabs = spacedDabs(gesture.now, to, brush, gesture.carry);
    gesture.now = to;
    if (dabs.empty()) return;
    // One preview a frame: the dabs of all samples join the last request when it is ours.
    if (!p.requests.empty()) {
        if (auto* last = std::get_if<EditRequest>(&p.requests.back())) {
            auto* paint = std::get_if<Paint>(&last->edit);
            if (paint != nullptr && last->when == EditRequest::When::preview && paint->region == gesture.region) {
                paint->dabs.insert(paint->dabs.end(), dabs.begin(), dabs.end());
                return;
            }
        }
    }
    p.preview(
        Paint{gesture.region, std::move(dabs), erasing ? PaintMode::erase : PaintMode::add, p.state.protectOthers});
    gesture.edited = true;
}

/// Middle of the edge after vertex `i`: a handle that becomes a vertex.
Point<CameraFrame> edgeMiddle(const Outline& outline, std::size_t i) {
    const auto& a = outline.vertices[i];
    const auto& b = outline.vertices[(i + 1) % outline.vertices.size()];
    return {(a.x + b.x) / 2, (a.y + b.y) / 2};
}

/// From now on the pointer scrubs the distance of a region.
bool beginDistance(Panel& p, const RegionId& id) {
    const Region* region = findRegion(p.document(), id);  // as painted: a plane's points go along with what follows
    if (region == nullptr) return false;
    p.state.selected = id;
    p.state.gesture.kind = Kind::distance;
    p.state.gesture.region = id;
    p.state.gesture.original = region->distance;
    return true;
}

/// Takes hold of a vertex, an edge's middle, an anchor, a centre or a badge under the pointer.
bool takeHandle(Panel& p, const Viewport& viewport, Point<WidgetFrame> at) {
    const double reach = kReach * p.scale;
    CanvasGesture& gesture = p.state.gesture;
    const auto near = [&](Point<CameraFrame> mark) { return apart(viewport.toWindow(mark), at) <= reach; };
    const Region* region = p.selected();
    const Motion motion = region != nullptr ? motionOf(p, region->id) : Motion{};
    if (region != nullptr && region->outline && (p.state.tool == Tool::move || p.state.tool == Tool::polygon)) {
        const Outline& outline = *region->outline;
        for (std::size_t i = 0; i < outline.vertices.size(); ++i) {
            if (!near(motion(outline.vertices[i]))) continue;
            gesture.kind = Kind::moveVertex;
            gesture.region = region->id;
            gesture.index = i;
            gesture.points = outline.vertices;
            return true;
        }
        for (std::size_t i = 0; i < outline.vertices.size(); ++i) {
            const Point<CameraFrame> middle = edgeMiddle(outline, i);
            if (!near(motion(middle))) continue;
            gesture.kind = Kind::moveVertex;
            gesture.region = region->id;
            gesture.index = i + 1;
            gesture.points = outline.vertices;
            gesture.points.insert(gesture.points.begin() + static_cast<std::ptrdiff_t>(i) + 1, middle);
            return true;
        }
    }
    if (p.state.tool != Tool::move) return false;
    if (region != nullptr) {
        if (const auto* plane = std::get_if<PlaneDistance>(&region->distance)) {
            for (std::size_t i = 0; i < plane->anchors.size(); ++i) {
                if (!near(motion(plane->anchors[i].at))) continue;
                gesture.kind = Kind::moveAnchor;
                gesture.region = region->id;
                gesture.index = i;
                gesture.original = region->distance;
                return true;
            }
        }
    }
    for (const Eye eye : {Eye::left, Eye::right}) {
        if (!near(opticalCentre(p.document(), eye, markDistance(p)))) continue;
        gesture.kind = Kind::moveAxis;
        gesture.index = eye == Eye::left ? 0 : 1;
        return true;
    }
    for (const auto& [marked, badge] : badges(p, viewport)) {
        if (std::abs(badge.x - at.x) > 34 * p.scale || std::abs(badge.y - at.y) > 12 * p.scale) continue;
        return beginDistance(p, marked->id);
    }
    return false;
}

void rightClick(Panel& p, const Viewport& viewport, Point<WidgetFrame> at) {
    if (!p.state.polygon.empty()) {
        p.state.polygon.pop_back();
        return;
    }
    const Region* region = p.selected();
    if (region == nullptr || !region->outline || region->outline->vertices.size() <= 3) return;
    Outline outline = *region->outline;
    const Motion motion = motionOf(p, region->id);
    for (std::size_t i = 0; i < outline.vertices.size(); ++i) {
        if (apart(viewport.toWindow(motion(outline.vertices[i])), at) > kReach * p.scale) continue;
        outline.vertices.erase(outline.vertices.begin() + static_cast<std::ptrdiff_t>(i));
        p.commit(SetOutline{region->id, std::move(outline)});
        return;
    }
}

void scrubDistance(Panel& p) {
    CanvasGesture& gesture = p.state.gesture;
    const double fine = ImGui::GetIO().KeyShift ? 0.1 : 1.0;
    // Up is farther; 140 pixels are a factor of two.
    const double ratio = std::exp2((gesture.startAt.y - gesture.lastAt.y) * fine / (140.0 * p.scale));
    const auto distance = scaled(gesture.original, ratio);
    if (!distance) {
        say(p.state,
            "This region's distance comes from the depth map. Choose \"constant\" or \"plane\" to set it here.",
            Tone::warning, p.view.time_s);
        gesture = {};
        return;
    }
    p.preview(SetDistance{gesture.region, *distance});
    gesture.edited = true;
}

void begin(Panel& p, const Viewport& viewport, const PointerSample& sample) {
    State& state = p.state;
    CanvasGesture& gesture = state.gesture;
    gesture = {};
    gesture.button = sample.left ? 0 : sample.right ? 1 : 2;
    gesture.startAt = gesture.lastAt = sample.at;
    const Point<CameraFrame> at = viewport.toPicture(sample.at);
    gesture.start = gesture.now = at;

    if (gesture.button == 2 || state.panHeld) {
        gesture.kind = Kind::pan;
        return;
    }
    if (gesture.button == 1) return rightClick(p, viewport, sample.at);
    if (state.placingGaze) return lookAt(state, shown(p), at);
    if (state.mode == ViewMode::compare &&
        std::abs(sample.at.x - (p.at.canvas.x + state.divider * p.at.canvas.w)) <= kReach * p.scale) {
        gesture.kind = Kind::divider;
        return;
    }
    if (state.distanceHeld) {
        const Region* region = regionAt(shown(p), at);
        if (region == nullptr) region = p.selected();
        if (region == nullptr) return;
        state.distanceDragged = beginDistance(p, region->id);
        return;
    }
    if (takeHandle(p, viewport, sample.at)) return;
    switch (state.tool) {
    case Tool::move: {
        const Region* region = regionAt(shown(p), at);
        state.selected = region != nullptr ? region->id : kBackgroundId;
        return;
    }
    case Tool::brush:
    case Tool::erase:
        gesture.region = paintTarget(p.view, state, p.requests);
        gesture.kind = Kind::paint;
        state.hintsUsed.insert(Hint::brush);
        if (ImGui::GetIO().KeyShift && state.lastPoint) gesture.now = *state.lastPoint;
        gesture.now = paintedAt(p, gesture.region, gesture.now);
        return paintTo(p, at);
    case Tool::rectangle:
    case Tool::ellipse:
        gesture.kind = Kind::drawShape;
        return;
    case Tool::lasso:
        gesture.kind = Kind::drawLasso;
        gesture.points = {at};
        return;
    case Tool::select:
        gesture.kind = Kind::drawBox;
        return;
    case Tool::flood: {
        const RegionId region = paintTarget(p.view, state, p.requests);
        p.requests.push_back(SelectFlood{region, paintedAt(p, region, at),
                                         state.floodByDepth ? state.surfaceTolerance : state.floodTolerance,
                                         state.floodByDepth});
        return;
    }
    case Tool::polygon: {
        const bool closes =
            state.polygon.size() >= 3 && apart(viewport.toWindow(state.polygon.front()), sample.at) <= kReach * p.scale;
        if (closes || ImGui::GetMouseClickedCount(ImGuiMouseButton_Left) == 2) {
            return finishPolygon(p.view, state, p.requests);
        }
        state.polygon.push_back(at);
        return;
    }
    }
}

void go(Panel& p, const Viewport& viewport, const PointerSample& sample) {
    State& state = p.state;
    CanvasGesture& gesture = state.gesture;
    const Point<CameraFrame> at = viewport.toPicture(sample.at);
    const Point<WidgetFrame> before = gesture.lastAt;
    if (apart(before, sample.at) == 0.0) return;
    gesture.lastAt = sample.at;
    switch (gesture.kind) {
    case Kind::none:
        return;
    case Kind::pan:
        state.fitted = false;
        state.centre = {state.centre.x - (sample.at.x - before.x) / viewport.zoom,
                        state.centre.y - (sample.at.y - before.y) / viewport.zoom};
        return;
    case Kind::paint:
        return paintTo(p, at);
    case Kind::drawLasso:
        // Two pixels apart is as fine as a hand draws.
        if (apart(before, sample.at) >= 1.0) gesture.points.push_back(at);
        gesture.now = at;
        return;
    case Kind::drawShape:
    case Kind::drawBox:
        gesture.now = at;
        return;
    case Kind::moveVertex:
        gesture.points[gesture.index] = paintedAt(p, gesture.region, at);
        p.preview(SetOutline{gesture.region, Outline{gesture.points}});
        gesture.edited = true;
        return;
    case Kind::moveAnchor: {
        auto plane = std::get<PlaneDistance>(gesture.original);
        plane.anchors[gesture.index].at = paintedAt(p, gesture.region, at);
        p.preview(SetDistance{gesture.region, plane});
        gesture.edited = true;
        return;
    }
    case Kind::moveAxis: {
        Wearer wearer = p.document().wearer;
        const Point<CameraFrame> axis = cameraAxis(p.document());
        const double perMetre = pixelsPerMetre(p.document(), markDistance(p));
        wearer.axes[gesture.index] = {Metre::fromSi((at.x - axis.x) / perMetre),
                                      Metre::fromSi((at.y - axis.y) / perMetre)};
        p.preview(SetWearer{wearer});
        gesture.edited = true;
        return;
    }
    case Kind::distance:
        return scrubDistance(p);
    case Kind::divider:
        state.divider = std::clamp((sample.at.x - p.at.canvas.x) / p.at.canvas.w, 0.02, 0.98);
        return;
    }
}

Shape drawnShape(const State& state) {
    const CanvasGesture& gesture = state.gesture;
    if (gesture.kind == Kind::drawLasso) return Outline{gesture.points};
    if (state.tool == Tool::ellipse) return Ellipse{gesture.start, gesture.now};
    return Rectangle{gesture.start, gesture.now};
}

void finish(Panel& p) {
    State& state = p.state;
    // The gesture is over whatever follows: the copy lives on for its last request.
    const CanvasGesture gesture = state.gesture;
    const double way = apart(gesture.startAt, gesture.lastAt);
    switch (gesture.kind) {
    case Kind::none:
    case Kind::pan:
    case Kind::divider:
        break;
    case Kind::paint:
        state.lastPoint = motionOf(p, gesture.region)(gesture.now);
        if (gesture.edited) p.requests.push_back(CommitGesture{state.tool == Tool::erase ? "Erase" : "Paint"});
        break;
    case Kind::drawShape:
    case Kind::drawLasso: {
        if (way < 2.0 && gesture.points.size() < 3) break;
        const RegionId region = paintTarget(p.view, state, p.requests);
        p.commit(
            FillShape{region, asPainted(drawnShape(state), motionOf(p, region)), shapeMode(), state.protectOthers});
        state.hintsUsed.insert(Hint::brush);
        break;
    }
    case Kind::drawBox: {
        const RegionId region = paintTarget(p.view, state, p.requests);
        const auto &a = gesture.start, &b = gesture.now;
        const Motion back = motionOf(p, region).inverted();
        const PixelRect<CameraFrame> box = boxAround(moved(Quad{a, {b.x, a.y}, b, {a.x, b.y}}, back));
        p.requests.push_back(SelectObject{region, box.clipped(p.document().scene.size())});
        break;
    }
    case Kind::moveVertex:
    case Kind::moveAnchor:
    case Kind::moveAxis:
    case Kind::distance:
        if (!gesture.edited) break;
        if (gesture.kind == Kind::distance) state.hintsUsed.insert(Hint::distance);
        p.requests.push_back(CommitGesture{gesture.kind == Kind::moveVertex ? "Move vertex"
                                           : gesture.kind == Kind::moveAxis ? "Move optical centre"
                                                                            : "Set distance"});
        break;
    }
    state.gesture = {};
}

bool isDown(const PointerSample& sample, int button) {
    return button == 0 ? sample.left : button == 1 ? sample.right : sample.middle;
}

}  // namespace

void finishPolygon(const View& view, State& state, Requests& requests) {
    std::vector<Point<CameraFrame>> vertices = std::move(state.polygon);
    state.polygon.clear();
    if (vertices.size() < 3) {
        say(state, "A polygon needs at least three vertices.", Tone::warning, view.time_s);
        return;
    }
    const Region* region = findRegion(view.document, state.selected);
    const bool blank = region == nullptr || region->id == kBackgroundId || region->mask.blank();
    const RegionId target = paintTarget(view, state, requests);
    Outline outline = std::get<Outline>(asPainted(Outline{std::move(vertices)}, motionOf(view.follow, target)));
    // On an empty region the outline stays editable; on a painted one it joins the paint.
    Edit edit = blank ? Edit(SetOutline{target, std::move(outline)})
                      : Edit(FillShape{target, Shape(std::move(outline)), shapeMode(), state.protectOthers});
    requests.push_back(EditRequest{EditRequest::When::commit, std::move(edit)});
    state.hintsUsed.insert(Hint::brush);
}

void canvasGestures(Panel& p, const Viewport& viewport, bool hovered, bool activated) {
    State& state = p.state;
    const ImGuiIO& io = ImGui::GetIO();
    std::vector<PointerSample> trail = p.input.trail;
    if (trail.empty()) {
        trail.push_back(
            {{io.MousePos.x, io.MousePos.y}, p.view.time_s, io.MouseDown[0], io.MouseDown[2], io.MouseDown[1]});
    }
    bool waiting = activated && state.gesture.kind == Kind::none;
    if (waiting) {
        // A click so short that every sample came before it or after it: the press is where the pointer is.
        const auto pressed = [](const PointerSample& s) { return s.left || s.middle || s.right; };
        if (std::none_of(trail.begin(), trail.end(), pressed)) {
            PointerSample press = trail.back();
            press.left = io.MouseDown[0], press.right = io.MouseDown[1], press.middle = io.MouseDown[2];
            if (pressed(press)) trail.insert(trail.end() - 1, press);
        }
    }
    for (const PointerSample& sample : trail) {
        if (waiting && (sample.left || sample.middle || sample.right)) {
            waiting = false;
            begin(p, viewport, sample);
        } else if (state.gesture.kind != Kind::none) {
            if (isDown(sample, state.gesture.button)) {
                go(p, viewport, sample);
            } else {
                go(p, viewport, sample);
                finish(p);
            }
        }
    }
    const Point<CameraFrame> now = viewport.toPicture(trail.back().at);
    const Size size = p.document().scene.size();
    const bool inside = now.x >= 0 && now.y >= 0 && now.x < size.width && now.y < size.height;
    state.cursor = (hovered || state.gesture.kind != Kind::none) && inside ? std::optional(now) : std::nullopt;
}

}  // namespace ilf::ui
