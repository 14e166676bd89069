// The scene: picture, pixel scale, camera, depth map.
#include "ui/depth_part.h"
#include "ui/icons.h"
#include "ui/new_region.h"
#include "ui/widgets.h"

namespace ilf::ui {

namespace {

const char* sourceName(PixelScale::Source source) {
    switch (source) {
    case PixelScale::Source::assumed:
        return "assumed";
    case PixelScale::Source::exif:
        return "from EXIF";
    case PixelScale::Source::typed:
        return "typed";
    case PixelScale::Source::calibrated:
        break;
    }
    return "calibrated";
}

bool commandButton(Panel& p, Command command, const char* words, float width) {
    const std::string reason = whyNot(command, p.view, p.state);
    ImGui::BeginDisabled(!reason.empty());
    const bool pressed = ImGui::Button(words, {width, 0});
    ImGui::EndDisabled();
    commandTooltip(command, reason);
    if (pressed) p.run(command);
    return pressed;
}

}  // namespace

void scenePage(Panel& p) {
    const Scene& scene = p.document().scene;
    const CameraStatus& camera = p.view.camera;
    const Size size = scene.size();
    derivedRow(p, "Picture",
               size.width == 0 ? "none"
                               : std::to_string(size.width) + " \u00d7 " + std::to_string(size.height) + " px");
    if (!scene.source.empty()) derivedRow(p, "Source", scene.source);
    if (size.width > 0 && scene.scale.focalPixels > 0.0) {
        const FieldSpec field{Unit::degree, 5.0, 150.0, 0.1,
                              "How many degrees the picture spans across. Blur in pixels follows from it."};
        if (const auto change = numberRow(p, "Field of view", "###fieldOfView",
                                          fieldOfView(size.width, scene.scale.focalPixels), field)) {
            p.edit(change->commits, SetPixelScale{{focalPixels(size.width, change->value), PixelScale::Source::typed}});
        }
        const FieldSpec focal{Unit::pixel, 20.0, 200000.0, 0.0,
                              "Pixels per radian at the middle of the picture (f_px)."};
        if (const auto change = numberRow(p, "f_px", "###focalPixels", scene.scale.focalPixels, focal)) {
            p.edit(change->commits, SetPixelScale{{change->value, PixelScale::Source::typed}});
        }
        derivedRow(p, "  known", sourceName(scene.scale.source));
    }
    const FieldSpec alpha{Unit::dioptre, 0.0, 2.0, 0.005,
                          "Added to P_s so that the driving region is surely blurred (the paper uses 0.2 D)."};
    if (const auto change = numberRow(p, "Margin \u03b1", "###alpha", p.document().alpha.si(), alpha)) {
        p.edit(change->commits, SetAlpha{Dioptre::fromSi(change->value)});
    }

    ImGui::Dummy({1, p.px(4)});
    heading("CAMERA");
    const float width = (ImGui::GetContentRegionAvail().x - p.px(8)) / 2;
    if (!camera.open) {
        if (p.view.cameras.empty()) wrapped("No camera was found.", colour::dim, Font::small);
        for (const std::string& id : p.view.cameras) {
            if (ImGui::Button((id + "###" + id).c_str(), {-1, 0})) p.requests.push_back(OpenCamera{id});
            tooltip("Open " + id);
        }
    } else {
        text(camera.name, camera.frozen ? colour::fault : colour::text);
        if (camera.frozen)
            wrapped("The picture stands still. Check its cable, or close and open it.", colour::fault, Font::small);
        commandButton(p, Command::grab, "Grab (F5)###grab", width);
        ImGui::SameLine();
        commandButton(p, Command::toggleLive, camera.live ? "Live beneath: on###live" : "Live beneath: off###live",
                      width);
        commandButton(p, Command::lockCamera, camera.locked ? "Exposure locked###lock" : "Lock exposure###lock", width);
        ImGui::SameLine();
        commandButton(p, Command::closeCamera, "Close###close", width);
        if (camera.isVideoFile) {
            auto position = static_cast<float>(camera.videoPosition);
            ImGui::SetNextItemWidth(-1);
            if (ImGui::SliderFloat("###position", &position, 0.0f, 1.0f, "")) {
                p.requests.push_back(SeekVideo{static_cast<double>(position)});
            }
            tooltip("Place in the video.");
        }
    }

    ImGui::Dummy({1, p.px(4)});
    depthPart(p);
}

}  // namespace ilf::ui
