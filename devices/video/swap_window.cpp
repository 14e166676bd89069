#include "devices/video/swap_window.h"

#include <GL/gl.h>
#include <GL/glx.h>
#include <X11/Xlib.h>
#include <X11/Xutil.h>
#include <X11/extensions/Xrandr.h>
#include <cassert>
#include <cstring>
#include <span>
#include <string>
#include <vector>

#include "devices/video/cover_window.h"

namespace ilf::devices {
namespace {

using SwapIntervalExt = void (*)(Display*, GLXDrawable, int);
using SwapIntervalMesa = int (*)(unsigned);
using WaitForSbc = Bool (*)(Display*, GLXDrawable, std::int64_t, std::int64_t*, std::int64_t*, std::int64_t*);

template <class Function>
Function procedure(const char* extensions, const char* extension, const char* name) {
    // Names are whole words: a prefix of one is another extension.
    const std::string all = " " + std::string(extensions != nullptr ? extensions : "") + " ";
    if (all.find(" " + std::string(extension) + " ") == std::string::npos) return nullptr;
    return reinterpret_cast<Function>(glXGetProcAddressARB(reinterpret_cast<const GLubyte*>(name)));
}

tl::unexpected<Error> noOpenGl(const char* what) {
    return fail(Fault::device, std::string("No picture can be drawn on this display server: ") + what +
                                   ". Install libgl1-mesa-dri, or the graphics card's driver.");
}

/// 8 bits a channel, no more and no less; no samples that would be averaged; nothing a compositor would look through.
struct Choice {
    GLXFBConfig config = nullptr;
    Visual* visual = nullptr;
    int depth = 0;
};

Choice chosenConfig(Display* display) {
    const int wanted[] = {GLX_X_RENDERABLE,
                          True,
                          GLX_DRAWABLE_TYPE,
                          GLX_WINDOW_BIT,
                          GLX_RENDER_TYPE,
                          GLX_RGBA_BIT,
                          GLX_X_VISUAL_TYPE,
                          GLX_TRUE_COLOR,
                          GLX_DOUBLEBUFFER,
                          True,
                          GLX_RED_SIZE,
                          8,
                          GLX_GREEN_SIZE,
                          8,
                          GLX_BLUE_SIZE,
                          8,
                          None};
    int count = 0;
    GLXFBConfig* configs = glXChooseFBConfig(display, DefaultScreen(display), wanted, &count);
    Choice choice;
    for (const GLXFBConfig config : std::span(configs, configs != nullptr ? static_cast<std::size_t>(count) : 0)) {
        const auto is = [&](int attribute, int value) {
            int found = -1;
            return glXGetFBConfigAttrib(display, config, attribute, &found) == 0 && found == value;
        };
        XVisualInfo* info = glXGetVisualFromFBConfig(display, config);
        if (info != nullptr && choice.config == nullptr && info->depth == 24 && is(GLX_RED_SIZE, 8) &&
            is(GLX_GREEN_SIZE, 8) && is(GLX_BLUE_SIZE, 8) && is(GLX_SAMPLES, 0))
            choice = {config, info->visual, info->depth};
        if (info != nullptr) XFree(info);
    }
    if (configs != nullptr) XFree(static_cast<void*>(configs));
    return choice;
}

class GlxWindow final : public SwapWindow {
public:
    GlxWindow(XConnection& x, Size size, const Choice& choice, GLXContext context)
        : x_(x), size_(size), window_(x, Layer::output, size, choice.visual, choice.depth), context_(context) {
        int error = 0;
        XRRQueryExtension(x.get(), &randrEvent_, &error);
        surface_ = glXCreateWindow(x.get(), choice.config, window_.id(), nullptr);
    }

    ~GlxWindow() override {
        // Also without its server: the few requests that this makes then go nowhere.
        glXMakeContextCurrent(x_.get(), None, None, nullptr);
        glXDestroyContext(x_.get(), context_);
        glXDestroyWindow(x_.get(), surface_);
    }

    Result<void> prepared() {
        if (!glXMakeContextCurrent(x_.get(), surface_, surface_, context_) || !x_.accepted())
            return noOpenGl("its OpenGL does not start");
        const char* extensions = glXQueryExtensionsString(x_.get(), DefaultScreen(x_.get()));
        if (const auto set = procedure<SwapIntervalExt>(extensions, "GLX_EXT_swap_control", "glXSwapIntervalEXT"))
            set(x_.get(), surface_, 1);
        else if (const auto setMesa =
                     procedure<SwapIntervalMesa>(extensions, "GLX_MESA_swap_control", "glXSwapIntervalMESA"))
            setMesa(1);
        waitForSbc_ = procedure<WaitForSbc>(extensions, "GLX_OML_sync_control", "glXWaitForSbcOML");

        glViewport(0, 0, size_.width, size_.height);
        glDisable(GL_DITHER);
        glDisable(GL_BLEND);
        glDisable(GL_DEPTH_TEST);
        glDisable(GL_TEXTURE_2D);
        glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
        glPixelStorei(GL_PACK_ALIGNMENT, 1);
        // Pictures begin at the top, OpenGL at the bottom.
        glRasterPos2f(-1.0F, 1.0F);
        glPixelZoom(1.0F, -1.0F);
        return {};
    }

    void showAt(int left, int top) override { window_.showAt(left, top); }
    void hide() override { window_.hide(); }
    bool shown() const override { return window_.shown(); }

    bool displaysChanged() override {
        bool changed = false;
        while (!x_.lost() && XPending(x_.get()) > 0) {
            XEvent event;
            XNextEvent(x_.get(), &event);
            if (x_.lost()) break;
            changed |= event.type == randrEvent_ + RRScreenChangeNotify || event.type == randrEvent_ + RRNotify;
            window_.heard(event);
        }
        return changed;
    }

    Result<Swapped> swap(const VideoFrame& frame, bool checked) override {
        assert(frame.size() == size_ && frame.channels() == 3);
        glDrawPixels(size_.width, size_.height, GL_RGB, GL_UNSIGNED_BYTE, frame.pixels().data());
        if (checked && !cameBack(frame))
            return fail(Fault::device,
                        "The graphics driver changes the values of pixels on their way to the projector; its "
                        "patterns would show something else. Use another driver.");
        glXSwapBuffers(x_.get(), surface_);
        glFinish();
        Swapped swapped;
        std::int64_t ust_us = 0, msc = 0, sbc = 0;
        const bool told =
            waitForSbc_ != nullptr && !x_.lost() && waitForSbc_(x_.get(), surface_, 0, &ust_us, &msc, &sbc) != 0;
        (void)x_.accepted();
        if (x_.lost()) return fail(Fault::device, "The display server is gone.");
        swapped.at = std::chrono::steady_clock::now().time_since_epoch();
        const std::chrono::nanoseconds at = std::chrono::microseconds(ust_us);
        // Drivers count that time by the same clock; one that does not is not believed.
        if (told && at <= swapped.at && swapped.at - at < std::chrono::seconds(1)) swapped = {at, msc};
        return swapped;
    }

private:
    bool cameBack(const VideoFrame& frame) const {
        std::vector<std::uint8_t> back(frame.pixels().size());
        glReadBuffer(GL_BACK);
        glReadPixels(0, 0, size_.width, size_.height, GL_RGB, GL_UNSIGNED_BYTE, back.data());
        for (int y = 0; y < size_.height; ++y) {
            const std::uint8_t* drawn = back.data() + static_cast<std::size_t>(size_.height - 1 - y) * frame.stride();
            if (std::memcmp(drawn, frame.row(y), frame.stride()) != 0) return false;
        }
        return true;
    }

    XConnection& x_;
    Size size_;
    CoverWindow window_;
    GLXContext context_;
    GLXWindow surface_ = 0;
    WaitForSbc waitForSbc_ = nullptr;
    int randrEvent_ = 0;
};

}  // namespace

Result<std::unique_ptr<SwapWindow>> SwapWindow::open(XConnection& x, Size size) {
    int error = 0, event = 0;
    if (!glXQueryExtension(x.get(), &error, &event)) return noOpenGl("it has no GLX");
    const Choice choice = chosenConfig(x.get());
    if (choice.config == nullptr) return noOpenGl("no window of 8 bits a channel can be had");
    const GLXContext context = glXCreateNewContext(x.get(), choice.config, GLX_RGBA_TYPE, nullptr, True);
    if (context == nullptr || !x.accepted()) return noOpenGl("its OpenGL gives no context");
    auto window = std::make_unique<GlxWindow>(x, size, choice, context);
    if (auto ready = window->prepared(); !ready) return tl::unexpected(ready.error());
    return window;
}

}  // namespace ilf::devices
