// The one table of commands: menus, keys, tooltips and --list-bindings are made from it.
#pragma once

#include <span>
#include <string>

namespace ilf::ui {

enum class Command {
    newProject,
    open,
    openScene,
    save,
    saveAs,
    reopenLast,
    exportView,
    quit,
    undo,
    redo,
    toolMove,
    toolBrush,
    toolErase,
    toolRectangle,
    toolEllipse,
    toolPolygon,
    toolLasso,
    toolSelect,
    toolFlood,
    floodByDepth,
    brushSmaller,
    brushLarger,
    brushSofter,
    brushHarder,
    protectOthers,
    addRegion,
    duplicateRegion,
    renameRegion,
    deleteRegion,
    regionUp,
    regionDown,
    hideRegion,
    lockRegion,
    soloRegion,
    growRegion,
    shrinkRegion,
    invertRegion,
    lookFocus,
    lookBlur,
    lookNeutral,
    swapLook,
    editDistance,
    finishShape,
    cancelShape,
    removeVertex,
    viewScene,
    viewPerceived,
    viewLight,
    viewCompare,
    otherEye,
    nextSlot,
    holdPlain,
    hideOverlay,
    fit,
    actualSize,
    zoomIn,
    zoomOut,
    hidePanels,
    fullScreen,
    seamMarks,
    debugPanel,
    gazeHere,
    resetLayout,
    grab,
    openCamera,
    closeCamera,
    lockCamera,
    toggleLive,
    take,
    liveTake,
    safeLight,
    acknowledgeFault,
    registerCamera,
    shortcuts,
    about,
};

/// A key with its modifiers; `key` is a GLFW key number, so that this layer needs no GLFW.
struct Key {
    int key = 0;
    bool ctrl = false, shift = false;
    bool operator==(const Key&) const = default;
};

struct CommandInfo {
    Command command;
    const char* name;   ///< stable, for --list-bindings and remote control: "region.look.focus"
    const char* title;  ///< for menus
    const char* menu;   ///< "File", "Edit" ...; empty: keys and buttons only
    Key key, otherKey;  ///< key 0: none
    const char* help;   ///< one sentence for the tooltip
    bool held = false;  ///< acts while the key is held (compare, hide overlay)
};

std::span<const CommandInfo> commands();
const CommandInfo& info(Command command);
/// "Ctrl+Shift+Z"; empty without a key.
std::string keyText(const Key& key);
/// The text of --list-bindings: name, keys, title, one a line.
std::string bindingsText();

}  // namespace ilf::ui
