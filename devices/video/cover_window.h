// A window that covers a part of the desktop exactly, whatever window managers think of it.
#pragma once

#include "core/base/geometry.h"
#include "devices/video/x_connection.h"

union _XEvent;  // NOLINT(bugprone-reserved-identifier): Xlib's

namespace ilf::devices {

/// What lies above what on the projector's display.
enum class Layer {
    output,  ///< above everything
    guard,   ///< above everything but outputs
};

/// Unmanaged (override-redirect), without focus, decorations or pointer, white wherever nothing is drawn. Hidden at
/// first. The window is known to other processes by a property, so that a guard finds the outputs it must lie below.
class CoverWindow {
public:
    /// `visual` (Xlib's Visual*) and `depth`: the root window's where none is given.
    CoverWindow(XConnection& x, Layer layer, ilf::Size size, void* visual = nullptr, int depth = 0);
    ~CoverWindow();
    CoverWindow(const CoverWindow&) = delete;
    CoverWindow& operator=(const CoverWindow&) = delete;

    unsigned long id() const { return window_; }
    /// Shows it there, in its layer; while it is shown, no screen saver or power saving sets in.
    void showAt(int left, int top);
    void hide();
    bool shown() const { return shown_; }
    /// Back to its layer, if the event says that something has come above or gone. Fed with all events.
    void heard(const _XEvent& event);

private:
    void restack();
    void keepAwake(bool awake);

    XConnection& x_;
    Layer layer_;
    ilf::Size size_;
    unsigned long window_ = 0, colours_ = 0, cursor_ = 0;
    bool shown_ = false;
};

}  // namespace ilf::devices
