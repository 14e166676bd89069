// Poses of a printed board, what they make of camera and projector, and the depth a scan measures with it.
#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "ui/prediction_card.h"
#include "ui/register_page.h"
#include "ui/register_parts.h"
#include "ui/widgets.h"

namespace ilf::ui {
namespace {

using Step = Register::Step;

void boardRows(Panel& p, const Board& board) {
    const float width = ImGui::GetContentRegionAvail().x;
    const auto corners = [&](const char* id, int Board::* count, const char* help) {
        const FieldSpec spec{Unit::number, 3.0, 100.0, 0.1, help};
        const auto change = numberField(p, id, board.*count, spec, (width - p.px(118 + 24)) / 2);
        if (!change || !change->commits) return;
        Board next = board;
        next.*count = static_cast<int>(std::lround(change->value));
        p.requests.push_back(SetBoard{next});
    };
    rowLabel(p, "Corners", "Inner corners of the printed chessboard, where black squares meet: across by down.");
    corners("###boardColumns", &Board::columns, "Inner corners in a row: 9 for ten squares.");
    ImGui::SameLine(0, p.px(8));
    text("\u00d7", colour::dim);
    ImGui::SameLine(0, p.px(8));
    corners("###boardRows", &Board::rows, "Rows of inner corners.");
    const FieldSpec spec{Unit::millimetre, 0.001, 1.0, 0.0,
                         "Side of one square, as measured on the print: all metres come from it."};
    const auto change = numberRow(p, "Square", "###boardSquare", board.square.si(), spec);
    if (change && change->commits)
        p.requests.push_back(SetBoard{{board.columns, board.rows, Metre::fromSi(change->value)}});
}

void poseRows(Panel& p, const std::vector<RegisterPose>& poses) {
    for (std::size_t i = 0; i < poses.size(); ++i) {
        const RegisterPose& pose = poses[i];
        ImGui::PushID(static_cast<int>(i));
        if (ImGui::SmallButton("\u00d7###poseRemove")) p.requests.push_back(RemovePose{i});
        tooltip("Forget this pose.");
        ImGui::PopID();
        ImGui::SameLine();
        std::string words = pose.name;
        if (!pose.fitted) {
            words += "   " + std::to_string(pose.cameraCorners) + " corners, " + std::to_string(pose.projectorCorners) +
                     " of them on the raster";
        } else if (pose.used) {
            words += "   camera " + px(pose.camera_px) + ", projector " + px(pose.projector_px);
        } else {
            words += "   left out";
        }
        text(words, pose.used ? colour::text : colour::fault, Font::small);
    }
}

void pinholeRows(Panel& p, const char* label, const Pinhole& pinhole, const PinholeDeviation& known, double rms_px) {
    derivedRow(p, label, px(rms_px) + " rms", "Residual of all corners that were used.");
    derivedRow(p, "  focal length",
               asText("%.1f", pinhole.fx) + " \u00b1 " + asText("%.1f", known.fx) + ", " + asText("%.1f", pinhole.fy) +
                   " \u00b1 " + asText("%.1f px", known.fy),
               "Across and down, each with one standard deviation (1 sigma).");
    derivedRow(p, "  axis at", asText("%.1f", pinhole.cx) + ", " + asText("%.1f px", pinhole.cy));
    std::string terms;
    for (const double term : pinhole.distortion) {
        if (term != 0.0) terms += (terms.empty() ? "" : "  ") + asText("%.4f", term);
    }
    derivedRow(p, "  distortion", terms.empty() ? "none" : terms, "k1, k2, p1, p2, k3, as far as corners tell them.");
}

void calibrationFound(Panel& p, const Calibrated& found) {
    const ProcamCalibration& c = found.calibration;
    heading("FOUND");
    const CompactRows compact(p);
    pinholeRows(p, "Camera", c.camera, found.camera, c.cameraRms_px);
    pinholeRows(p, "Projector", c.projector, found.projector, c.projectorRms_px);
    const auto& t = c.projectorFromCamera.inverted().translation;
    derivedRow(p, "Apart", asText("%.1f mm", 1e3 * std::hypot(t[0], t[1], t[2])),
               "From the camera's pinhole to the projector's.");
    derivedRow(p, "Tilts up to", asText("%.0f\u00b0", found.widestTilt_deg), "Between two poses of the board.");
}

}  // namespace

void calibrationPart(Panel& p, const RegisterView& r) {
    const RegisterPoses& c = r.calibration;
    if (c.poses.empty()) {
        wrapped("Print a chessboard and hold it where things will be, tilted by 20 to 40 degrees, each time to another "
                "side. Five poses tell lenses and places; scans measure depth then.",
                colour::dim);
    }
    boardRows(p, c.board);
    ImGui::Dummy({1, p.px(2)});
    const std::string words = "Scan pose " + std::to_string(c.next) + "###registerPose";
    if (registerButton(p, words.c_str(),
                       r.emulated ? "The emulated board is held anew for each pose."
                                  : "Hold the board still until the light is steady again."))
        ask(p, Step::pose);
    ImGui::NewLine();
    poseRows(p, c.poses);
    if (!c.refused.empty()) wrapped(c.refused, colour::warn);
    if (!c.found) return;
    if (registerButton(p, "Accept###calibrationAccept", "It goes into the rig; undo brings back what was."))
        ask(p, Step::accept);
    ImGui::NewLine();
    for (const std::string& note : c.found->notes)
        wrapped(note, colour::warn, Font::small);
    calibrationFound(p, *c.found);
}

void depthFoundPart(Panel& p, const RegisterView& r) {
    const RegisterFound& found = *r.found;
    if (!found.noDepth.empty()) wrapped(found.noDepth, colour::warn, Font::small);
    if (!found.depth) return;
    const RegisterDepth& depth = *found.depth;
    text("Depth " + formatted(depth.nearest) + " \u2013 " + formatted(depth.farthest) + ", \u00b1 " +
         formatted(depth.sigma.si(), Unit::millimetre) + " (1 sigma)");
    text(asText("%.0f %%", 100.0 * depth.share) + " of what was decoded; metres from the " + r.tape.scale, colour::dim,
         Font::small);
    ImGui::BeginDisabled(!p.state.registering.asScene);
    ImGui::Checkbox("With its depth###registerDepth", &p.state.registering.depth);
    ImGui::EndDisabled();
    tooltip("Distances of regions can be read from it, each pixel with its own \u00b1.");
    if (registerButton(p, r.tape.placing ? "Put the tape away###registerTape" : "Check with a tape###registerTape",
                       "Measure between two points of the scene and say how long it is: all metres follow."))
        ask(p, Step::tape);
    ImGui::NewLine();
    if (!r.tape.placing) return;
    if (r.tape.length == 0.0_m) {
        wrapped(r.tape.ends.size() < 2 ? "Click both ends of what you measure."
                                       : "There is no depth at one of the ends.",
                colour::focus);
        return;
    }
    const FieldSpec spec{Unit::metre, 0.01, 50.0, 0.0, "What the tape says; the calibration is scaled to it."};
    const auto change = numberRow(p, "Tape says", "###tapeSays", r.tape.length.si(), spec);
    if (change && change->commits) p.requests.push_back(TapeSays{Metre::fromSi(change->value)});
}

}  // namespace ilf::ui
