#include "app/scan/scan_truth.h"

#include <algorithm>
#include <cmath>

#include "devices/emulated_scene/emulated_camera.h"
#include "devices/emulated_scene/scene_view.h"

namespace ilf::app {

std::optional<ScanAgainstTruth> againstTruth(const ScanOrder& order, const ScanOutcome& outcome) {
    if (!devices::isEmulatedCamera(order.camera)) return std::nullopt;
    const auto words = order.camera.substr(std::min(order.camera.size(), devices::kEmulatedCameraId.size() + 1));
    const auto wish = devices::sceneWishFrom(words);
    if (!wish) return std::nullopt;
    const auto stage = devices::wishedStage(*wish, outcome.decoded.projector, wish->after == 0);
    if (!stage) return std::nullopt;
    const devices::scene::SceneView view(*stage);
    const Image<float>& map = outcome.decoded.projectorOfCamera;
    ScanAgainstTruth found;
    double squares = 0.0;
    int far = 0, near = 0;
    for (int y = 0; y < map.height(); y += 4) {
        for (int x = 0; x < map.width(); ++x) {
            if (!std::isfinite(map.at(x, y, 0))) continue;
            ++found.pixels;
            const auto truth = view.truth(x + 0.5, y + 0.5);
            const double off = truth && truth->lit
                                   ? std::hypot(static_cast<double>(map.at(x, y, 0)) - truth->projector[0],
                                                static_cast<double>(map.at(x, y, 1)) - truth->projector[1])
                                   : 1e9;
            if (off > 2.0) {
                ++far;
            } else {
                squares += off * off;
                ++near;
            }
        }
    }
    if (near > 0) found.rms_px = std::sqrt(squares / near);
    if (found.pixels > 0) found.beyond = static_cast<double>(far) / found.pixels;
    return found;
}

}  // namespace ilf::app
