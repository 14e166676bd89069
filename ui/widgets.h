// Small pieces panels are made of: chips, icon buttons, value rows and number fields.
#pragma once

#include <imgui.h>

#include <optional>
#include <string>

#include "ui/panel.h"
#include "ui/theme.h"
#include "ui/units.h"

namespace ilf::ui {

inline ImVec2 vec(Point<WidgetFrame> p) { return {static_cast<float>(p.x), static_cast<float>(p.y)}; }
inline ImVec2 vec(double x, double y) { return {static_cast<float>(x), static_cast<float>(y)}; }

/// A fixed undecorated window over `rect`; always pair with ImGui::End().
bool beginPanel(const char* id, const Rect& rect, ImU32 ground = colour::panel, bool padded = true,
                bool scrolls = false);

/// Hides a panel's text from focus order while no text is typed, so that Tab stays a command.
ImGuiWindowFlags fixedFlags();

/// Push/pop of a font and colour around a text.
void text(const std::string& words, ImU32 ink = colour::text, Font which = Font::body);
void wrapped(const std::string& words, ImU32 ink = colour::text, Font which = Font::body);
/// Wrapped, at most `width` pixels wide, in the last item's tooltip.
void tooltip(const std::string& words);
/// Title and key of a command, then its sentence, and `reason` when it is disabled.
void commandTooltip(Command command, const std::string& reason = {});
/// A small heading in dim capitals.
void heading(const std::string& words);

/// A flat square button that shows an icon, or `word` without the icon font. `on` draws it pressed in.
bool iconButton(const char* id, const char* icon, const char* word, bool on, float side, ImU32 ink = colour::text);
/// Says a state: a coloured dot and words.
bool chip(const char* id, const std::string& words, ImU32 dot, const std::string& more);
/// One of several choices that lie side by side; gives the one clicked.
std::optional<int> choice(const char* id, std::initializer_list<const char*> names, int current, float width);
/// A filled swatch in a look's hue and pattern.
void lookSwatch(ImDrawList& draw, ImVec2 from, ImVec2 to, Look look, float scale);

/// What a field asks for: a value while scrubbing (`commits` false), then one that stays.
struct FieldChange {
    double value = 0.0;
    bool commits = false;
};
struct FieldSpec {
    Unit unit = Unit::number;
    double low = 0.0, high = 1.0;  ///< SI
    double perPixel = 0.0;         ///< SI per pixel of scrubbing; 0: by 0.5 % of the value
    const char* help = "";         ///< tooltip
};
/// A number with its unit: click to type, drag to scrub, Shift for a tenth. A refused text stays, with its sentence.
std::optional<FieldChange> numberField(Panel& p, const char* id, double value, const FieldSpec& spec,
                                       float width = 0.0f, bool takeFocus = false);
/// A label on the left, then the field in a column of its own.
std::optional<FieldChange> numberRow(Panel& p, const char* label, const char* id, double value, const FieldSpec& spec,
                                     bool takeFocus = false);
/// A label and a value that the program worked out: set differently from what the operator set.
void derivedRow(Panel& p, const char* label, const std::string& value, const char* help = "");
/// The label of a row whose value the caller draws next, at the same column.
void rowLabel(Panel& p, const char* label, const char* help = "");

}  // namespace ilf::ui
