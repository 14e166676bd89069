#include "ui/depth_part.h"

#include <algorithm>
#include <cstdint>
#include <filesystem>

#include "core/document/viewer_place.h"
#include "ui/widgets.h"

namespace ilf::ui {

namespace {

/// Share of pixels without a distance, counted anew only for another map.
double holesOf(State& state, const Box<DepthMap>& depth) {
    if (state.countedDepth.same(depth)) return state.depthHoles;
    const auto pixels = depth->metres.pixels();
    const auto holes = std::ranges::count(pixels, 0.0F);
    state.countedDepth = depth;
    state.depthHoles = pixels.empty() ? 0.0 : static_cast<double>(holes) / static_cast<double>(pixels.size());
    return state.depthHoles;
}

void depthRows(Panel& p, const Scene& scene) {
    if (!scene.depth) {
        wrapped("None. Distances are typed, or planes.", colour::dim, Font::small);
        return;
    }
    const std::string source = scene.measured ? std::filesystem::path(scene.measured->source).filename().string()
                                              : std::string("distances from the lens");
    derivedRow(p, "Source", source.empty() ? "not said" : source,
               scene.measured ? "Depth as the camera sees it; distances follow from where the wearer is."
                              : "It came as distances from the wearer's lens, and stays as it is when they move.");
    derivedRow(p, "  holes", formatted(holesOf(p.state, scene.depth), Unit::percent), "Pixels without a distance.");
    derivedRow(p, "  known to", scene.depth->sigma.empty() ? "not said" : "each pixel its own \u00b1",
               "What is known of a map's uncertainty goes into P_min, P_s and the feather: two standard deviations.");
    const Metre now = scene.measured ? scene.measured->step : scene.depth->step;
    if (now > 0.0_m) {
        const FieldSpec step{Unit::millimetre, 1e-6, 1.0, 0.0,
                             "How far one step of the depth map's 16-bit values is: 1 mm, 0.1 mm, 0.2 mm (TUM) ..."};
        if (const auto change = numberRow(p, "  one step", "###depthStep", now.si(), step)) {
            p.edit(change->commits, SetDepthScale{Metre::fromSi(change->value)});
        }
    }
}

void viewerFields(Panel& p, const Scene& scene) {
    ImGui::Dummy({1, p.px(4)});
    heading("WEARER'S PLACE");
    const ViewerPlace now = placeOf(scene.viewer);
    derivedRow(p, "Known", scene.viewer.source, "Distances of a depth map run from the wearer's lens, wherever it is.");
    const auto row = [&](const char* label, const char* id, double value, const FieldSpec& spec, auto&& set) {
        const auto change = numberRow(p, label, id, value, spec);
        if (!change) return;
        ViewerPlace next = now;
        set(next, change->value);
        p.edit(change->commits, SetViewerPose{viewerAt(next, scene.viewer.sigma)});
    };
    const auto length = [](const char* help) { return FieldSpec{Unit::metre, -100.0, 100.0, 0.005, help}; };
    const auto angle = [](const char* help) { return FieldSpec{Unit::degree, -180.0, 180.0, 0.2, help}; };
    row("  behind", "###viewerBehind", now.behind.si(),
        length("How far the wearer's pupils are behind the camera; less than 0: in front of it. 50 cm, 0.5 m."),
        [](ViewerPlace& place, double v) { place.behind = Metre::fromSi(v); });
    row("  right", "###viewerRight", now.right.si(), length("Right of the camera, as it looks; left is less than 0."),
        [](ViewerPlace& place, double v) { place.right = Metre::fromSi(v); });
    row("  below", "###viewerBelow", now.down.si(), length("Below the camera; above is less than 0."),
        [](ViewerPlace& place, double v) { place.down = Metre::fromSi(v); });
    row("  turned", "###viewerTurned", now.turned_deg, angle("They look that far to the right of where it looks."),
        [](ViewerPlace& place, double v) { place.turned_deg = v; });
    row("  tilted", "###viewerTilted", now.tilted_deg, angle("They look that far down from where it looks."),
        [](ViewerPlace& place, double v) { place.tilted_deg = v; });
    const FieldSpec sigma{
        Unit::metre, 0.0, 1.0, 0.001,
        "How far they move along their view, one standard deviation (sigma): it goes into every distance."};
    if (const auto change = numberRow(p, "  moves, 1 sigma", "###viewerSigma", scene.viewer.sigma.si(), sigma)) {
        ViewerPose next = scene.viewer;
        next.sigma = Metre::fromSi(change->value);
        p.edit(change->commits, SetViewerPose{next});
    }
    if (scene.viewer == ViewerPose{}) return;
    if (ImGui::Button("Back to the camera###viewerReset", {-1, 0})) p.commit(SetViewerPose{});
    tooltip("The picture is the wearer's own view.");
}

}  // namespace

void depthPart(Panel& p) {
    const Scene& scene = p.document().scene;
    heading("DEPTH MAP");
    depthRows(p, scene);
    if (ImGui::Button("Load depth map...###depth", {-1, 0})) {
        openFileDialog(p.state, FileDialog::Purpose::depthMap, p.view);
    }
    tooltip(
        "A 16-bit PNG, PFM or EXR of the picture's view, as its camera measured it; 0, NaN and infinity are holes.");
    const std::string file = std::filesystem::path(p.state.intrinsics).filename().string();
    const std::string words = file.empty() ? "Its camera: from the field of view" : "Its camera: " + file;
    if (ImGui::Button((words + "###intrinsics").c_str(), {-1, 0})) {
        if (p.state.intrinsics.empty()) {
            openFileDialog(p.state, FileDialog::Purpose::intrinsics, p.view);
        } else {
            p.state.intrinsics.clear();
        }
    }
    tooltip(
        "The depth camera's intrinsics (a JSON file as Open3D writes it), read along with the next depth map. Another "
        "click forgets them.");
    if (scene.depth) {
        if (ImGui::Button("Remove depth map###removeDepth", {-1, 0})) p.commit(SetMeasuredDepth{});
        tooltip("Refused while a region reads its distance from it.");
    }
    if (scene.measured) viewerFields(p, scene);
}

}  // namespace ilf::ui
