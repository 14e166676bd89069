#include "ui/commands.h"

#include <algorithm>
#include <array>
#include <cassert>

#include "ui/keys.h"

namespace ilf::ui {

namespace {

using keys::f;
using keys::letter;

constexpr Key none{};
constexpr Key plain(int key) { return {key, false, false}; }
constexpr Key plain(char c) { return {letter(c), false, false}; }
constexpr Key shift(int key) { return {key, false, true}; }
constexpr Key ctrl(int key) { return {key, true, false}; }
constexpr Key ctrl(char c) { return {letter(c), true, false}; }
constexpr Key ctrlShift(char c) { return {letter(c), true, true}; }

using C = Command;

// In the order of the menus. `info` relies on every command being here once; a test checks it.
constexpr auto table = std::to_array<CommandInfo>({
    {C::newProject, "file.new", "New", "File", ctrl('N'), none, "Start a project over an empty scene."},
    {C::open, "file.open", "Open...", "File", ctrl('O'), none, "Open a project, a picture or a video."},
    {C::openScene, "file.scene", "Replace scene...", "File", none, none,
     "Put another picture or video beneath the regions that are painted."},
    {C::save, "file.save", "Save", "File", ctrl('S'), none, "Save the project."},
    {C::saveAs, "file.saveAs", "Save as...", "File", ctrlShift('S'), none, "Save the project under another name."},
    {C::reopenLast, "file.reopenLast", "Reopen last", "File", ctrlShift('O'), none,
     "Open the project that was open before this one."},
    {C::exportView, "file.export", "Export view...", "File", none, none,
     "Save what the canvas shows (scene, perceived view or slot) as a PNG."},
    {C::quit, "file.quit", "Quit", "File", ctrl('Q'), none, "Close the studio. What plays goes on playing."},

    {C::undo, "edit.undo", "Undo", "Edit", ctrl('Z'), none, "Take back the last gesture."},
    {C::redo, "edit.redo", "Redo", "Edit", ctrlShift('Z'), ctrl('Y'), "Do it again."},
    {C::protectOthers, "edit.protect", "Protect other regions", "Edit", plain('K'), none,
     "The brush does not cut into what other regions cover."},
    {C::brushSmaller, "brush.smaller", "Smaller brush", "Edit", plain(keys::leftBracket), none, "A smaller brush."},
    {C::brushLarger, "brush.larger", "Larger brush", "Edit", plain(keys::rightBracket), none, "A larger brush."},
    {C::brushSofter, "brush.softer", "Softer brush", "Edit", shift(keys::leftBracket), none, "A softer brush edge."},
    {C::brushHarder, "brush.harder", "Harder brush", "Edit", shift(keys::rightBracket), none, "A harder brush edge."},
    {C::finishShape, "shape.finish", "Finish shape", "Edit", plain(keys::enter), plain(keys::kpEnter),
     "Close the polygon that is being drawn."},
    {C::cancelShape, "shape.cancel", "Cancel", "Edit", plain(keys::escape), none,
     "Leave the gesture or shape in progress without a trace."},
    {C::removeVertex, "shape.removeVertex", "Remove vertex", "Edit", plain(keys::backspace), none,
     "Take away the last vertex, or the one under the cursor."},

    {C::toolMove, "tool.move", "Select and move handles", "", plain('V'), none,
     "Click a region to select it; drag optical centres, anchors and vertices."},
    {C::toolBrush, "tool.brush", "Brush", "", plain('B'), none, "Paint the selected region. Shift-click for a line."},
    {C::toolErase, "tool.erase", "Eraser", "", plain('E'), none, "Take paint away. It has a size of its own."},
    {C::toolRectangle, "tool.rectangle", "Rectangle", "", plain('R'), none,
     "Drag a rectangle into the region; Alt takes it away."},
    {C::toolEllipse, "tool.ellipse", "Ellipse", "", plain('O'), none,
     "Drag an ellipse into the region; Alt takes it away."},
    {C::toolPolygon, "tool.polygon", "Polygon", "", plain('P'), none,
     "Click vertices; Enter closes, Backspace removes the last. In a region of its own they stay editable."},
    {C::toolLasso, "tool.lasso", "Lasso", "", plain('L'), none, "Draw around an area; Alt takes it away."},
    {C::toolSelect, "tool.select", "Select object", "", plain('S'), none,
     "Drag a box around an object: its outline is found in the background."},
    {C::toolFlood, "tool.flood", "Flood", "", plain('W'), none,
     "Click a colour: the area of that colour is added; or a surface, where it goes by depth (Shift+W)."},
    {C::floodByDepth, "tool.flood.depth", "Flood by depth", "", shift(letter('W')), none,
     "The flood takes the surface under the cursor from the depth map, or by colour again."},

    {C::addRegion, "region.add", "Add region", "Scene", ctrlShift('N'), none, "A new empty region above the others."},
    {C::duplicateRegion, "region.duplicate", "Duplicate region", "Scene", ctrl('D'), none,
     "A copy above the selected region."},
    {C::renameRegion, "region.rename", "Rename region", "Scene", plain(f(2)), none, "Give the region another name."},
    {C::deleteRegion, "region.delete", "Delete region", "Scene", plain(keys::del), none, "Remove the region."},
    {C::regionUp, "region.up", "Move region up", "Scene", ctrl(keys::up), none, "Over the region above it."},
    {C::regionDown, "region.down", "Move region down", "Scene", ctrl(keys::down), none, "Under the region below it."},
    {C::hideRegion, "region.hide", "Hide region", "Scene", plain('H'), none, "Hide it, or show it again."},
    {C::lockRegion, "region.lock", "Lock region", "Scene", none, none, "Keep its pixels from being painted."},
    {C::soloRegion, "region.solo", "Solo region", "Scene", none, none, "Only soloed regions take part."},
    {C::growRegion, "region.grow", "Grow region", "Scene", ctrl(keys::rightBracket), none, "Larger by 4 pixels."},
    {C::shrinkRegion, "region.shrink", "Shrink region", "Scene", ctrl(keys::leftBracket), none, "Smaller by 4 pixels."},
    {C::invertRegion, "region.invert", "Invert region", "Scene", ctrl('I'), none, "Swap inside and outside."},
    {C::lookFocus, "region.look.focus", "Look: focus", "Scene", plain(keys::digit1), none,
     "Lit while the lens is at rest: seen sharp."},
    {C::lookBlur, "region.look.blur", "Look: blur", "Scene", plain(keys::digit2), none,
     "Lit at the end of the sweep: seen blurred."},
    {C::lookNeutral, "region.look.neutral", "Look: neutral", "Scene", plain(keys::digit3), none,
     "Lit evenly in all lit slots."},
    {C::swapLook, "region.look.swap", "Swap focus and blur", "Scene", plain('X'), none,
     "Focus becomes blur and blur becomes focus, for the region under the cursor."},
    {C::editDistance, "region.distance", "Type distance", "Scene", plain('D'), none,
     "Type the selected region's distance; hold D and drag on the picture to scrub it."},
    {C::grab, "scene.grab", "Grab frame", "Scene", plain(f(5)), none, "Freeze the camera's frame as the scene."},
    {C::openCamera, "scene.camera.open", "Open camera", "Scene", none, none, "Take the picture from a live camera."},
    {C::closeCamera, "scene.camera.close", "Close camera", "Scene", none, none, "Let go of the camera."},
    {C::lockCamera, "scene.camera.lock", "Lock exposure and white balance", "Scene", none, none,
     "Keep the camera from adapting while the projector changes the light."},
    {C::toggleLive, "scene.live", "Live picture beneath", "Scene", none, none,
     "Show the live camera beneath the regions instead of the grabbed frame."},

    {C::viewScene, "view.scene", "Scene", "View", plain(f(6)), none, "The picture regions are painted on."},
    {C::viewPerceived, "view.perceived", "Perceived", "View", plain(f(7)), none, "What the wearer sees."},
    {C::viewLight, "view.light", "Light", "View", plain(f(8)), none, "What the projector shows in one slot."},
    {C::viewCompare, "view.compare", "Compare", "View", plain(f(9)), none,
     "Plain view and perceived view, with a divider to drag."},
    {C::otherEye, "view.otherEye", "Other eye", "View", plain('Y'), none, "Left eye, right eye."},
    {C::nextSlot, "view.nextSlot", "Next slot", "View", plain('N'), none, "The light of the next slot."},
    {C::holdPlain, "view.holdPlain", "Plain view (hold)", "View", plain(keys::grave), none,
     "While held: the view without any effect.", true},
    {C::hideOverlay, "view.hideOverlay", "Hide overlay (hold)", "View", plain(keys::backslash), none,
     "While held: the picture without region marks.", true},
    {C::fit, "view.fit", "Fit", "View", plain('F'), none, "The whole picture."},
    {C::actualSize, "view.actualSize", "1:1", "View", ctrl(keys::digit0), none, "One picture pixel per screen pixel."},
    {C::zoomIn, "view.zoomIn", "Zoom in", "View", ctrl(keys::equal), plain(keys::equal), "Closer."},
    {C::zoomOut, "view.zoomOut", "Zoom out", "View", ctrl(keys::minus), plain(keys::minus), "Farther."},
    {C::hidePanels, "view.panels", "Only the picture", "View", plain(keys::tab), none,
     "Hide everything but the picture, or bring it back."},
    {C::fullScreen, "view.fullScreen", "Full screen", "View", plain(f(11)), none, "The window over the whole screen."},

    {C::seamMarks, "view.seamMarks", "Seam marks", "View", plain('M'), none, "Dots where a seam will show, or none."},
    {C::debugPanel, "view.debug", "Counters", "View", plain(f(3)), none,
     "What the last view, compile and frame took, and what they could leave out."},
    {C::gazeHere, "view.gazeHere", "Look here", "View", plain('G'), none,
     "In perceived views the eye is turned to the point under the cursor and focuses on what is there."},

    {C::resetLayout, "view.resetLayout", "Reset layout", "View", none, none,
     "Panels as they were at first; hints are shown again."},

    {C::take, "show.take", "TAKE", "Show", ctrl(keys::enter), none, "Put what is painted on show."},
    {C::liveTake, "show.live", "Live", "Show", ctrl('L'), none, "Put every change on show while painting."},
    {C::safeLight, "show.safeLight", "SAFE LIGHT", "Show", plain(f(12)), none,
     "Steady uniform white light, lens at rest, at once."},
    {C::acknowledgeFault, "rig.acknowledge", "Acknowledge fault", "Rig", none, none,
     "The fault was seen; its chip shows the device's state again."},
    {C::registerCamera, "rig.register", "Register camera...", "Rig", plain(f(4)), none,
     "Find where the camera's picture lands on the projector: by a scan, by corners, by point pairs, by a chessboard."},

    {C::shortcuts, "help.shortcuts", "Shortcuts", "Help", shift(keys::slash), plain(keys::f1),
     "All keys on one sheet."},
    {C::about, "help.about", "About", "Help", none, none, "Version, licence and the paper."},
});

struct Named {
    int key;
    const char* name;
};
constexpr auto names = std::to_array<Named>({
    {keys::space, "Space"},
    {keys::escape, "Esc"},
    {keys::enter, "Enter"},
    {keys::kpEnter, "Keypad Enter"},
    {keys::tab, "Tab"},
    {keys::backspace, "Backspace"},
    {keys::insert, "Ins"},
    {keys::del, "Del"},
    {keys::right, "Right"},
    {keys::left, "Left"},
    {keys::down, "Down"},
    {keys::up, "Up"},
    {keys::pageUp, "PageUp"},
    {keys::pageDown, "PageDown"},
    {keys::home, "Home"},
    {keys::end, "End"},
});

}  // namespace

std::span<const CommandInfo> commands() { return table; }

const CommandInfo& info(Command command) {
    for (const CommandInfo& entry : table) {
        if (entry.command == command) return entry;
    }
    assert(false && "a command is missing from the table");
    return table.front();
}

std::string keyText(const Key& key) {
    if (key.key == 0) return {};
    if (key == shift(keys::slash)) return "?";
    std::string text;
    if (key.ctrl) text += "Ctrl+";
    if (key.shift) text += "Shift+";
    for (const Named& named : names) {
        if (named.key == key.key) return text + named.name;
    }
    if (key.key >= keys::f1 && key.key < keys::f1 + 25) return text + "F" + std::to_string(key.key - keys::f1 + 1);
    return text + static_cast<char>(key.key);
}

std::string bindingsText() {
    std::string text;
    for (const CommandInfo& entry : table) {
        std::string keysText = keyText(entry.key);
        if (entry.otherKey.key != 0) keysText += ", " + keyText(entry.otherKey);
        std::string line = entry.name;
        line.resize(std::max<std::size_t>(line.size() + 1, 24), ' ');
        line += keysText;
        line.resize(std::max<std::size_t>(line.size() + 1, 48), ' ');
        text += line + entry.title + "\n";
    }
    return text;
}

}  // namespace ilf::ui
