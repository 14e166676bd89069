// Depth maps from files, and selecting by them.
#include "app/studio/studio.h"
#include "projects/depth_file.h"

namespace ilf::app {

void Studio::on(const ui::SelectObject& request) { selector_.find(editor_.document().scene, request); }
void Studio::on(const ui::SelectFlood& request) { selector_.find(editor_.document().scene, request); }

void Studio::on(const ui::LoadDepthMap& request) {
    Scene scene = editor_.document().scene;
    projects::DepthReading reading;
    reading.picture = scene.size();
    reading.focalPixels = scene.scale.focalPixels;
    reading.step = request.metresPerUnit;
    if (!request.intrinsics.empty()) {
        auto camera = projects::readIntrinsics(request.intrinsics);
        if (!camera) return say(camera.error().what, ui::Tone::error);
        reading.intrinsics = *camera;
    }
    auto file = projects::readDepth(request.path, reading);
    if (!file) return say(file.error().what, ui::Tone::error);
    if (!file->note.empty()) say(file->note, ui::Tone::note);
    if (!reading.intrinsics) return edit(SetMeasuredDepth{Box(std::move(file->measured))});
    scene.scale = {file->measured.camera.fx, PixelScale::Source::calibrated};
    scene.measured = Box(std::move(file->measured));
    edit(SetScene{std::move(scene)});
}

}  // namespace ilf::app
