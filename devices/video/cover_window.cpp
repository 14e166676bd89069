#include "devices/video/cover_window.h"

#include <X11/Xatom.h>
#include <X11/Xlib.h>
#include <X11/Xutil.h>
#include <X11/extensions/dpms.h>
#include <X11/extensions/scrnsaver.h>
#include <optional>
#include <span>

namespace ilf::devices {
namespace {

constexpr const char* kLayerProperty = "_ILLUMINATEDFOCUS_LAYER";
constexpr const char* kName = "IlluminatedFocus output";

Cursor invisibleCursor(Display* display, Window window) {
    const char nothing = 0;
    const Pixmap empty = XCreateBitmapFromData(display, window, &nothing, 1, 1);
    XColor black{};
    const Cursor cursor = XCreatePixmapCursor(display, empty, empty, &black, &black, 0, 0);
    XFreePixmap(display, empty);
    return cursor;
}

std::optional<Layer> layerOf(Display* display, Window window, Atom property) {
    Atom type = 0;
    int format = 0;
    unsigned long items = 0, left = 0;
    unsigned char* bytes = nullptr;
    std::optional<Layer> layer;
    if (XGetWindowProperty(display, window, property, 0, 1, False, XA_CARDINAL, &type, &format, &items, &left,
                           &bytes) == Success &&
        bytes != nullptr && type == XA_CARDINAL && format == 32 && items == 1)
        layer = static_cast<Layer>(*reinterpret_cast<const long*>(bytes));  // format 32 comes as longs
    if (bytes != nullptr) XFree(bytes);
    return layer;
}

/// The lowest visible output among the top-level windows; 0: none.
Window lowestOutput(Display* display, Window root, Atom property) {
    Window parent = 0, ignored = 0;
    Window* children = nullptr;
    unsigned count = 0;
    if (XQueryTree(display, root, &ignored, &parent, &children, &count) == 0 || children == nullptr) return 0;
    Window lowest = 0;
    for (const Window child : std::span(children, count)) {  // from the bottom
        if (layerOf(display, child, property) != Layer::output) continue;
        lowest = child;
        break;
    }
    XFree(children);
    return lowest;
}

}  // namespace

CoverWindow::CoverWindow(XConnection& x, Layer layer, ilf::Size size, void* visual, int depth)
    : x_(x), layer_(layer), size_(size) {
    Display* display = x.get();
    const int screen = DefaultScreen(display);
    XSetWindowAttributes wanted{};
    unsigned long which = CWOverrideRedirect | CWBackPixel | CWBorderPixel | CWEventMask;
    wanted.override_redirect = True;
    wanted.background_pixel = WhitePixel(display, screen);
    wanted.event_mask = VisibilityChangeMask | StructureNotifyMask;
    if (visual != nullptr) {
        // With a visual of its own come colours of its own. Of 8 bits a channel, since nothing else is asked for.
        colours_ = XCreateColormap(display, x.root(), static_cast<Visual*>(visual), AllocNone);
        wanted.colormap = colours_;
        wanted.background_pixel = 0xffffff;
        which |= CWColormap;
    }
    window_ = XCreateWindow(display, x.root(), 0, 0, static_cast<unsigned>(size.width),
                            static_cast<unsigned>(size.height), 0, visual != nullptr ? depth : CopyFromParent,
                            InputOutput, visual != nullptr ? static_cast<Visual*>(visual) : nullptr, which, &wanted);
    cursor_ = invisibleCursor(display, window_);
    XDefineCursor(display, window_, cursor_);
    XStoreName(display, window_, kName);
    const long number = static_cast<long>(layer);
    XChangeProperty(display, window_, XInternAtom(display, kLayerProperty, False), XA_CARDINAL, 32, PropModeReplace,
                    reinterpret_cast<const unsigned char*>(&number), 1);
    // Compositors then let the window straight through to the display.
    const long bypass = 1;
    XChangeProperty(display, window_, XInternAtom(display, "_NET_WM_BYPASS_COMPOSITOR", False), XA_CARDINAL, 32,
                    PropModeReplace, reinterpret_cast<const unsigned char*>(&bypass), 1);
}

CoverWindow::~CoverWindow() {
    if (x_.lost()) return;
    hide();
    XDestroyWindow(x_.get(), window_);
    XFreeCursor(x_.get(), cursor_);
    if (colours_ != 0) XFreeColormap(x_.get(), colours_);
}

void CoverWindow::showAt(int left, int top) {
    XMoveResizeWindow(x_.get(), window_, left, top, static_cast<unsigned>(size_.width),
                      static_cast<unsigned>(size_.height));
    restack();  // before it is seen, so that a guard never flashes over an output
    XMapWindow(x_.get(), window_);
    if (!shown_) keepAwake(true);
    shown_ = true;
}

void CoverWindow::hide() {
    if (!shown_) return;
    XUnmapWindow(x_.get(), window_);
    keepAwake(false);
    shown_ = false;
}

void CoverWindow::heard(const XEvent& event) {
    if (!shown_ || event.type != VisibilityNotify || event.xvisibility.window != window_) return;
    if (layer_ == Layer::guard || event.xvisibility.state != VisibilityUnobscured) restack();
}

void CoverWindow::restack() {
    Display* display = x_.get();
    const Window above =
        layer_ == Layer::guard ? lowestOutput(display, x_.root(), XInternAtom(display, kLayerProperty, False)) : 0;
    if (above == 0) {
        XRaiseWindow(display, window_);
        return;
    }
    XWindowChanges changes{};
    changes.sibling = above;
    changes.stack_mode = Below;
    XConfigureWindow(display, window_, CWSibling | CWStackMode, &changes);
}

void CoverWindow::keepAwake(bool awake) {
    int event = 0, error = 0;
    // Ends by itself with the connection, so that a killed process leaves nothing behind.
    if (XScreenSaverQueryExtension(x_.get(), &event, &error)) XScreenSaverSuspend(x_.get(), awake ? True : False);
    if (!awake) return;
    XResetScreenSaver(x_.get());
    if (DPMSQueryExtension(x_.get(), &event, &error) && DPMSCapable(x_.get())) {
        CARD16 level = 0;
        BOOL enabled = False;
        if (DPMSInfo(x_.get(), &level, &enabled) && enabled && level != DPMSModeOn)
            DPMSForceLevel(x_.get(), DPMSModeOn);
    }
}

}  // namespace ilf::devices
