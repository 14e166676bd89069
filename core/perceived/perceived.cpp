#include "core/perceived/perceived.h"

#include <cassert>
#include <cmath>
#include <limits>

#include "core/perceived/composite.h"
#include "core/perceived/setting.h"

namespace ilf {

Result<Radiance> perceived(const Document& document, const Plan& plan, const Program& program,
                           const ViewRequest& request) {
    const auto setting = view::setting(document, plan, program, request);
    if (!setting) return tl::unexpected(setting.error());
    if (setting->plain) return view::albedo(document, setting->scale);

    const Size size = setting->scale.size;
    const PixelRect<view::ViewFrame> window{0, 0, size.width, size.height};
    const Radiance albedo = view::albedo(document, setting->scale);
    const auto surfaces = view::surfaces(layers(document, plan, request.scale), window);
    view::Block seen(size.width, size.height, albedo.channels());
    for (const view::Light& light : view::lights(document, plan, program, setting->scale, window)) {
        std::vector<view::Appearance> looks;
        for (const view::Surface& surface : surfaces) {
            looks.push_back(view::appearance(document, plan, request.eye, setting->attention, setting->scale, window,
                                             surface.distance, light.power));
        }
        view::addLight(seen, surfaces, looks, albedo, light);
    }
    return Radiance(size, albedo.channels(), std::move(seen.values));
}

Radiance plainView(const Document& document, double scale) {
    return document.scene.picture ? view::albedo(document, view::viewScale(document, scale)) : Radiance();
}

double psnr(const Radiance& a, const Radiance& b) {
    assert(a.size() == b.size() && a.channels() == b.channels());
    double sum = 0.0;
    for (std::size_t i = 0; i < a.pixels().size(); ++i) {
        const double difference = static_cast<double>(a.pixels()[i]) - static_cast<double>(b.pixels()[i]);
        sum += difference * difference;
    }
    if (sum == 0.0) return std::numeric_limits<double>::infinity();
    return -10.0 * std::log10(sum / static_cast<double>(a.pixels().size()));
}

}  // namespace ilf
