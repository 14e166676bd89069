// The look of the window: a palette for a dark gallery, fonts, and what each region look is drawn like.
#pragma once

#include <imgui.h>

#include <string>

#include "core/document/document.h"

namespace ilf::ui {

/// 0xRRGGBB as ImGui packs it, with alpha 0..255.
constexpr ImU32 rgb(unsigned hex, unsigned alpha = 255) {
    return ((hex >> 16) & 0xffU) | (hex & 0xff00U) | ((hex & 0xffU) << 16) | (alpha << 24);
}
/// The same colour, more transparent.
constexpr ImU32 faded(ImU32 colour, double alpha) {
    return (colour & 0x00ffffffU) | (static_cast<ImU32>(alpha * static_cast<double>(colour >> 24)) << 24);
}

/// A little darker than a desktop would be: the window's light spoils the effect in the room (under 3 cd/m2 on
/// average). Text on ground has a contrast of 11:1, dim text 5:1 (used for units and axes only).
namespace colour {
inline constexpr ImU32 ground = rgb(0x0B0E11), panel = rgb(0x101419), raised = rgb(0x1B2027), line = rgb(0x252B34),
                       text = rgb(0xC9D1DB), dim = rgb(0x7C8796), focus = rgb(0x4FA3FF), blur = rgb(0xFF9F45),
                       neutral = rgb(0xA5AFBD), good = rgb(0x58C48A), warn = rgb(0xE8C24A), fault = rgb(0xFF5D6C),
                       safe = rgb(0xFFFFFF), safeGround = rgb(0x2A2F38), derived = rgb(0xA9B7C8);
}

ImU32 lookColour(Look look);
const char* lookName(Look look);

enum class Font { body, small, strong };
struct FontPaths {
    std::string text = "/usr/share/fonts/opentype/inter/Inter-Regular.otf";
    std::string strong = "/usr/share/fonts/opentype/inter/Inter-SemiBold.otf";
    std::string icons = "/usr/share/fonts/truetype/font-awesome/fontawesome-webfont.ttf";
};
/// Adds the fonts to the current context's atlas, at 15 px times `scale`; ImGui's own font where a file is absent.
/// Call before the first frame, or between frames after clearing the atlas.
void loadFonts(double scale, const FontPaths& paths = {});
/// False when the icon font was absent: buttons then show words.
bool hasIcons();
ImFont* font(Font font);

/// Colours and metrics of ImGui's style.
void applyTheme(double scale);

}  // namespace ilf::ui
