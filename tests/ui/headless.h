// The window without a window: an ImGui context whose mouse and keys a test moves, and a stand-in for the app.
#pragma once

#include <imgui.h>
#include <imgui_internal.h>

#include <functional>
#include <initializer_list>
#include <string>
#include <string_view>

#include "core/document/history.h"
#include "ui/keys.h"
#include "ui/studio.h"
#include "ui/theme.h"

namespace ilf::ui::test {

/// Name of the child window that a page scrolls in: that of its parent and the number it is begun with.
inline const char* pageWindow(Page page) {
    static constexpr const char* kNames[] = {"###pages/00000001", "###pages/00000002", "###pages/00000003",
                                             "###pages/00000004", "###pages/00000005", "###pages/00000006",
                                             "###pages/00000007"};
    return kNames[static_cast<int>(page)];
}

/// One ImGui context of its own, with fonts and theme, and no backend.
class Headless {
public:
    explicit Headless(Size window = {1280, 720}, double scale = 1.0) {
        ImGui::SetCurrentContext(ImGui::CreateContext());
        ImGuiIO& io = ImGui::GetIO();
        io.IniFilename = nullptr;
        io.DisplaySize = {static_cast<float>(window.width), static_cast<float>(window.height)};
        io.DeltaTime = 1.0f / 60.0f;
        io.MousePos = {-100, -100};
        // As the window's backend maps them: native numbers.
        io.KeyMap[ImGuiKey_Tab] = keys::tab;
        io.KeyMap[ImGuiKey_Enter] = keys::enter;
        io.KeyMap[ImGuiKey_KeyPadEnter] = keys::kpEnter;
        io.KeyMap[ImGuiKey_Escape] = keys::escape;
        io.KeyMap[ImGuiKey_Backspace] = keys::backspace;
        io.KeyMap[ImGuiKey_A] = keys::letter('A');
        loadFonts(scale);
        applyTheme(scale);
        unsigned char* pixels = nullptr;
        int width = 0, height = 0;
        io.Fonts->GetTexDataAsRGBA32(&pixels, &width, &height);
        atlas_ = {width, height};
        io.Fonts->SetTexID(reinterpret_cast<ImTextureID>(pixels));
    }
    ~Headless() { ImGui::DestroyContext(); }
    Headless(const Headless&) = delete;
    Headless& operator=(const Headless&) = delete;

    template <class Draw>
    auto frame(Draw draw) {
        ImGui::NewFrame();
        auto result = draw();
        ImGui::Render();
        return result;
    }
    /// The id of a widget by its window and path: `id("###seam", {"###feather"})`.
    static ImGuiID id(const char* window, std::initializer_list<const char*> path) {
        ImGuiWindow* found = ImGui::FindWindowByName(window);
        if (found == nullptr) return 0;
        ImGuiID at = found->ID;
        for (const char* step : path)
            at = ImHashStr(step, 0, at);
        return at;
    }
    /// Presses a widget in the next frame, as Enter on it would.
    static void activate(ImGuiID widget) { ImGui::ActivateItem(widget); }
    Size atlas() const { return atlas_; }

private:
    Size atlas_;
};

/// The studio over a document, with requests folded into a history as the app does.
class Desk {
public:
    explicit Desk(Document document, Size window = {1280, 720}, double scale = 1.0)
        : gui(window, scale), history(std::move(document)), scale_(scale) {
        state.hintsUsed = {Hint::brush, Hint::distance, Hint::take};
        settle();
    }

    Headless gui;
    State state;
    History history;
    Input input;
    Requests asked;                    ///< of the last frame
    std::function<void(View&)> dress;  ///< changes the view before it is drawn
    std::string refusal;               ///< of the last edit that core refused

    const Document& document() const { return history.current(); }

    Requests frame() {
        View view{document()};
        view.undoLabel = history.undoLabel();
        view.redoLabel = history.redoLabel();
        view.time_s = time_s_ += 1.0 / 60.0;
        view.scale = scale_;
        view.core.connected = true;
        view.core.light = Light::slotted;
        view.core.projectorWell = view.core.lensWell = true;
        if (!(planFor_ == document())) {
            planFor_ = document();
            plan_ = ilf::plan(planInput(planFor_));
        }
        if (plan_)
            view.computed.plan = *plan_;
        else
            view.computed.planError = plan_.error().what;
        view.computed.forCurrent = true;
        if (dress) dress(view);
        onePage_ = view.registering.has_value();
        asked = gui.frame([&] { return studio(view, state, input); });
        input = {};
        for (const Request& request : asked)
            handle(request);
        return asked;
    }
    void settle() {
        for (int i = 0; i < 3; ++i)
            frame();
    }

    void move(Point<WidgetFrame> to) { ImGui::GetIO().MousePos = {static_cast<float>(to.x), static_cast<float>(to.y)}; }
    /// Requests of press and release together.
    Requests click(Point<WidgetFrame> at, int button = 0) {
        move(at);
        frame();
        ImGui::GetIO().MouseDown[button] = true;
        Requests all = frame();
        ImGui::GetIO().MouseDown[button] = false;
        for (const Request& request : frame())
            all.push_back(request);
        // Two clicks of a test are no double-click.
        for (int i = 0; i < 30; ++i)
            frame();
        return all;
    }
    Requests drag(std::initializer_list<Point<WidgetFrame>> way) {
        Requests all;
        const auto collect = [&] {
            for (const Request& request : frame())
                all.push_back(request);
        };
        move(*way.begin());
        frame();
        ImGui::GetIO().MouseDown[0] = true;
        collect();
        for (const auto& at : way) {
            move(at);
            collect();
        }
        ImGui::GetIO().MouseDown[0] = false;
        collect();
        return all;
    }
    Requests key(int key, bool ctrl = false, bool shift = false) {
        input.pressed.push_back({key, ctrl, shift, false, false});
        Requests all = frame();
        input.released.push_back({key, ctrl, shift, false, false});
        for (const Request& request : frame())
            all.push_back(request);
        return all;
    }
    /// Types into the field that has the keyboard, then Enter.
    Requests type(std::string_view text) {
        for (const char c : text)
            ImGui::GetIO().AddInputCharacter(static_cast<unsigned char>(c));
        frame();
        return nativeKey(keys::enter);
    }
    Requests nativeKey(int key) {
        ImGui::GetIO().KeysDown[key] = true;
        Requests all = frame();
        ImGui::GetIO().KeysDown[key] = false;
        for (const Request& request : frame())
            all.push_back(request);
        return all;
    }
    Requests press(const char* window, std::initializer_list<const char*> path) {
        Headless::activate(Headless::id(window, path));
        Requests all = frame();
        for (const Request& request : frame())
            all.push_back(request);
        return all;
    }
    /// Where a picture pixel lies in the window.
    Point<WidgetFrame> at(double x, double y) const {
        const Rect canvas = areas().canvas;
        return {canvas.x + canvas.w / 2 + (x - state.centre.x) * state.zoom,
                canvas.y + canvas.h / 2 + (y - state.centre.y) * state.zoom};
    }
    Layout areas() const {
        const ImVec2 size = ImGui::GetIO().DisplaySize;
        return layout({static_cast<int>(size.x), static_cast<int>(size.y)}, scale_, state.panels, onePage_);
    }

private:
    void handle(const Request& request) {
        if (const auto* edit = std::get_if<EditRequest>(&request)) {
            auto next = edited(document(), edit->edit);
            if (!next) {
                refusal = next.error().what;
                return;
            }
            history.preview(*std::move(next));
            if (edit->when == EditRequest::When::commit) history.commit(label(edit->edit));
        } else if (const auto* commit = std::get_if<CommitGesture>(&request)) {
            history.commit(commit->label);
        } else if (std::get_if<CancelGesture>(&request)) {
            history.cancel();
        } else if (const auto* command = std::get_if<RunCommand>(&request)) {
            if (command->command == Command::undo) history.undo();
            if (command->command == Command::redo) history.redo();
        }
    }

    double scale_ = 1.0, time_s_ = 0.0;
    bool onePage_ = false;  ///< of the last frame
    Document planFor_;
    Result<Plan> plan_ = fail(Fault::notFound, "nothing planned");
};

/// 320x240 pixels with two regions: "Face" focus at 1.2 m, "Clutter" blur at 0.5 m; the second lies on the right.
inline Document twoRegions(Size size = {320, 240}) {
    std::vector<std::uint16_t> pixels(static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height) * 3);
    for (std::size_t i = 0; i < pixels.size(); ++i)
        pixels[i] = static_cast<std::uint16_t>(20000 + (i * 37) % 9000);
    Scene scene;
    scene.picture = Box<Picture>(Picture(size, 3, std::move(pixels)));
    scene.source = "test";
    scene.scale = {focalPixels(size.width, kDefaultFieldOfView), PixelScale::Source::assumed};
    Document document = newDocument(std::move(scene));
    const auto region = [&](const char* name, Look look, Metre distance, double x0, double x1) {
        Region added;
        added.id = added.name = name;
        added.look = look;
        added.distance = ConstantDistance{distance, {}};
        document = *edited(std::move(document), AddRegion{added, 0});
        document = *edited(std::move(document), FillShape{name, Rectangle{{x0 * size.width, 0.2 * size.height},
                                                                          {x1 * size.width, 0.8 * size.height}}});
    };
    region("Face", Look::focus, 1.2_m, 0.1, 0.4);
    region("Clutter", Look::blur, 0.5_m, 0.6, 0.9);
    return document;
}

/// The first request of a kind, or nullptr.
template <class Kind>
const Kind* first(const Requests& requests) {
    for (const Request& request : requests) {
        if (const auto* found = std::get_if<Kind>(&request)) return found;
    }
    return nullptr;
}
/// The last edit of a kind, or nullptr; `when` tells previews from commits.
template <class Kind>
const Kind* lastEdit(const Requests& requests, EditRequest::When when) {
    const Kind* found = nullptr;
    for (const Request& request : requests) {
        const auto* edit = std::get_if<EditRequest>(&request);
        if (edit == nullptr || edit->when != when) continue;
        if (const auto* kind = std::get_if<Kind>(&edit->edit)) found = kind;
    }
    return found;
}
inline bool asks(const Requests& requests, Command command) {
    for (const Request& request : requests) {
        const auto* run = std::get_if<RunCommand>(&request);
        if (run != nullptr && run->command == command) return true;
    }
    return false;
}

}  // namespace ilf::ui::test
