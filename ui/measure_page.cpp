#include "ui/measure_page.h"

#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <string>

#include "ui/widgets.h"

namespace ilf::ui {
namespace {

using Phase = MeasureView::State;

ImU32 inkOf(MeasureStanding standing) {
    switch (standing) {
    case MeasureStanding::waiting:
        return colour::dim;
    case MeasureStanding::now:
    case MeasureStanding::working:
        return colour::focus;
    case MeasureStanding::good:
        return colour::good;
    case MeasureStanding::bad:
        return colour::fault;
    }
    return colour::dim;
}

/// Beside the button before it, or below where there is no room.
bool button(Panel& p, const char* label, const char* help) {
    const float width = std::max(p.px(96), ImGui::CalcTextSize(label, nullptr, true).x + p.px(28));
    if (ImGui::GetContentRegionAvail().x < width) ImGui::NewLine();
    const bool pressed = ImGui::Button(label, {width, p.px(34)});
    tooltip(help);
    ImGui::SameLine();
    return pressed;
}

void ask(Panel& p, Measure::Step step) { p.requests.push_back(Measure{step}); }

/// Every step with its word, so that it is seen at once how far it is and what was not good.
void stepList(Panel& p, const MeasureView& m) {
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    int number = 0;
    for (const MeasureStepView& step : m.steps) {
        const ImU32 ink = inkOf(step.standing);
        const ImVec2 at = ImGui::GetCursorScreenPos();
        const float line = ImGui::GetTextLineHeight(), radius = p.px(4);
        const ImVec2 centre{at.x + radius + p.px(1), at.y + line / 2};
        if (step.standing == MeasureStanding::waiting || step.standing == MeasureStanding::now)
            draw.AddCircle(centre, radius, ink, 0, p.px(1.5));
        else
            draw.AddCircleFilled(centre, radius, ink);
        ImGui::SetCursorScreenPos({at.x + p.px(16), at.y});
        text(std::to_string(++number) + "  " + step.title,
             step.standing == MeasureStanding::waiting ? colour::dim : colour::text, Font::strong);
        const std::string state = word(step.standing);
        const float right = ImGui::GetWindowContentRegionMax().x;
        ImGui::SameLine(right - ImGui::CalcTextSize(state.c_str()).x);
        text(state, ink);
        if (!step.measured.empty()) {
            ImGui::SetCursorScreenPos({at.x + p.px(16), ImGui::GetCursorScreenPos().y});
            wrapped(step.measured, colour::derived, Font::small);
        }
        ImGui::Dummy({1, p.px(3)});
    }
}

/// What is known of the lens beforehand, and what shall be measured.
void setupForm(Panel& p, const MeasureView& m) {
    MeasureSetup& setup = p.state.measure;
    const float wide = std::min(p.px(360), ImGui::GetContentRegionAvail().x - p.px(118));
    text("Before the first step", colour::text, Font::strong);
    wrapped(m.emulated
                ? "An emulated bench in this program: laser, lens, photodiode and converter. What comes of it is "
                  "labelled emulated and says nothing of any glass."
                : "A laser goes through the lens onto a photodiode. The output core is stopped meanwhile: the "
                  "display stays white and nothing can be put on show until measuring ends.",
            colour::dim);
    ImGui::Dummy({1, p.px(4)});
    rowLabel(p, "Lens", "Whose lens is before the photodiode; the other one rests.");
    if (const auto eye = choice("###measureEye", {"Left", "Right"}, setup.eye == Eye::left ? 0 : 1, p.px(160)))
        setup.eye = *eye == 0 ? Eye::left : Eye::right;
    rowLabel(p, "Projector", "Its delay, from trigger to light, as a first step.");
    if (const auto delay = choice("###measureDelay", {"Measure", "Leave"}, setup.projector ? 0 : 1, p.px(160)))
        setup.projector = *delay == 0;
    if (m.emulated) {
        rowLabel(p, "Known powers");
        ImGui::AlignTextToFramePadding();
        text("as an emulated lensmeter tells them", colour::derived);
        rowLabel(p, "Temperature");
        ImGui::AlignTextToFramePadding();
        text("as the emulated lens says", colour::derived);
    } else {
        rowLabel(p, "Known powers",
                 "Two lines or more, \"milliamperes, dioptres\", from a lensmeter or the lens's certificate: a "
                 "photodiode alone knows no dioptres.");
        ImGui::InputTextMultiline("###measureKnown", &setup.known, {wide, p.px(86)});
        rowLabel(p, "Temperature", "Of the lens: its powers drift by 0.03 D for each degree.");
        ImGui::SetNextItemWidth(p.px(100));
        ImGui::InputTextWithHint("###measureTemperature", "30", &setup.temperature);
        ImGui::SameLine();
        text("\u00b0C", colour::dim);
        rowLabel(p, "Model");
        ImGui::SetNextItemWidth(wide);
        ImGui::InputText("###measureModel", &setup.model);
        rowLabel(p, "Serial");
        ImGui::SetNextItemWidth(wide);
        ImGui::InputText("###measureSerial", &setup.serial);
    }
    ImGui::Dummy({1, p.px(6)});
    if (button(p, "Begin###measureBegin", "What plays stops: steady light, lens at rest."))
        p.requests.push_back(StartMeasuring{setup});
    if (button(p, "Close###measureCancel", "")) ask(p, Measure::Step::cancel);
    ImGui::NewLine();
}

void lineOf(const char* label, const std::string& words) {
    text(label, colour::dim, Font::small);
    wrapped(words);
}

/// What to do, what is being done, and what came of it.
void currentStep(Panel& p, const MeasureView& m) {
    if (m.at >= m.steps.size()) return;
    const MeasureStepView& step = m.steps[m.at];
    text(std::to_string(m.at + 1) + " of " + std::to_string(m.steps.size()) + "  " + step.title, colour::text,
         Font::strong);
    lineOf("CONNECT", step.connect);
    lineOf("EXPECTED", step.expect);
    if (m.state == Phase::working) {
        text("Measuring" + (m.doing.empty() ? std::string(" \u2026") : ": " + m.doing), colour::focus);
    }
    if (m.state == Phase::judged) {
        const bool good = step.standing == MeasureStanding::good;
        if (!step.measured.empty()) lineOf("MEASURED", step.measured);
        wrapped(good ? "Good." : "Not good: " + step.advice, good ? colour::good : colour::fault);
    }
    ImGui::Dummy({1, p.px(4)});
    if (m.state == Phase::connecting && button(p, "Measure###measureGo", "Everything is connected as it says."))
        ask(p, Measure::Step::go);
    if (m.state == Phase::working) {  // keeps its place: a double click on "Measure" must not reach "Cancel"
        ImGui::BeginDisabled();
        button(p, "Measure###measureGo", "");
        ImGui::EndDisabled();
    }
    if (m.state == Phase::judged) {
        if (step.standing == MeasureStanding::good && button(p, "Next###measureNext", "")) ask(p, Measure::Step::next);
        if (button(p, "Again###measureAgain", "The same step once more; its outcome is forgotten."))
            ask(p, Measure::Step::again);
    }
    if (m.state != Phase::working && m.at > 0 &&
        button(p, "Back###measureBack", "The step before; what was measured from there on no longer counts."))
        ask(p, Measure::Step::back);
    if (button(p, "Cancel###measureCancel", "The lenses go to rest; nothing is written."))
        ask(p, Measure::Step::cancel);
    ImGui::NewLine();
}

void finished(Panel& p, const MeasureView& m) {
    text(m.state == Phase::stored ? "Stored" : "Every step was good", colour::good, Font::strong);
    wrapped(m.state == Phase::stored
                ? m.file
                : std::string("Waves, static powers, delay and temperature can be stored with where they come from: ") +
                      (m.emulated ? "an emulated bench, simulated." : "measured here and now."));
    if (m.state == Phase::stored) {
        wrapped(m.emulated ? "It can be looked at (lens info), but does not take the place of the rig's own numbers: "
                             "the bench's lens and projector are others than those the emulated rig plays on."
                           : "Nothing is planned with it yet. Once the project uses it, save the rig and open it: the "
                             "output core plays by the rig's file.",
                colour::dim);
    }
    ImGui::Dummy({1, p.px(4)});
    if (m.state == Phase::good) {
        if (button(p, "Store\u2026###measureStore", "One file, written whole or not at all.")) {
            p.state.measure.eye = m.eye;
            openFileDialog(p.state, FileDialog::Purpose::storeWaves, p.view);
        }
        if (button(p, "Back###measureBack", "The last step once more.")) ask(p, Measure::Step::back);
        if (button(p, "Discard###measureCancel", "Nothing is written.")) ask(p, Measure::Step::cancel);
    } else {
        if (!m.emulated && button(p, "Use in this project###measureUse", "An edit like any other: undo brings back."))
            ask(p, Measure::Step::use);
        if (button(p, "Close###measureCancel", "")) ask(p, Measure::Step::cancel);
    }
    ImGui::NewLine();
}

void waiting(Panel& p, const MeasureView& m, const char* what, bool cancels) {
    text(what, colour::focus, Font::strong);
    if (m.holdsDevices) wrapped("The display stays white.", colour::dim);
    ImGui::Dummy({1, p.px(4)});
    if (cancels && button(p, "Cancel###measureCancel", "Nothing is written.")) ask(p, Measure::Step::cancel);
    ImGui::NewLine();
}

void now(Panel& p, const MeasureView& m) {
    if (!m.trouble.empty()) wrapped(m.trouble, colour::fault);
    switch (m.state) {
    case Phase::setup:
        return setupForm(p, m);
    case Phase::preparing:
        return waiting(p, m, "Devices are made ready \u2026", true);
    case Phase::connecting:
    case Phase::working:
    case Phase::judged:
        return currentStep(p, m);
    case Phase::good:
    case Phase::stored:
        return finished(p, m);
    case Phase::storing:
        return waiting(p, m, "Storing \u2026", false);
    case Phase::ending:
        return waiting(p, m, "The lenses go to rest \u2026", false);
    }
}

}  // namespace

std::string whyNotMeasured(const CoreStatus& core) {
    if (core.connected && core.simulated && !core.emulated)
        return "Simulated devices have nothing that could be measured: choose the emulated rig, or a rig's file.";
    return "";
}

std::string word(MeasureStanding standing) {
    switch (standing) {
    case MeasureStanding::waiting:
        return "waiting";
    case MeasureStanding::now:
        return "now";
    case MeasureStanding::working:
        return "measuring";
    case MeasureStanding::good:
        return "good";
    case MeasureStanding::bad:
        return "not good";
    }
    return "";
}

void measureButton(Panel& p) {
    if (p.view.measuring) return;
    if (ImGui::Button("Measure this rig\u2026###measureOpen")) ask(p, Measure::Step::open);
    tooltip("Waves, powers at rest, delay and temperature, step by step with a laser and a photodiode.");
    if (const std::string why = whyNotMeasured(p.view.core); !why.empty()) tooltip(why);
}

void measurePage(Panel& p) {
    const MeasureView& m = *p.view.measuring;
    p.state.cursor.reset();
    Rect area = p.at.canvas;
    if (!p.at.header.empty()) area = {area.x, p.at.header.y, area.w, p.at.header.h + area.h};
    beginPanel("###measure", area, colour::ground, true, false);
    text("MEASURING A RIG", colour::dim, Font::small);
    ImGui::SameLine();
    text(m.rig, colour::text, Font::small);
    ImGui::SameLine();
    text(m.emulated ? "emulated" : "hardware", m.emulated ? colour::warn : colour::good, Font::small);
    if (m.state != Phase::setup) {
        ImGui::SameLine();
        text(m.eye == Eye::left ? "left lens" : "right lens", colour::dim, Font::small);
    }
    ImGui::Dummy({1, p.px(2)});
    if (!m.steps.empty()) {
        const float list = std::clamp(ImGui::GetContentRegionAvail().x * 0.42f, p.px(200), p.px(380));
        ImGui::BeginChild("###measureSteps", {list, 0}, false, ImGuiWindowFlags_NoNavInputs);
        stepList(p, m);
        ImGui::EndChild();
        ImGui::SameLine(0, p.px(20));
    }
    const bool typing = ImGui::GetIO().WantTextInput;
    ImGui::PushStyleColor(ImGuiCol_FrameBg, colour::raised);  // a field's usual ground cannot be told from the page's
    ImGui::BeginChild("###measureNow", {0, 0}, false, typing ? 0 : ImGuiWindowFlags_NoNavInputs);
    now(p, m);
    ImGui::EndChild();
    ImGui::PopStyleColor();
    ImGui::End();
    if (!p.state.panels.hidden && !p.at.sweep.empty()) measureCharts(p, m);
}

}  // namespace ilf::ui
