// Keys, menus and buttons meet here: what each command does.
#include <imgui.h>

#include <algorithm>
#include <random>

#include "core/document/region_at.h"
#include "ui/canvas.h"
#include "ui/keys.h"
#include "ui/new_region.h"
#include "ui/panel.h"

namespace ilf::ui {

namespace {

void cancelGesture(State& state, Requests& requests) {
    if (state.gesture.edited) requests.push_back(CancelGesture{});
    state.gesture = {};
    state.polygon.clear();
    state.placingGaze = false;
}

/// The region's place in the list, if it is one that can be moved and painted.
std::optional<int> placeOf(const Document& document, const RegionId& id) {
    for (std::size_t i = 0; i < document.regions.size(); ++i) {
        if (document.regions[i]->id == id) return static_cast<int>(i);
    }
    return std::nullopt;
}

void runRegion(Command command, const View& view, State& state, Requests& requests) {
    const Document& document = view.document;
    const Region* region = findRegion(document, state.selected);
    const auto commit = [&](Edit edit) { requests.push_back(EditRequest{EditRequest::When::commit, std::move(edit)}); };
    if (command == Command::addRegion) {
        Region fresh = newRegion(document);
        state.selected = fresh.id;
        commit(AddRegion{std::move(fresh), 0});
        return;
    }
    if (region == nullptr) return;
    const RegionId id = region->id;
    const auto place = placeOf(document, id);
    switch (command) {
    case Command::lookFocus:
        commit(SetLook{id, Look::focus});
        return;
    case Command::lookBlur:
        commit(SetLook{id, Look::blur});
        return;
    case Command::lookNeutral:
        commit(SetLook{id, Look::neutral});
        return;
    case Command::swapLook: {
        const Region* under = state.cursor ? regionAt(document, *state.cursor) : region;
        if (under == nullptr || under->id == kBackgroundId) under = region;
        if (under->look == Look::neutral) return;
        commit(SetLook{under->id, under->look == Look::focus ? Look::blur : Look::focus});
        return;
    }
    case Command::editDistance:
        state.focusDistance = true;
        return;
    default:
        break;
    }
    if (!place) return;  // the background has look and distance, nothing else
    switch (command) {
    case Command::duplicateRegion: {
        const RegionId copy = newRegionId();
        commit(DuplicateRegion{id, copy});
        state.selected = copy;
        return;
    }
    case Command::renameRegion:
        state.renaming = id;
        state.nameText = region->name;
        state.nameJustOpened = true;
        return;
    case Command::deleteRegion: {
        commit(RemoveRegion{id});
        const auto next = static_cast<std::size_t>(*place) + 1;
        state.selected = next < document.regions.size() ? document.regions[next]->id
                         : *place > 0                   ? document.regions[static_cast<std::size_t>(*place) - 1]->id
                                                        : kBackgroundId;
        return;
    }
    case Command::regionUp:
        if (*place > 0) commit(MoveRegion{id, *place - 1});
        return;
    case Command::regionDown:
        if (*place + 1 < static_cast<int>(document.regions.size())) commit(MoveRegion{id, *place + 1});
        return;
    case Command::hideRegion:
        commit(SetVisible{id, !region->visible});
        return;
    case Command::lockRegion:
        commit(SetLocked{id, !region->locked});
        return;
    case Command::soloRegion:
        commit(SetSolo{id, !region->solo});
        return;
    case Command::growRegion:
        commit(GrowMask{id, kGrowStep});
        return;
    case Command::shrinkRegion:
        commit(GrowMask{id, -kGrowStep});
        return;
    case Command::invertRegion:
        commit(InvertMask{id});
        return;
    default:
        return;
    }
}

void pick(State& state, Tool tool, Requests& requests) {
    if (tool != Tool::polygon || state.gesture.kind != CanvasGesture::Kind::none) cancelGesture(state, requests);
    state.tool = tool;
}

void resize(State& state, double factor) {
    Brush& brush = state.tool == Tool::erase ? state.eraser : state.brush;
    brush.radius = std::clamp(brush.radius * factor, 0.5, 1000.0);
}

void harden(State& state, double by) {
    Brush& brush = state.tool == Tool::erase ? state.eraser : state.brush;
    brush.hardness = std::clamp(brush.hardness + by, 0.0, 1.0);
}

}  // namespace

RegionId newRegionId() {
    // A random UUID (version 4): ids stay unique through undo, copies and merged projects.
    std::random_device random;
    static constexpr char digits[] = "0123456789abcdef";
    RegionId id = "xxxxxxxx-xxxx-4xxx-yxxx-xxxxxxxxxxxx";
    for (char& c : id) {
        const unsigned bits = random() & 15U;
        if (c == 'x') c = digits[bits];
        if (c == 'y') c = digits[(bits & 3U) | 8U];
    }
    return id;
}

Region newRegion(const Document& document) {
    Region region;
    region.id = newRegionId();
    for (std::size_t number = document.regions.size() + 1;; ++number) {
        region.name = "Region " + std::to_string(number);
        const auto taken = [&](const Box<Region>& other) { return other->name == region.name; };
        if (std::none_of(document.regions.begin(), document.regions.end(), taken)) break;
    }
    region.look = Look::blur;
    return region;
}

const RegionPlan* Panel::planOf(const RegionId& id) const {
    if (const Plan* whole = plan()) {
        for (const RegionPlan& region : whole->regions) {
            if (region.id == id) return &region;
        }
    }
    return nullptr;
}

void Panel::run(Command command) { ui::run(command, view, state, requests); }

bool doneByApp(Command command) {
    switch (command) {
    case Command::newProject:
    case Command::save:
    case Command::reopenLast:
    case Command::quit:
    case Command::undo:
    case Command::redo:
    case Command::grab:
    case Command::openCamera:
    case Command::closeCamera:
    case Command::lockCamera:
    case Command::toggleLive:
    case Command::take:
    case Command::liveTake:
    case Command::safeLight:
    case Command::fullScreen:
        return true;
    default:
        return false;
    }
}

std::string whyNot(Command command, const View& view, const State& state) {
    const Region* region = findRegion(view.document, state.selected);
    const bool painted = region != nullptr && region->id != kBackgroundId;
    switch (command) {
    case Command::undo:
        return view.undoLabel.empty() && !view.previewing ? "Nothing to undo." : "";
    case Command::redo:
        return view.redoLabel.empty() ? "Nothing to redo." : "";
    case Command::reopenLast:
        return view.recent.empty() ? "No project was open before." : "";
    case Command::grab:
        return !view.camera.open ? "No camera is open: choose one on the Scene page." : "";
    case Command::closeCamera:
    case Command::lockCamera:
    case Command::toggleLive:
        return !view.camera.open ? "No camera is open." : "";
    case Command::openCamera:
        return view.cameras.empty() ? "No camera was found." : "";
    case Command::take:
        if (view.registering && view.registering->patterns())
            return "The projector shows patterns for the registration: cancel that first.";
        return !view.core.connected ? "The output core is not connected." : "";
    case Command::registerCamera:
        return view.registering ? "The page is open." : view.measuring ? "A rig is being measured." : "";
    case Command::acknowledgeFault:
        return view.core.lastFault.empty() ? "No fault." : "";
    case Command::duplicateRegion:
    case Command::renameRegion:
    case Command::deleteRegion:
    case Command::regionUp:
    case Command::regionDown:
    case Command::hideRegion:
    case Command::lockRegion:
    case Command::soloRegion:
    case Command::growRegion:
    case Command::shrinkRegion:
    case Command::invertRegion:
        return !painted ? "Select a region first." : "";
    case Command::lookFocus:
    case Command::lookBlur:
    case Command::lookNeutral:
    case Command::swapLook:
    case Command::editDistance:
        return region == nullptr ? "Select a region first." : "";
    case Command::finishShape:
    case Command::removeVertex:
        return state.polygon.empty() ? "No polygon is being drawn." : "";
    default:
        return "";
    }
}

void run(Command command, const View& view, State& state, Requests& requests) {
    if (!whyNot(command, view, state).empty()) {
        if (command == Command::take || command == Command::grab) {
            say(state, whyNot(command, view, state), Tone::warning, view.time_s);
        }
        return;
    }
    switch (command) {
    case Command::open:
        openFileDialog(state, FileDialog::Purpose::open, view);
        return;
    case Command::openScene:
        openFileDialog(state, FileDialog::Purpose::openScene, view);
        return;
    case Command::saveAs:
        openFileDialog(state, FileDialog::Purpose::saveAs, view);
        return;
    case Command::exportView:
        openFileDialog(state, FileDialog::Purpose::exportView, view);
        return;
    case Command::save:
        if (view.fileName.empty()) {
            openFileDialog(state, FileDialog::Purpose::saveAs, view);
            return;
        }
        break;
    case Command::acknowledgeFault:
        requests.push_back(AcknowledgeFault{});
        return;
    case Command::registerCamera:
        requests.push_back(Register{Register::Step::open});
        return;
    case Command::toolMove:
        pick(state, Tool::move, requests);
        return;
    case Command::toolBrush:
        pick(state, Tool::brush, requests);
        return;
    case Command::toolErase:
        pick(state, state.tool == Tool::erase ? Tool::brush : Tool::erase, requests);
        return;
    case Command::toolRectangle:
        pick(state, Tool::rectangle, requests);
        return;
    case Command::toolEllipse:
        pick(state, Tool::ellipse, requests);
        return;
    case Command::toolPolygon:
        pick(state, Tool::polygon, requests);
        return;
    case Command::toolLasso:
        pick(state, Tool::lasso, requests);
        return;
    case Command::toolSelect:
        pick(state, Tool::select, requests);
        return;
    case Command::toolFlood:
        pick(state, Tool::flood, requests);
        return;
    case Command::floodByDepth:
        state.floodByDepth = state.tool != Tool::flood || !state.floodByDepth;
        pick(state, Tool::flood, requests);
        return;
    case Command::brushSmaller:
        resize(state, 1.0 / kBrushStep);
        return;
    case Command::brushLarger:
        resize(state, kBrushStep);
        return;
    case Command::brushSofter:
        harden(state, -0.1);
        return;
    case Command::brushHarder:
        harden(state, 0.1);
        return;
    case Command::protectOthers:
        state.protectOthers = !state.protectOthers;
        return;
    case Command::finishShape:
        finishPolygon(view, state, requests);
        return;
    case Command::cancelShape:
        cancelGesture(state, requests);
        return;
    case Command::removeVertex:
        state.polygon.pop_back();
        return;
    case Command::viewScene:
        state.mode = ViewMode::scene;
        return;
    case Command::viewPerceived:
        state.mode = ViewMode::perceived;
        return;
    case Command::viewLight:
        state.mode = ViewMode::light;
        return;
    case Command::viewCompare:
        state.mode = ViewMode::compare;
        return;
    case Command::otherEye:
        state.eye = state.eye == Eye::left ? Eye::right : Eye::left;
        return;
    case Command::nextSlot: {
        const int slots = std::max(1, slotsPerSweep(view.document.rig));
        state.slot = (state.slot + 1) % slots;
        return;
    }
    case Command::fit:
        state.fitted = true;
        return;
    case Command::actualSize:
        zoomTo(state, 1.0);
        return;
    case Command::zoomIn:
        zoomTo(state, state.zoom * kZoomStep);
        return;
    case Command::zoomOut:
        zoomTo(state, state.zoom / kZoomStep);
        return;
    case Command::hidePanels:
        state.panels.hidden = !state.panels.hidden;
        return;
    case Command::seamMarks:
        state.seamMarks = !state.seamMarks;
        return;
    case Command::debugPanel:
        state.debugOpen = !state.debugOpen;
        return;
    case Command::gazeHere:
        // From a menu there is no point under the cursor: the next click gives it.
        state.placingGaze = !state.cursor;
        if (state.cursor)
            lookAt(state, view.follow.shown != nullptr ? *view.follow.shown : view.document, *state.cursor);
        return;
    case Command::resetLayout:
        state.panels = {};
        state.page = Page::selected;
        state.hintsUsed.clear();
        return;
    case Command::shortcuts:
        state.shortcutsOpen = !state.shortcutsOpen;
        return;
    case Command::about:
        state.aboutOpen = !state.aboutOpen;
        return;
    // Held keys have states of their own; a menu click toggles them.
    case Command::holdPlain:
        state.plainHeld = !state.plainHeld;
        return;
    case Command::hideOverlay:
        state.overlayHidden = !state.overlayHidden;
        return;
    default:
        break;
    }
    if (command == Command::take || command == Command::liveTake) state.hintsUsed.insert(Hint::take);
    if (command == Command::undo && !state.polygon.empty()) {
        state.polygon.pop_back();
        return;
    }
    if (doneByApp(command)) {
        // Undo in the middle of a gesture takes the gesture back, and no more.
        if (command == Command::undo && state.gesture.edited) {
            cancelGesture(state, requests);
            return;
        }
        requests.push_back(RunCommand{command});
        return;
    }
    runRegion(command, view, state, requests);
}

void shortcutKeys(Panel& p) {
    State& state = p.state;
    const bool typing = ImGui::GetIO().WantTextInput;
    const auto held = [&](const KeyPress& press, bool down) {
        if (press.key == keys::space) state.panHeld = down;
        if (press.key == info(Command::holdPlain).key.key) state.plainHeld = down;
        if (press.key == info(Command::hideOverlay).key.key) state.overlayHidden = down;
    };
    for (const KeyPress& press : p.input.pressed) {
        const Key key{press.key, press.ctrl, press.shift};
        const bool function = press.key >= keys::f1 && press.key < keys::f1 + 25;
        // Safe light never waits for a modifier to be let go, a dialog to be closed or a text to be finished.
        if (press.key == info(Command::safeLight).key.key) {
            if (!press.repeat) p.run(Command::safeLight);
            continue;
        }
        if (press.alt || (typing && !function && !press.ctrl)) continue;
        // A text field has its own undo, copy and line ends.
        if (typing && press.ctrl && press.key != keys::letter('S') && press.key != keys::enter) continue;
        if (!press.repeat && !press.ctrl && !press.shift) held(press, true);
        for (const CommandInfo& entry : commands()) {
            if (entry.held || (entry.key != key && entry.otherKey != key)) continue;
            if (state.popupsOpen) continue;
            if (entry.command == Command::editDistance) {
                if (!press.repeat) state.distanceHeld = true, state.distanceDragged = false;
                break;
            }
            const bool repeats = entry.command == Command::brushSmaller || entry.command == Command::brushLarger ||
                                 entry.command == Command::undo || entry.command == Command::redo ||
                                 entry.command == Command::zoomIn || entry.command == Command::zoomOut;
            if (!press.repeat || repeats) p.run(entry.command);
            break;
        }
    }
    // After the presses: a key tapped within one frame must not stay held.
    for (const KeyPress& press : p.input.released) {
        held(press, false);
        const bool wasDistance = press.key == info(Command::editDistance).key.key && state.distanceHeld;
        if (!wasDistance) continue;
        state.distanceHeld = false;
        // D alone types a distance; D with a drag has scrubbed it.
        if (!std::exchange(state.distanceDragged, false)) p.run(Command::editDistance);
    }
}

}  // namespace ilf::ui
