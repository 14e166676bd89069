// The window: GLFW, Dear ImGui's backends, and what keyboard, pointer and drops did since the last frame.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/base/geometry.h"
#include "core/base/image.h"
#include "core/base/result.h"
#include "ui/studio.h"
#include "ui/theme.h"

struct GLFWwindow;

namespace ilf::app {

/// One window with one GL context; everything is called from the main thread, except `wake`.
class Window {
public:
    static Result<std::unique_ptr<Window>> open(const std::string& title, Size size, double uiScale);
    ~Window();
    Window(const Window&) = delete;
    Window& operator=(const Window&) = delete;

    bool shouldClose() const;
    void setTitle(const std::string& title);
    void toggleFullScreen();
    double contentScale() const { return scale_; }

    /// Waits at most `seconds` for something to happen, or until `wake`.
    void waitEvents(double seconds);
    /// May be called from any thread.
    static void wake();

    void beginFrame();
    /// Submits what was built.
    void draw();
    /// Shows what was drawn. Software GL fills the pixels here.
    void swap();
    /// The next frame is also kept as a picture, RGB; for `--screenshot`.
    void captureNext() { capture_ = true; }
    const Image<std::uint8_t>& captured() const { return captured_; }

    /// What happened since the last call.
    ui::Input takeInput();
    std::vector<std::string> takeDroppedFiles();

private:
    Window() = default;
    void installCallbacks();
    void capture(int width, int height);

    GLFWwindow* window_ = nullptr;
    double scale_ = 1.0;
    ui::Input input_;
    std::vector<std::string> dropped_;
    PixelRect<WidgetFrame> windowed_;
    bool backends_ = false;
    bool capture_ = false;
    Image<std::uint8_t> captured_;
};

}  // namespace ilf::app
