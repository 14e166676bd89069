// The whole window: draws one frame and says what the operator asked for.
#pragma once

#include <optional>
#include <vector>

#include "ui/request.h"
#include "ui/state.h"
#include "ui/view.h"

namespace ilf::ui {

/// Where the pointer was, and which buttons were down there, since the last frame. ImGui 1.86 keeps one position a
/// frame; a stroke needs all of them.
struct PointerSample {
    Point<WidgetFrame> at;
    double time_s = 0.0;
    bool left = false, middle = false, right = false;
};
struct KeyPress {
    int key = 0;  ///< GLFW key number
    bool ctrl = false, shift = false, alt = false;
    bool repeat = false;
};
/// What happened since the last frame, from the window's callbacks. An empty trail stands for ImGui's own mouse state.
struct Input {
    std::vector<PointerSample> trail;  ///< oldest first, last = now; with a sample at each press and release
    std::vector<KeyPress> pressed, released;
    bool fullScreen = false;
    std::vector<std::string> dropped;  ///< files dropped on the window
};

/// Draws the window with ImGui (between NewFrame and Render). The requests are in the order they were made.
Requests studio(const View& view, State& state, const Input& input);

/// Commands that come back as RunCommand, for the app to do; all others studio() does itself, by edits or in `state`.
bool doneByApp(Command command);
/// As if the command's key were pressed: what remote control and tests call.
void run(Command command, const View& view, State& state, Requests& requests);

/// What the window will show next, so that nothing else need be computed.
struct Wants {
    bool perceivedLeft = false, perceivedRight = false, plain = false, lights = false;
    int slot = 0;                              ///< shown in the Light view
    std::optional<Point<CameraFrame>> cursor;  ///< for the seam profile and distances
    double zoom = 1.0;                         ///< window pixels per picture pixel: views need no more
    RegionId selected;                         ///< drawn brighter in the overlay
    bool gesture = false;                      ///< something is being dragged: answer fast, refine later
    ViewRequest seeing;                        ///< gaze, attention, colour and rim of perceived views
    bool operator==(const Wants&) const = default;
};
Wants wants(const State& state);

}  // namespace ilf::ui
