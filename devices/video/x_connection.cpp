#include "devices/video/x_connection.h"

#include <X11/Xlib.h>
#include <algorithm>
#include <cstdlib>
#include <mutex>
#include <string>
#include <vector>

namespace ilf::devices {
namespace {

/// Whom an error is for. Xlib has one handler for the whole process, which may have connections that are not ours.
struct Registry {
    std::mutex mutex;
    std::vector<std::pair<Display*, XConnection*>> ours;
    XErrorHandler others = nullptr;
    XIOErrorHandler othersLoss = nullptr;

    XConnection* find(Display* display) {
        const std::scoped_lock lock(mutex);
        for (const auto& [known, connection] : ours)
            if (known == display) return connection;
        return nullptr;
    }
};

Registry& registry() {
    static Registry all;
    return all;
}

int onRefusal(Display* display, XErrorEvent* event) {
    if (XConnection* connection = registry().find(display)) {
        connection->refused();
        return 0;
    }
    return registry().others != nullptr ? registry().others(display, event) : 0;
}

// Called by whichever call of Xlib found the connection broken. Xlib's own says so on standard error and exits.
int onLoss(Display* display) {
    if (XConnection* connection = registry().find(display)) {
        connection->gone();
        return 0;
    }
    return registry().othersLoss != nullptr ? registry().othersLoss(display) : 0;
}

// Called next, in the place of exit(1).
void stay(Display*, void*) {}

}  // namespace

XConnection::XConnection(XServerConnection* display) : display_(display) {
    Registry& all = registry();
    const std::scoped_lock lock(all.mutex);
    all.ours.emplace_back(display, this);
    if (const XErrorHandler before = XSetErrorHandler(onRefusal); before != onRefusal) all.others = before;
    if (const XIOErrorHandler before = XSetIOErrorHandler(onLoss); before != onLoss) all.othersLoss = before;
    XSetIOErrorExitHandler(display, stay, nullptr);
}

XConnection::~XConnection() {
    XCloseDisplay(display_);
    const std::scoped_lock lock(registry().mutex);
    std::erase_if(registry().ours, [this](const auto& entry) { return entry.second == this; });
}

Result<std::unique_ptr<XConnection>> XConnection::open() {
    const char* name = std::getenv("DISPLAY");
    if (name == nullptr || *name == '\0')
        return fail(
            Fault::notFound,
            "There is no display server to show a picture on: DISPLAY is not set. Start from a desktop session, "
            "or set DISPLAY to the X server that has the projector's display.");
    Display* display = XOpenDisplay(nullptr);
    if (display == nullptr)
        return fail(Fault::notFound, "The display server " + std::string(name) +
                                         " does not answer. Check that it runs, and that this user may use it (xhost, "
                                         "XAUTHORITY).");
    return std::unique_ptr<XConnection>(new XConnection(display));
}

unsigned long XConnection::root() const { return DefaultRootWindow(display_); }

int XConnection::descriptor() const { return ConnectionNumber(display_); }

bool XConnection::accepted() {
    if (!lost_) XSync(display_, False);
    return !refused_.exchange(false) && !lost_;
}

}  // namespace ilf::devices
