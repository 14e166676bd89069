#include "devices/video/white_guard.h"

#include <X11/Xlib.h>
#include <X11/extensions/Xrandr.h>
#include <cerrno>
#include <chrono>
#include <memory>
#include <optional>
#include <poll.h>

#include "devices/video/cover_window.h"
#include "devices/video/x_displays.h"

namespace ilf::devices {
namespace {

constexpr std::chrono::milliseconds kTryEvery{1000};

class Guard {
public:
    Guard(DisplayWish wish, const std::function<void(const std::string&)>& said)
        : wish_(std::move(wish)), said_(said) {}

    /// Looks where the display is now, and lies there.
    void look() {
        if (x_ && x_->lost()) {
            window_.reset();
            x_.reset();
        }
        const auto done = looked();
        if (!done && window_ && !x_->lost()) window_->hide();
        if (x_) XFlush(x_->get());
        const std::string now =
            done ? "The projector's display " + displayName(wish_.display) + " is kept white when nothing is shown."
                 : done.error().what;
        if (now != lastSaid_) said_(now);
        lastSaid_ = now;
    }

    /// Handles what the server says; true: look again.
    bool heard() {
        bool again = false;
        while (!x_->lost() && XPending(x_->get()) > 0) {
            XEvent event;
            XNextEvent(x_->get(), &event);
            if (x_->lost()) break;
            again |= event.type == randrEvent_ + RRScreenChangeNotify || event.type == randrEvent_ + RRNotify;
            if (window_) window_->heard(event);
        }
        if (!x_->lost()) XFlush(x_->get());
        return again || x_->lost();
    }

    /// -1: there is no server; look again after a while.
    int descriptor() const { return x_ && !x_->lost() ? x_->descriptor() : -1; }

private:
    Result<void> looked() {
        if (!x_) {
            auto opened = XConnection::open();
            if (!opened) return tl::unexpected(opened.error());
            x_ = *std::move(opened);
            int error = 0;
            XRRQueryExtension(x_->get(), &randrEvent_, &error);
            watchDisplays(*x_);
        }
        const auto displays = xDisplays(*x_);
        if (!displays) return tl::unexpected(displays.error());
        const auto chosen = chosenDisplay(foundOf(*displays), wish_);
        if (!chosen) return tl::unexpected(chosen.error());
        const FoundDisplay& found = (*displays)[chosen->index].found;
        if (chosen->setMode)
            return fail(Fault::device,
                        "The projector's display " + displayName(found.identity) + " does not have its mode yet.");
        wish_.display = found.identity;
        if (!window_) window_ = std::make_unique<CoverWindow>(*x_, Layer::guard, wish_.raster);
        window_->showAt(found.left, found.top);
        if (!x_->accepted() && x_->lost()) return fail(Fault::device, "The display server is gone.");
        return {};
    }

    DisplayWish wish_;
    const std::function<void(const std::string&)>& said_;
    std::unique_ptr<XConnection> x_;  // outlives the window
    std::unique_ptr<CoverWindow> window_;
    int randrEvent_ = 0;
    std::string lastSaid_;
};

}  // namespace

Result<void> keepWhite(const DisplayWish& wish, int stopDescriptor,
                       const std::function<void(const std::string&)>& said) {
    if (wish.raster.width <= 0 || wish.raster.height <= 0)
        return fail(Fault::outOfRange, "A projector's display needs a raster to be kept white.");
    Guard guard(wish, said);
    guard.look();
    while (true) {
        const int server = guard.descriptor();
        pollfd waited[] = {{stopDescriptor, POLLIN, 0}, {server, POLLIN, 0}};
        const int ready = poll(waited, 2, server < 0 ? static_cast<int>(kTryEvery.count()) : -1);
        if (ready < 0 && errno != EINTR)
            return fail(Fault::device, "The guard of the projector's display cannot wait.");
        if (ready < 0) continue;
        if (waited[0].revents != 0) return {};
        if (server < 0 || guard.heard()) guard.look();
    }
}

}  // namespace ilf::devices
