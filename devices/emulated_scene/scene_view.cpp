#include "devices/emulated_scene/scene_view.h"

#include <algorithm>
#include <cmath>

namespace ilf::devices::scene {
namespace {

constexpr float kHighlight = 40.0F;  // exponent

}  // namespace

Seen SceneView::seen(double x, double y, Truth* truth) const {
    Seen out;
    const Vec3 eye = stage_.cameraAt.at, along = stage_.cameraAt.turnedToWorld(stage_.camera.rayThrough(x, y));
    const auto met = tree_.first(eye, along);
    if (!met) return out;
    const Triangle& t = tree_.triangle(met->triangle);
    const double a = 1.0 - met->b - met->c;
    const Vec3 p = eye + met->distance * along;
    Vec3 n = unit(a * t.normal[0] + met->b * t.normal[1] + met->c * t.normal[2]);
    if (dot(n, along) > 0.0) n = -1.0 * n;
    out.surface = t.surface;
    out.look = t.look;
    out.depth = static_cast<float>(met->distance);  // the ray's direction has z = 1
    for (std::size_t i = 0; i < 2; ++i) {
        const double uv = a * static_cast<double>(t.uv[0][i]) + met->b * static_cast<double>(t.uv[1][i]) +
                          met->c * static_cast<double>(t.uv[2][i]);
        (i == 0 ? out.u : out.v) = static_cast<float>(uv);
    }
    const Vec3 toLamp = stage_.projectorAt.at - p;
    const auto raster = stage_.projector.rasterOf(stage_.projectorAt.fromWorld(p));
    if (raster) {
        const double away = length(toLamp), cosine = dot(n, toLamp) / away;
        // A little off the surface, so that it does not shade itself where it is made of flat faces.
        out.lit = cosine > 0.0 && !tree_.blocked(p + 2e-5 * n, toLamp, 1.0);
        out.x = static_cast<float>((*raster)[0]);
        out.y = static_cast<float>((*raster)[1]);
        out.lux = static_cast<float>(stage_.projectorLux * std::max(0.0, cosine) / (away * away));
        const Vec3 mirrored = 2.0 * dot(n, toLamp) * n - toLamp;
        const double off = std::max(0.0, -dot(mirrored, along) / (away * length(along)));
        out.shine = static_cast<float>(stage_.projectorLux / (away * away)) *
                    std::pow(static_cast<float>(off), kHighlight) * 20.0F;
        if (truth != nullptr) truth->projector = *raster;
    }
    if (truth != nullptr) {
        truth->depth_m = met->distance;
        truth->world = p;
        truth->lit = out.lit && raster.has_value();
    }
    return out;
}

std::optional<Truth> SceneView::truth(double x, double y) const {
    Truth truth;
    if (seen(x, y, &truth).surface < 0) return std::nullopt;
    return truth;
}

}  // namespace ilf::devices::scene
