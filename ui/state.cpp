#include "ui/state.h"

#include <algorithm>
#include <cmath>
#include <locale>
#include <sstream>

namespace ilf::ui {

namespace {

constexpr const char* kFormat = "illuminatedfocus-layout 1";

bool within(double value, double low, double high) { return std::isfinite(value) && value >= low && value <= high; }

bool sensible(const Brush& brush) {
    return within(brush.radius, 0.5, 2000) && within(brush.hardness, 0, 1) && within(brush.opacity, 0.01, 1);
}

}  // namespace

void say(State& state, std::string text, Tone tone, double time_s) {
    std::erase_if(state.toasts, [&](const Toast& toast) { return toast.text == text; });
    state.toasts.push_back({std::move(text), tone, time_s});
    // A screen full of sentences hides the picture; the newest matter.
    if (state.toasts.size() > 4) state.toasts.erase(state.toasts.begin());
}

std::string layoutText(const State& state) {
    std::ostringstream out;
    out.imbue(std::locale::classic());
    const auto brush = [&](const char* name, const Brush& b) {
        out << name << ' ' << b.radius << ' ' << b.hardness << ' ' << b.opacity << '\n';
    };
    out << kFormat << '\n';
    out << "side " << state.panels.side << "\ncharts " << state.panels.charts << "\nregions " << state.panels.regions
        << '\n';
    out << "page " << static_cast<int>(state.page) << '\n';
    brush("brush", state.brush);
    brush("eraser", state.eraser);
    for (const Hint hint : state.hintsUsed)
        out << "hint " << static_cast<int>(hint) << '\n';
    return out.str();
}

State withLayout(State state, const std::string& text) {
    std::istringstream lines(text);
    std::string line;
    if (!std::getline(lines, line) || line != kFormat) return state;
    State read = state;
    while (std::getline(lines, line)) {
        std::istringstream in(line);
        in.imbue(std::locale::classic());
        std::string key;
        in >> key;
        bool understood = true;
        int number = 0;
        if (key == "side") {
            understood = in >> read.panels.side && within(read.panels.side, 100, 4000);
        } else if (key == "charts") {
            understood = in >> read.panels.charts && within(read.panels.charts, 50, 4000);
        } else if (key == "regions") {
            understood = in >> read.panels.regions && within(read.panels.regions, 0, 1);
        } else if (key == "page") {
            understood = in >> number && number >= 0 && number <= static_cast<int>(Page::history);
            if (understood) read.page = static_cast<Page>(number);
        } else if (key == "brush" || key == "eraser") {
            Brush& brush = key == "brush" ? read.brush : read.eraser;
            understood = in >> brush.radius >> brush.hardness >> brush.opacity && sensible(brush);
        } else if (key == "hint") {
            understood = in >> number && number >= 0 && number <= static_cast<int>(Hint::take);
            if (understood) read.hintsUsed.insert(static_cast<Hint>(number));
        } else {
            understood = key.empty();
        }
        if (!understood) return state;
    }
    return read;
}

}  // namespace ilf::ui
