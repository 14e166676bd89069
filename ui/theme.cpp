#include "ui/theme.h"

#include <imgui_freetype.h>

#include <algorithm>
#include <filesystem>

#include "ui/icons.h"

namespace ilf::ui {

ImU32 lookColour(Look look) {
    switch (look) {
    case Look::focus:
        return colour::focus;
    case Look::blur:
        return colour::blur;
    case Look::neutral:
        break;
    }
    return colour::neutral;
}

const char* lookName(Look look) {
    switch (look) {
    case Look::focus:
        return "focus";
    case Look::blur:
        return "blur";
    case Look::neutral:
        break;
    }
    return "neutral";
}

void loadFonts(double scale, const FontPaths& paths) {
    // Latin with its extensions, Greek, and the few signs the texts use. Static: ImGui keeps the pointer.
    static constexpr ImWchar letters[] = {0x20,   0x17F,  0x370,  0x3FF,  0x2010, 0x2044, 0x2070, 0x209F,
                                          0x2190, 0x21FF, 0x2200, 0x22FF, 0x2300, 0x23CF, 0};
    static constexpr ImWchar signs[] = {icon::first, icon::last, 0};
    ImFontAtlas& atlas = *ImGui::GetIO().Fonts;
    atlas.FontBuilderIO = ImGuiFreeType::GetBuilderForFreeType();
    const auto there = [](const std::string& path) {
        std::error_code error;
        return std::filesystem::is_regular_file(path, error);
    };
    const auto add = [&](const std::string& path, double size) {
        const auto pixels = static_cast<float>(size * scale);
        if (!there(path)) {
            ImFontConfig builtIn;
            builtIn.SizePixels = pixels;
            atlas.AddFontDefault(&builtIn);
        } else {
            atlas.AddFontFromFileTTF(path.c_str(), pixels, nullptr, letters);
        }
        if (!there(paths.icons)) return;
        ImFontConfig merged;
        merged.MergeMode = true;
        merged.PixelSnapH = true;
        merged.GlyphMinAdvanceX = pixels * 1.1f;
        atlas.AddFontFromFileTTF(paths.icons.c_str(), pixels, &merged, signs);
    };
    add(paths.text, 15.0);
    add(paths.text, 12.5);
    add(paths.strong, 15.0);
}

bool hasIcons() {
    const ImFont* body = font(Font::body);
    return body != nullptr && body->FindGlyphNoFallback(icon::first) != nullptr;
}

ImFont* font(Font which) {
    const auto& fonts = ImGui::GetIO().Fonts->Fonts;
    if (fonts.empty()) return nullptr;
    return fonts[std::min(static_cast<int>(which), fonts.Size - 1)];
}

void applyTheme(double scale) {
    ImGuiStyle style;
    style.WindowPadding = {12, 10};
    style.FramePadding = {8, 5};
    style.ItemSpacing = {8, 7};
    style.ItemInnerSpacing = {6, 4};
    style.WindowRounding = 0;
    style.ChildRounding = style.FrameRounding = style.PopupRounding = style.GrabRounding = style.TabRounding = 4;
    style.ScrollbarRounding = 4;
    style.ScrollbarSize = 10;
    style.WindowBorderSize = 0;
    style.PopupBorderSize = 1;
    style.FrameBorderSize = 0;
    style.ScaleAllSizes(static_cast<float>(scale));

    const auto set = [&](ImGuiCol slot, ImU32 value) { style.Colors[slot] = ImGui::ColorConvertU32ToFloat4(value); };
    for (int i = 0; i < ImGuiCol_COUNT; ++i)
        set(i, colour::line);
    set(ImGuiCol_Text, colour::text);
    set(ImGuiCol_TextDisabled, colour::dim);
    set(ImGuiCol_WindowBg, colour::panel);
    set(ImGuiCol_ChildBg, rgb(0, 0));
    set(ImGuiCol_PopupBg, colour::raised);
    set(ImGuiCol_Border, rgb(0x343C48));
    set(ImGuiCol_BorderShadow, rgb(0, 0));
    set(ImGuiCol_FrameBg, rgb(0x0C0F12));
    set(ImGuiCol_FrameBgHovered, rgb(0x20262F));
    set(ImGuiCol_FrameBgActive, rgb(0x262D37));
    set(ImGuiCol_TitleBg, colour::panel);
    set(ImGuiCol_TitleBgActive, colour::panel);
    set(ImGuiCol_MenuBarBg, colour::panel);
    set(ImGuiCol_ScrollbarBg, rgb(0, 0));
    set(ImGuiCol_ScrollbarGrab, rgb(0x343C48));
    set(ImGuiCol_ScrollbarGrabHovered, rgb(0x465162));
    set(ImGuiCol_ScrollbarGrabActive, rgb(0x5A6779));
    set(ImGuiCol_CheckMark, colour::text);
    set(ImGuiCol_SliderGrab, rgb(0x5A6779));
    set(ImGuiCol_SliderGrabActive, colour::dim);
    set(ImGuiCol_Button, rgb(0x232932));
    set(ImGuiCol_ButtonHovered, rgb(0x2E3642));
    set(ImGuiCol_ButtonActive, rgb(0x3A4453));
    set(ImGuiCol_Header, rgb(0x2A323D));
    set(ImGuiCol_HeaderHovered, rgb(0x2E3642));
    set(ImGuiCol_HeaderActive, rgb(0x3A4453));
    set(ImGuiCol_SeparatorHovered, colour::dim);
    set(ImGuiCol_SeparatorActive, colour::text);
    set(ImGuiCol_TextSelectedBg, rgb(0x3B5B80));
    set(ImGuiCol_NavHighlight, colour::dim);
    set(ImGuiCol_ModalWindowDimBg, rgb(0x05070A, 160));
    set(ImGuiCol_TableRowBg, rgb(0, 0));
    set(ImGuiCol_TableRowBgAlt, rgb(0xffffff, 6));
    ImGui::GetStyle() = style;
}

}  // namespace ilf::ui
