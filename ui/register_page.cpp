#include "ui/register_page.h"

#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <string>

#include "ui/new_region.h"
#include "ui/register_parts.h"
#include "ui/widgets.h"

namespace ilf::ui {
namespace {

using Step = Register::Step;
using Phase = RegisterView::State;

bool isBusy(const RegisterView& r) { return r.state == Phase::working || r.state == Phase::stopping; }

/// Whose rig it is, and the way out.
void titleRow(Panel& p, const RegisterView& r) {
    ImGui::AlignTextToFramePadding();
    text("REGISTERING A CAMERA", colour::dim, Font::small);
    ImGui::SameLine();
    text(p.document().rig.name, colour::text, Font::small);
    if (isBusy(r) || r.state == Phase::accepted) return;
    ImGui::SameLine(ImGui::GetWindowContentRegionMax().x - p.px(80));
    if (ImGui::Button("Close###registerClose", {p.px(80), 0})) ask(p, Step::close);
    tooltip("Steady white light; the rig stays as it is.");
}

/// Which camera, and what the emulated scene shall be.
void cameraRow(Panel& p, const RegisterView& r) {
    rowLabel(p, "Camera", "Whose picture regions are painted on.");
    ImGui::SetNextItemWidth(ImGui::GetContentRegionAvail().x);
    const bool free = !isBusy(r);
    ImGui::BeginDisabled(!free);
    const std::string device = r.emulated ? r.camera.substr(0, r.camera.find(':')) : r.camera;
    if (ImGui::BeginCombo("###registerCamera", device.c_str())) {
        for (const std::string& id : p.view.cameras) {
            if (ImGui::Selectable(id.c_str(), id == r.camera)) p.requests.push_back(OpenCamera{id});
        }
        ImGui::EndCombo();
    }
    ImGui::EndDisabled();
    if (!r.emulated) return;
    rowLabel(p, "Scene",
             "The emulated scene in words, with commas between them. What goes wrong with it: dark, saturated, "
             "ambient=900, wrong-screen, frozen, delay=20, hand; turn=0.3,after=70. What it is: board=1, scene=FILE. "
             "binning=2 makes its pictures small and quick.");
    ImGui::SetNextItemWidth(ImGui::GetContentRegionAvail().x);
    ImGui::BeginDisabled(!free);
    ImGui::InputTextWithHint("###registerScene", "a desk, nothing wrong", &p.state.registerScene);
    if (ImGui::IsItemDeactivatedAfterEdit()) {  // by Enter, or by going elsewhere, such as to Scan
        const std::string& words = p.state.registerScene;
        p.requests.push_back(OpenCamera{words.empty() ? "emulated" : "emulated:" + words});
    }
    ImGui::EndDisabled();
}

void lightLine(const RegisterView& r) {
    if (!r.light) return;
    const RegisterLight& light = *r.light;
    heading("ROOM LIGHT");
    text(light.go ? "Go" : "No", light.go ? colour::good : colour::fault, Font::strong);
    ImGui::SameLine();
    text(asText("%.0f %% of the light is the projector's", 100.0 * light.projectorShare), colour::text);
    wrapped(asText("White is %.0f of 255 above black", light.contrast) +
                (light.exposure_s > 0.0 ? asText("; exposure locked at %.1f ms.", 1e3 * light.exposure_s)
                                        : "; the camera's own exposure."),
            colour::dim, Font::small);
    if (!light.go && light.what != r.trouble) wrapped(light.what, colour::fault);
}

void findings(const RegisterView& r) {
    if (r.decodedShare < 0.0) return;
    heading("SCAN");
    text(asText("%.1f %% of what is lit was decoded", 100.0 * r.decodedShare));
    for (const ScanFinding& finding : r.findings) {
        const bool failure = finding.weight == ScanFinding::Weight::failure;
        const bool note = finding.weight == ScanFinding::Weight::note;
        wrapped(finding.what, failure ? colour::fault : note ? colour::dim : colour::warn);
    }
    for (const std::string& remark : r.remarks)
        wrapped(remark, colour::dim, Font::small);
}

/// 1 189 054
std::string inThousands(int count) {
    std::string words = std::to_string(count);
    for (std::size_t at = words.size(); at > 3; at -= 3)
        words.insert(at - 3, " ");
    return words;
}

void found(Panel& p, const RegisterView& r) {
    if (!r.found) return;
    const RegisterFound& f = *r.found;
    heading("FOUND");
    text(f.way == RegisterWay::scan ? "The map holds on stripes shown anew" : "A registration by " + word(f.way),
         colour::good, Font::strong);
    if (f.way == RegisterWay::corners)
        wrapped("Four corners always fit: look whether the frame lies on what the projector shows.", colour::dim,
                Font::small);
    else
        text("Residual " + px(f.rms_px) + " rms, " + px(f.worst_px) + " the worst");
    text(inThousands(f.points) + (f.way == RegisterWay::scan ? " pixels, " : " points, ") + f.provenance, colour::dim,
         Font::small);
    if (!f.note.empty()) wrapped(f.note, colour::warn);
    ImGui::Checkbox("Its picture becomes the scene###registerAsScene", &p.state.registering.asScene);
    tooltip("The camera's picture under steady white light. Where its mode is another the regions go along with their "
            "things.");
    if (f.way == RegisterWay::scan) depthFoundPart(p, r);
    if (registerButton(p, "Accept###registerAccept", "The registration goes into the rig; undo brings back what was.",
                       !r.accepting))
        ask(p, Step::accept);
    ImGui::NewLine();
    if (r.accepting) text("Taking the scene's picture under white light \u2026", colour::focus);
}

void working(Panel& p, const RegisterView& r) {
    const bool stopping = r.state == Phase::stopping;
    text(stopping          ? "Light becomes steady and white \u2026"
         : r.doing.empty() ? "Beginning \u2026"
                           : r.doing,
         colour::focus, Font::strong);
    ImGui::PushStyleColor(ImGuiCol_PlotHistogram, colour::focus);
    ImGui::ProgressBar(static_cast<float>(r.done) / static_cast<float>(std::max(1, r.all)),
                       {ImGui::GetContentRegionAvail().x, p.px(8)}, "");
    ImGui::PopStyleColor();
    if (!stopping && registerButton(p, "Cancel###registerCancel", "Steady white light at once; nothing is kept."))
        ask(p, Step::cancel);
    ImGui::NewLine();
}

void scanPart(Panel& p) {
    wrapped("Stripes are shown in every slot, the lens rests; some seconds. Keep camera, projector and things still.",
            colour::dim);
    ImGui::Checkbox("Also where the room's light says no###registerAnyway", &p.state.registering.anyway);
    if (registerButton(p, "Scan###registerScan",
                       "Exposure, room light, a marker, all stripes, and a check on stripes shown anew."))
        ask(p, Step::scan);
    if (registerButton(p, "Check the light###registerLight",
                       "White, black and a marker: is the room dark enough, and does the camera see this projector?"))
        ask(p, Step::light);
    ImGui::NewLine();
}

/// Which picture of the camera's is shown, once there are others than the live one.
void pictures(Panel& p, const RegisterView& r) {
    if (!r.hasQuality) return;
    const float width = ImGui::GetContentRegionAvail().x;
    const int now = static_cast<int>(r.shows);
    const auto which = r.hasDepth ? choice("###registerShows", {"Live", "Quality", "Depth", "Its \u00b1"}, now, width)
                                  : choice("###registerShows", {"Live", "Quality"}, now, width);
    if (which) p.requests.push_back(ShowRegisterPicture{static_cast<RegisterPicture>(*which)});
}

void marksButton(Panel& p, const RegisterView& r, const char* show, const char* hide) {
    if (registerButton(p, r.showsMarks ? hide : show,
                       r.showsMarks ? "Steady white light." : "On the projector; what plays stops."))
        ask(p, Step::marks);
}

void cornersPart(Panel& p, const RegisterView& r) {
    wrapped("Drag the four handles to where the camera sees the corners of the projector's frame. For flat scenes.",
            colour::dim);
    marksButton(p, r, "Show the frame###registerMarks", "Hide the frame###registerMarks");
    ImGui::NewLine();
}

void pairsPart(Panel& p, const RegisterView& r) {
    wrapped(!r.showsMarks   ? "The projector shows a numbered cross; click where the camera sees it."
            : r.targetsLeft ? "Click where the camera sees cross " + std::to_string(r.pairs.size() + 1) +
                                  "; where it does not see it, ask for another place."
                            : "Every place has its pair.",
            r.showsMarks ? colour::focus : colour::dim);
    marksButton(p, r, "Show a cross###registerMarks", "Hide the cross###registerMarks");
    if (r.showsMarks && r.targetsLeft &&
        registerButton(p, "Another place###registerAnother", "The camera does not see this one."))
        ask(p, Step::another);
    ImGui::NewLine();
    for (std::size_t i = 0; i < r.pairs.size(); ++i) {
        const RegisterPair& pair = r.pairs[i];
        const bool worst = static_cast<int>(i) == r.worst && pair.fitted;
        ImGui::PushID(static_cast<int>(i));
        if (ImGui::SmallButton("\u00d7###registerRemove")) p.requests.push_back(RemovePair{i});
        tooltip("Delete this pair.");
        ImGui::PopID();
        ImGui::SameLine();
        text("Pair " + std::to_string(i + 1) + (pair.fitted ? "   " + px(pair.residual_px) : "") +
                 (!pair.used ? "   left out"
                  : worst    ? "   the worst"
                             : ""),
             !pair.used ? colour::fault
             : worst    ? colour::warn
                        : colour::text);
    }
}

void boardPart(Panel& p) {
    wrapped("The projector shows a chessboard and its inverse; the camera finds its corners. For flat scenes.",
            colour::dim);
    if (registerButton(p, "Find the board###registerBoard", "A few seconds.")) ask(p, Step::board);
    ImGui::NewLine();
}

void ways(Panel& p, const RegisterView& r) {
    const float width = ImGui::GetContentRegionAvail().x;
    if (const auto way = choice("###registerWay", {"Scan", "Corners", "Pairs", "Board", "Calibrate"},
                                static_cast<int>(r.way), width))
        p.requests.push_back(ChooseRegisterWay{static_cast<RegisterWay>(*way)});
}

void closeButton(Panel& p) {
    if (registerButton(p, "Close###registerClose", "")) ask(p, Step::close);
    ImGui::NewLine();
}

void acceptedPart(Panel& p, const RegisterView& r) {
    if (r.way != RegisterWay::calibration) {
        text("The rig is registered", colour::good, Font::strong);
        wrapped("Regions land where they are painted. The light is steady and white: TAKE plays.");
        return closeButton(p);
    }
    text("Camera and projector are calibrated", colour::good, Font::strong);
    wrapped("A scan measures depth now: put the things back and scan them.");
    if (registerButton(p, "To the scan###registerToScan", ""))
        p.requests.push_back(ChooseRegisterWay{RegisterWay::scan});
    closeButton(p);
}

void column(Panel& p, const RegisterView& r) {
    titleRow(p, r);
    cameraRow(p, r);
    ImGui::Dummy({1, p.px(4)});
    const bool busy = isBusy(r);
    if (busy) {
        working(p, r);
    } else {
        ways(p, r);
        ImGui::Dummy({1, p.px(2)});
        if (r.state == Phase::accepted) return acceptedPart(p, r);
        if (r.way == RegisterWay::scan) scanPart(p);
        if (r.way == RegisterWay::corners) cornersPart(p, r);
        if (r.way == RegisterWay::pairs) pairsPart(p, r);
        if (r.way == RegisterWay::board) boardPart(p);
        if (r.way == RegisterWay::calibration) calibrationPart(p, r);
        pictures(p, r);
    }
    if (!r.trouble.empty()) wrapped(r.trouble, colour::fault);
    if (!busy) found(p, r);
    if (r.way != RegisterWay::calibration || (r.light && !r.light->go)) lightLine(r);
    if (r.way == RegisterWay::scan || r.way == RegisterWay::calibration) findings(r);
    if (!registerLegendBelow(p.at, p.scale)) registerLegend(p, r, ImGui::GetContentRegionAvail().x, 1);
}

constexpr double kPadding = 8.0;
/// What a legend needs beneath the picture, and the height of a page that has it to spare.
constexpr double kLegend = 92.0, kRoomForLegend = 560.0;

double columnWidth(const Rect& page, double scale) { return std::clamp(0.36 * page.w, 240.0 * scale, 380.0 * scale); }

const char* methodName(Registration::Method method) {
    switch (method) {
    case Registration::Method::typed:
        return "typed";
    case Registration::Method::corners:
        return "four corners";
    case Registration::Method::pointPairs:
        return "point pairs";
    case Registration::Method::chessboard:
        return "chessboard";
    case Registration::Method::scan:
        break;
    }
    return "scan";
}

}  // namespace

bool registerButton(Panel& p, const char* words, const char* help, bool enabled) {
    const float width = std::max(p.px(80), ImGui::CalcTextSize(words, nullptr, true).x + p.px(24));
    if (ImGui::GetContentRegionAvail().x < width) ImGui::NewLine();
    ImGui::BeginDisabled(!enabled);
    const bool pressed = ImGui::Button(words, {width, p.px(34)});
    ImGui::EndDisabled();
    tooltip(help);
    ImGui::SameLine();
    return pressed && enabled;
}

void ask(Panel& p, Step step) { p.requests.push_back(Register{step, p.state.registering}); }

std::string word(RegisterWay way) {
    switch (way) {
    case RegisterWay::scan:
        return "scan";
    case RegisterWay::corners:
        return "four corners";
    case RegisterWay::pairs:
        return "point pairs";
    case RegisterWay::board:
        return "chessboard";
    case RegisterWay::calibration:
        break;
    }
    return "calibration";
}

void registerCard(Panel& p) {
    ImGui::Dummy({1, p.px(4)});
    heading("REGISTRATION");
    if (const auto& own = p.document().rig.registration) {
        derivedRow(p, "By",
                   std::string(methodName(own->method)) + (own->provenance.empty() ? "" : ", " + own->provenance));
        if (own->points > 0) derivedRow(p, "Residual", px(own->rms_px) + " rms");
        if (!own->taken.empty()) derivedRow(p, "Taken", own->taken);
        if (!own->camera.device.empty()) derivedRow(p, "Camera", own->camera.device);
    } else {
        wrapped("None: the picture is fitted into the projector's raster.", colour::warn, Font::small);
    }
    if (const auto& calibration = p.document().rig.calibration) {
        derivedRow(p, "Calibrated",
                   std::to_string(calibration->poses) + " poses, " + px(calibration->cameraRms_px) + ", " +
                       px(calibration->projectorRms_px),
                   "Camera and projector as pinholes, with which a scan measures depth; residuals of both.");
    }
    const std::string reason = whyNot(Command::registerCamera, p.view, p.state);
    ImGui::BeginDisabled(!reason.empty());
    if (ImGui::Button("Register camera\u2026###registerOpen")) p.run(Command::registerCamera);
    ImGui::EndDisabled();
    commandTooltip(Command::registerCamera, reason);
}

Rect registerPictureArea(const Layout& at, double scale) {
    const Rect& page = at.canvas;
    const double left = page.x + columnWidth(page, scale) + 3 * kPadding * scale;
    return {left, page.y + kPadding * scale, std::max(1.0, page.right() - kPadding * scale - left),
            std::max(1.0, page.h - (2 * kPadding + (registerLegendBelow(at, scale) ? kLegend : 0.0)) * scale)};
}

bool registerLegendBelow(const Layout& at, double scale) { return at.canvas.h >= kRoomForLegend * scale; }

void registerPage(Panel& p) {
    const RegisterView& r = *p.view.registering;
    p.state.cursor.reset();
    const Rect& page = p.at.canvas;
    beginPanel("###register", page, colour::ground, true, false);
    const bool typing = ImGui::GetIO().WantTextInput;
    ImGui::PushStyleColor(ImGuiCol_FrameBg, colour::raised);  // a field's usual ground cannot be told from the page's
    ImGui::BeginChild("###registerNow", {static_cast<float>(columnWidth(page, p.scale)), 0}, false,
                      typing ? 0 : ImGuiWindowFlags_NoNavInputs);
    column(p, r);
    ImGui::EndChild();
    ImGui::PopStyleColor();
    registerPicture(p, r, registerPictureArea(p.at, p.scale));
    ImGui::End();
}

}  // namespace ilf::ui
