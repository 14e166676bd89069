#include "app/window/window.h"

#include <epoxy/gl.h>
// After epoxy, which brings its own GL declarations.
#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <imgui.h>

namespace ilf::app {
namespace {

std::string lastGlfwSentence;

Window& owner(GLFWwindow* window) { return *static_cast<Window*>(glfwGetWindowUserPointer(window)); }

std::array<bool, 3> buttons(GLFWwindow* window) {
    return {glfwGetMouseButton(window, GLFW_MOUSE_BUTTON_LEFT) == GLFW_PRESS,
            glfwGetMouseButton(window, GLFW_MOUSE_BUTTON_RIGHT) == GLFW_PRESS,
            glfwGetMouseButton(window, GLFW_MOUSE_BUTTON_MIDDLE) == GLFW_PRESS};
}

}  // namespace

Result<std::unique_ptr<Window>> Window::open(const std::string& title, Size size, double uiScale) {
    glfwSetErrorCallback([](int, const char* text) { lastGlfwSentence = text; });
    if (glfwInit() == 0) {
        return fail(Fault::unsupported, "No window can be opened (" + lastGlfwSentence +
                                            "): log in to a desktop, or use --headless, plan, render or run.");
    }
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
    glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
    glfwWindowHintString(GLFW_X11_CLASS_NAME, "IlluminatedFocus");
    auto window = std::unique_ptr<Window>(new Window);
    window->window_ = glfwCreateWindow(size.width, size.height, title.c_str(), nullptr, nullptr);
    if (window->window_ == nullptr) {
        return fail(Fault::unsupported, "No window with OpenGL 3.3 can be opened (" + lastGlfwSentence +
                                            "): update the graphics driver, or set LIBGL_ALWAYS_SOFTWARE=1.");
    }
    glfwMakeContextCurrent(window->window_);
    glfwSwapInterval(1);
    float x = 1.0F, y = 1.0F;
    glfwGetWindowContentScale(window->window_, &x, &y);
    window->scale_ = uiScale > 0.0 ? uiScale : std::max(1.0, static_cast<double>(x));
    glfwSetWindowSizeLimits(window->window_, 640, 400, GLFW_DONT_CARE, GLFW_DONT_CARE);
    window->installCallbacks();

    IMGUI_CHECKVERSION();
    ImGui::CreateContext();
    ImGui::GetIO().IniFilename = nullptr;  // the layout is a pure function of the window; see ui/layout.h
    ui::applyTheme(window->scale_);
    ui::loadFonts(window->scale_);
    ImGui_ImplGlfw_InitForOpenGL(window->window_, true);  // chains to the callbacks installed above
    ImGui_ImplOpenGL3_Init("#version 330");
    window->backends_ = true;
    return window;
}

Window::~Window() {
    if (backends_) {
        ImGui_ImplOpenGL3_Shutdown();
        ImGui_ImplGlfw_Shutdown();
        ImGui::DestroyContext();
    }
    if (window_ != nullptr) glfwDestroyWindow(window_);
    glfwTerminate();
}

void Window::installCallbacks() {
    glfwSetWindowUserPointer(window_, this);
    glfwSetCursorPosCallback(window_, [](GLFWwindow* w, double x, double y) {
        const auto down = buttons(w);
        owner(w).input_.trail.push_back({{x, y}, glfwGetTime(), down[0], down[1], down[2]});
    });
    glfwSetMouseButtonCallback(window_, [](GLFWwindow* w, int, int, int) {
        double x = 0.0, y = 0.0;
        glfwGetCursorPos(w, &x, &y);
        const auto down = buttons(w);
        owner(w).input_.trail.push_back({{x, y}, glfwGetTime(), down[0], down[1], down[2]});
    });
    glfwSetKeyCallback(window_, [](GLFWwindow* w, int key, int, int action, int mods) {
        if (key == GLFW_KEY_UNKNOWN) return;  // typed characters without a key of their own
        const ui::KeyPress press{key, (mods & GLFW_MOD_CONTROL) != 0, (mods & GLFW_MOD_SHIFT) != 0,
                                 (mods & GLFW_MOD_ALT) != 0, action == GLFW_REPEAT};
        (action == GLFW_RELEASE ? owner(w).input_.released : owner(w).input_.pressed).push_back(press);
    });
    glfwSetDropCallback(window_, [](GLFWwindow* w, int count, const char** paths) {
        for (int i = 0; i < count; ++i)
            owner(w).dropped_.emplace_back(paths[i]);
    });
}

bool Window::shouldClose() const { return glfwWindowShouldClose(window_) != 0; }
void Window::setTitle(const std::string& title) { glfwSetWindowTitle(window_, title.c_str()); }

void Window::toggleFullScreen() {
    if (glfwGetWindowMonitor(window_) != nullptr) {
        glfwSetWindowMonitor(window_, nullptr, windowed_.x0, windowed_.y0, windowed_.width(), windowed_.height(), 0);
        return;
    }
    GLFWmonitor* monitor = glfwGetPrimaryMonitor();
    if (monitor == nullptr) return;
    int x = 0, y = 0, width = 0, height = 0;
    glfwGetWindowPos(window_, &x, &y);
    glfwGetWindowSize(window_, &width, &height);
    windowed_ = {x, y, x + width, y + height};
    const GLFWvidmode* mode = glfwGetVideoMode(monitor);
    glfwSetWindowMonitor(window_, monitor, 0, 0, mode->width, mode->height, mode->refreshRate);
}

void Window::waitEvents(double seconds) {
    if (seconds <= 0.0) {
        glfwPollEvents();
    } else {
        glfwWaitEventsTimeout(seconds);
    }
}

void Window::wake() { glfwPostEmptyEvent(); }

void Window::beginFrame() {
    ImGui_ImplOpenGL3_NewFrame();
    ImGui_ImplGlfw_NewFrame();
    ImGui::NewFrame();
}

void Window::draw() {
    ImGui::Render();
    int width = 0, height = 0;
    glfwGetFramebufferSize(window_, &width, &height);
    glViewport(0, 0, width, height);
    glClearColor(0.0F, 0.0F, 0.0F, 1.0F);
    glClear(GL_COLOR_BUFFER_BIT);
    ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
    if (std::exchange(capture_, false)) capture(width, height);  // before the swap: the back buffer is lost with it
}

void Window::swap() { glfwSwapBuffers(window_); }

void Window::capture(int width, int height) {
    const auto stride = static_cast<std::size_t>(width) * 3;
    std::vector<std::uint8_t> upsideDown(stride * static_cast<std::size_t>(height)), rgb(upsideDown.size());
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glReadPixels(0, 0, width, height, GL_RGB, GL_UNSIGNED_BYTE, upsideDown.data());
    for (std::size_t y = 0; y < static_cast<std::size_t>(height); ++y) {
        const auto* from = &upsideDown[(static_cast<std::size_t>(height) - 1 - y) * stride];
        std::copy(from, from + stride, &rgb[y * stride]);
    }
    captured_ = Image<std::uint8_t>({width, height}, 3, std::move(rgb));
}

ui::Input Window::takeInput() {
    ui::Input taken = std::exchange(input_, {});
    if (taken.trail.empty()) {  // the canvas wants to know where the pointer rests
        double x = 0.0, y = 0.0;
        glfwGetCursorPos(window_, &x, &y);
        const auto down = buttons(window_);
        taken.trail.push_back({{x, y}, glfwGetTime(), down[0], down[1], down[2]});
    }
    return taken;
}

std::vector<std::string> Window::takeDroppedFiles() { return std::exchange(dropped_, {}); }

}  // namespace ilf::app
