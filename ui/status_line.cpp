// The line at the bottom: what is under the cursor, what took how long, when it was saved.
#include <cmath>

#include "core/document/region_at.h"
#include "ui/canvas.h"
#include "ui/devices_card.h"
#include "ui/widgets.h"

namespace ilf::ui {

namespace {

std::string milliseconds(double ms) {
    std::string text = std::to_string(ms < 10 ? std::round(ms * 10) / 10 : std::round(ms));
    return text.substr(0, text.find('.') + (ms < 10 ? 2U : 0U)) + " ms";
}

std::string ago(double seconds) {
    if (seconds < 1.5) return "just now";
    if (seconds < 90) return std::to_string(static_cast<int>(seconds)) + " s ago";
    if (seconds < 5400) return std::to_string(static_cast<int>(seconds / 60)) + " min ago";
    return std::to_string(static_cast<int>(seconds / 3600)) + " h ago";
}

/// Pixel, region, distance, and the power that has this distance in focus.
std::string underCursor(const Panel& p) {
    if (!p.state.cursor) return "";
    const Point<CameraFrame> at = *p.state.cursor;
    std::string words = std::to_string(static_cast<int>(at.x)) + ", " + std::to_string(static_cast<int>(at.y)) + " px";
    const Region* region = regionAt(p.document(), at);
    if (region == nullptr && p.document().background) region = &*p.document().background;
    if (region == nullptr) return words;
    words += "   " + region->name;
    if (const auto distance = distanceAt(p.document(), *region, at); distance && *distance > 0.0_m) {
        words += "   " + formatted(*distance) + "   " + formatted(1.0 / *distance);
    } else {
        words += "   no depth here";
    }
    return words;
}

}  // namespace

void statusLine(Panel& p) {
    if (p.at.status.empty()) return;
    beginPanel("###status", p.at.status, rgb(0x0C0F12), false);
    const View& view = p.view;
    ImFont* small = font(Font::small);
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    const double y = p.at.status.y + (p.at.status.h - static_cast<double>(small->FontSize)) / 2;
    const auto put = [&](double x, const std::string& words, ImU32 ink) {
        draw.AddText(small, small->FontSize, vec(x, y), ink, words.c_str());
        return x + static_cast<double>(small->CalcTextSizeA(small->FontSize, 8192, 0, words.c_str()).x);
    };
    const auto width = [&](const std::string& words) {
        return static_cast<double>(small->CalcTextSizeA(small->FontSize, 8192, 0, words.c_str()).x);
    };
    put(p.at.status.x + 14 * p.scale, underCursor(p), colour::text);

    const Computed& computed = view.computed;
    std::string times = "plan " + milliseconds(computed.plan_ms) + "   compile " + milliseconds(computed.compile_ms) +
                        "   view " + milliseconds(computed.view_ms);
    if (!computed.viewRung.empty()) times += " (" + computed.viewRung + ")";
    if (!computed.forCurrent) times += "  \u2026";
    std::string light = "light unknown";
    ImU32 ink = colour::fault;
    if (view.core.connected && view.core.light == Light::slotted) {
        light = "light +" + milliseconds(view.core.strokeToSwap_ms) +
                (view.core.simulated ? ", " + kindOf(view.core) : std::string());
        ink = colour::good;
    } else if (view.core.connected && view.core.light == Light::steady) {
        light = "steady light";
        ink = colour::safe;
    }
    std::string saved = view.fileName.empty() ? "untitled" : view.unsaved ? "changed" : "saved";
    if (view.savedAgo_s >= 0.0) saved = (view.unsaved ? "changed, saved " : "saved ") + ago(view.savedAgo_s);
    const double gap = 22 * p.scale, right = p.at.status.right() - 14 * p.scale;
    double x = right - width(saved);
    put(x, saved, view.unsaved ? colour::warn : colour::dim);
    x -= gap + width(light);
    put(x, light, ink);
    x -= gap + width(times);
    put(x, times, computed.planError.empty() ? colour::dim : colour::fault);
    ImGui::End();
}

}  // namespace ilf::ui
