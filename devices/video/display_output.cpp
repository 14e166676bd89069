#include "devices/video/display_output.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "devices/video/refresh_meter.h"
#include "devices/video/swap_window.h"
#include "devices/video/x_displays.h"

namespace ilf::devices {
namespace {

using namespace std::chrono_literals;

constexpr std::chrono::nanoseconds kTryEvery = 500ms;
// No server tells that a night light has bent the gamma ramp.
constexpr std::chrono::nanoseconds kLookEvery = 1s;

class DisplayOutput final : public VideoOutput {
public:
    DisplayOutput(DisplayWish wish, Clock clock)
        : wish_(std::move(wish)), display_(wish_.display), clock_(std::move(clock)),
          white_(uniformFrame(wish_.raster, 255)) {}

    Result<ScannedOut> show(const VideoFrame& frame) override {
        if (frame.size() != wish_.raster || frame.channels() != 3)
            return fail(Fault::outOfRange, "A picture of " + sizeText(frame.size()) +
                                               " does not fit the projector's display, " + sizeText(wish_.raster) +
                                               ".");
        if (auto there = reached(); !there) return tl::unexpected(there.error());
        const auto swapped = swap(frame, false);
        if (!swapped) return tl::unexpected(swapped.error());
        // The machine's clock and ours may count from different times.
        const auto age = std::chrono::steady_clock::now().time_since_epoch() - swapped->at;
        return ScannedOut{clock_.now() - std::max<std::chrono::nanoseconds>(age, 0ns), frames_++};
    }

    Result<VideoMode> mode() override {
        if (auto there = reached(); !there) return tl::unexpected(there.error());
        return VideoMode{wish_.raster, meter_.rate()};
    }

    const DisplayIdentity& display() const override { return display_; }

private:
    /// The window is on its display; looked for again where it is not.
    Result<void> reached() {
        if (there_) {
            const bool changed = window_->displaysChanged();
            if (x_->lost())
                return lost({Fault::device, "The projector's display server is gone; the display is looked for "
                                            "again."});
            const bool look = changed || clock_.now() - lookedAt_ >= kLookEvery;
            if (!look) return {};
            auto still = stillThere();
            if (!still) return lost(still.error());
            return {};
        }
        const auto now = clock_.now();
        if (triedAt_ && now - *triedAt_ < kTryEvery) return tl::unexpected(why_);
        auto found = looked();
        triedAt_ = clock_.now();
        if (!found) return lost(found.error());
        return {};
    }

    Result<void> looked() {
        if (x_) {
            if (window_) (void)window_->displaysChanged();
            if (!x_->accepted() && x_->lost()) hangUp();
        }
        if (!x_) {
            auto opened = XConnection::open();
            if (!opened) return tl::unexpected(opened.error());
            x_ = *std::move(opened);
            watchDisplays(*x_);
        }
        auto display = ready();
        if (!display) return tl::unexpected(display.error());
        if (!window_) {
            auto opened = SwapWindow::open(*x_, wish_.raster);
            if (!opened) return tl::unexpected(opened.error());
            window_ = *std::move(opened);
        }
        return placed(*display);
    }

    /// The display, set as it must be.
    Result<XDisplay> ready() {
        for (bool set = false;; set = true) {
            const auto displays = xDisplays(*x_);
            if (!displays) return tl::unexpected(displays.error());
            const auto chosen = chosenDisplay(foundOf(*displays), bound(), unplugged_);
            if (!chosen) {
                unplugged_ |= bound_ && chosen.error().fault == Fault::notFound && !isAmong(*displays);
                return tl::unexpected(chosen.error());
            }
            const XDisplay& display = (*displays)[chosen->index];
            if (!chosen->setMode) {
                sendPlainly(*x_, display);
                return display;
            }
            if (set)
                return fail(Fault::device, "The projector's display " + displayName(display.found.identity) +
                                               " does not keep the mode " + sizeText(wish_.raster) +
                                               "; set it by hand, without scaling or rotation.");
            if (auto done = setRaster(*x_, *displays, display, wish_.raster); !done)
                return tl::unexpected(done.error());
        }
    }

    /// White on the display, until its rate is known.
    Result<void> placed(const XDisplay& display) {
        window_->showAt(display.found.left, display.found.top);
        meter_ = RefreshMeter(display.found.refresh);
        at_ = display;
        for (int i = 0; i < (meter_.waits() ? RefreshMeter::kFirstSwaps : 1); ++i)
            if (auto swapped = swap(white_, i == 0); !swapped) return tl::unexpected(swapped.error());
        display_ = display.found.identity;
        bound_ = true;
        unplugged_ = false;
        there_ = true;
        return {};
    }

    Result<void> stillThere() {
        lookedAt_ = clock_.now();
        const auto displays = xDisplays(*x_);
        if (!displays) return tl::unexpected(displays.error());
        const auto chosen = chosenDisplay(foundOf(*displays), bound());
        if (!chosen) {
            unplugged_ = !isAmong(*displays);
            return tl::unexpected(chosen.error());
        }
        const XDisplay& display = (*displays)[chosen->index];
        if (chosen->setMode)
            return fail(Fault::device, "The projector's display " + displayName(display_) +
                                           " was switched to another mode or scaled; " + sizeText(wish_.raster) +
                                           " is what its patterns need.");
        if (display.output != at_.output || display.crtc != at_.crtc || display.found.left != at_.found.left ||
            display.found.top != at_.found.top)
            return fail(Fault::device,
                        "The projector's display " + displayName(display_) + " was moved on the desktop.");
        sendPlainly(*x_, display);
        return {};
    }

    bool isAmong(const std::vector<XDisplay>& displays) const {
        return std::any_of(displays.begin(), displays.end(), [&](const XDisplay& d) {
            return d.found.identity.connector == display_.connector || d.found.identity == display_;
        });
    }

    /// Once found, a display is looked for by what it said of itself.
    DisplayWish bound() const { return {display_, wish_.raster}; }

    Result<Swapped> swap(const VideoFrame& frame, bool checked) {
        auto swapped = window_->swap(frame, checked);
        if (!swapped) return lost(swapped.error());
        meter_.saw(swapped->at, swapped->frame);
        return swapped;
    }

    /// Takes the window away at once: who knows what that part of the desktop shows next.
    tl::unexpected<Error> lost(Error why) {
        if (there_) triedAt_.reset();
        there_ = false;
        if (window_ && !x_->lost()) window_->hide();
        if (x_ && (!x_->accepted() && x_->lost())) hangUp();
        why_ = {Fault::device, std::move(why.what)};
        return tl::unexpected(why_);
    }

    void hangUp() {
        window_.reset();
        x_.reset();
    }

    DisplayWish wish_;
    DisplayIdentity display_;
    Clock clock_;
    VideoFrame white_;
    std::unique_ptr<XConnection> x_;  // outlives the window
    std::unique_ptr<SwapWindow> window_;
    XDisplay at_;
    RefreshMeter meter_{0.0_Hz};
    bool there_ = false;
    bool bound_ = false;      ///< `display_` is what was found, not what was wished
    bool unplugged_ = false;  ///< not only switched off
    std::optional<std::chrono::nanoseconds> triedAt_;
    std::chrono::nanoseconds lookedAt_{0};
    Error why_;
    std::int64_t frames_ = 0;
};

}  // namespace

Result<std::shared_ptr<VideoOutput>> displayOutput(const DisplayWish& wish, Clock clock) {
    if (wish.raster.width <= 0 || wish.raster.height <= 0)
        return fail(Fault::outOfRange, "A projector's display needs a raster, " + sizeText(wish.raster) + " is none.");
    return std::make_shared<DisplayOutput>(wish, std::move(clock));
}

Result<std::vector<FoundDisplay>> displays() {
    auto x = XConnection::open();
    if (!x) return tl::unexpected(x.error());
    auto found = xDisplays(**x);
    if (!found) return tl::unexpected(found.error());
    return foundOf(*found);
}

}  // namespace ilf::devices
