// Cutting the scene into surfaces of constant distance, as the engine does.
#include "core/perceived/engine_cut.h"
#include "core/perceived/perceived.h"
#include "core/perceived/surfaces.h"

namespace ilf {

std::vector<SceneLayer> layers(const Document& document, const Plan& plan, double scale) {
    const view::SceneCut cut(document, plan, view::bandStep(document, plan, scale, 1.0));
    auto shares = view::pictureShares(cut, document.scene.size(), view::viewScale(document, scale).size, 2);
    std::vector<SceneLayer> layers;
    for (std::size_t k = 0; k < shares.size(); ++k) {
        const view::CutSurface& surface = cut.surfaces()[k];
        layers.push_back({surface.region, surface.distance, std::move(shares[k])});
    }
    return layers;
}

}  // namespace ilf
