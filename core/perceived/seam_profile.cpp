#include "core/perceived/seam_profile.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "core/perceived/border_search.h"
#include "core/perceived/composite.h"

namespace ilf {
namespace {

using view::Appearance;
using view::Block;
using view::Light;
using view::Lit;
using view::LitRegions;
using view::Surface;
using view::ViewFrame;

constexpr int kSamples = 129;

/// The scene around a border, all of it at the border's own distances.
struct Patch {
    PixelRect<ViewFrame> window;  ///< in picture pixels
    std::vector<Surface> surfaces;
    std::vector<Light> before, after;
    Image<float> white;
};

/// Hard masks: each pixel is lit in its owner's level; neutral ones evenly in all lit slots.
std::vector<Light> hardLights(const LitRegions& regions, const Plan& plan, PixelRect<ViewFrame> window) {
    const auto total = static_cast<double>(plan.slots.size());
    double litSlots = 0.0;
    for (const Level& level : plan.levels)
        litSlots += level.exposure;
    const double even = plan.light * total / litSlots;
    std::vector<Light> lights;
    for (std::size_t l = 0; l < plan.levels.size(); ++l) {
        const Level& level = plan.levels[l];
        std::vector<float> light;
        for (int y = window.y0; y < window.y1; ++y) {
            for (int x = window.x0; x < window.x1; ++x) {
                const auto own = regions.all()[regions.owner(x, y)].level;
                const double share = !own ? even : *own == static_cast<int>(l) ? 1.0 : 0.0;
                light.push_back(static_cast<float>(share));
            }
        }
        const double weight = level.exposure / total / plan.light;
        lights.push_back({Image<float>({window.width(), window.height()}, 1, std::move(light)), level.power, weight});
    }
    return lights;
}

/// Nothing where a region has no distance.
std::vector<SceneLayer> patchLayers(const Document& document, const LitRegions& regions, Point<CameraFrame> at,
                                    PixelRect<ViewFrame> window) {
    const Size size{window.width(), window.height()};
    const std::size_t count = static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height);
    struct Part {
        Metre distance;
        RegionId region;
        std::vector<float> share;
    };
    std::vector<Part> parts;
    std::vector<std::size_t> partOf;
    for (const Lit& lit : regions.all()) {
        const Metre distance = distanceAt(document, *lit.region, at).value_or(kFarthestDistance);
        const auto same = std::ranges::find_if(
            parts, [&](const Part& part) { return abs(1.0 / part.distance - 1.0 / distance) < 1e-3_D; });
        partOf.push_back(static_cast<std::size_t>(same - parts.begin()));
        if (same == parts.end()) parts.push_back({distance, lit.region->id, std::vector<float>(count)});
    }
    std::vector<float> shares(regions.all().size());
    for (std::size_t i = 0; i < count; ++i) {
        const int x = window.x0 + static_cast<int>(i % static_cast<std::size_t>(size.width));
        const int y = window.y0 + static_cast<int>(i / static_cast<std::size_t>(size.width));
        regions.shares(x, y, shares);
        for (std::size_t r = 0; r < shares.size(); ++r)
            parts[partOf[r]].share[i] += shares[r];
    }
    std::ranges::sort(parts, {}, &Part::distance);
    std::vector<SceneLayer> layers;
    for (Part& part : parts)
        layers.push_back({part.region, part.distance, Image<float>(size, 1, std::move(part.share))});
    return layers;
}

/// Bilinear between pixel centres.
float sampled(const Block& image, double x, double y) {
    const double u = std::clamp(x - 0.5, 0.0, image.width - 1.0), v = std::clamp(y - 0.5, 0.0, image.height - 1.0);
    const int i = std::min(static_cast<int>(u), std::max(0, image.width - 2));
    const int j = std::min(static_cast<int>(v), std::max(0, image.height - 2));
    const int right = std::min(i + 1, image.width - 1);
    const float* top = image.row(j);
    const float* bottom = image.row(std::min(j + 1, image.height - 1));
    const auto fx = static_cast<float>(u - i), fy = static_cast<float>(v - j);
    return (1.0F - fy) * ((1.0F - fx) * top[i] + fx * top[right]) + fy * ((1.0F - fx) * bottom[i] + fx * bottom[right]);
}

/// The blurred surface at the border and how its light is displaced there; lengths in picture pixels.
struct Border {
    Metre distance;
    double pixelsPerMetre = 0.0;
    double radius = 0.0;  ///< of its blur disc
    double shift = 0.0;   ///< of its light, for the eye where it is larger
    double seam = 0.0;    ///< the part of the shift along the normal, positive outwards
};

Border borderAt(const Compiled& compiled, const SeamProfile& profile, Metre distance, Dioptre power) {
    const Plan& plan = compiled.plan;
    Border border{distance, pixelsPerMetre(compiled.document, distance), 0.0, 0.0, 0.0};
    border.radius = border.pixelsPerMetre * blurRadiusOnSurface(plan.input.eye, distance, plan.focusPower, power).si();
    const double stretch = magnification(plan.input.eye, distance, plan.focusPower, power) - 1.0;
    for (const Eye eye : {Eye::left, Eye::right}) {
        const Point<CameraFrame> c = opticalCentre(compiled.document, eye, distance);
        const double dx = profile.at.x - c.x, dy = profile.at.y - c.y;
        border.shift = std::max(border.shift, std::abs(stretch) * std::hypot(dx, dy));
        const double seam = stretch * (dx * profile.nx + dy * profile.ny);
        if (std::abs(seam) >= std::abs(border.seam)) border.seam = seam;
    }
    return border;
}

/// A square around the border that holds `reach` pixels of profile and all that can shine into it.
Patch patchAround(const Compiled& compiled, const LitRegions& regions, Point<CameraFrame> at, const Border& border,
                  double reach) {
    // A profile longer than this many pixels would take seconds, and no screen shows it.
    constexpr double kMostPixels = 1024.0;
    const double halo = std::min(reach + border.radius + border.shift + 3.0, kMostPixels);
    const auto lower = [&](double v) { return static_cast<int>(std::floor(v - halo)); };
    const auto upper = [&](double v) { return static_cast<int>(std::ceil(v + halo)); };
    const PixelRect<CameraFrame> square =
        PixelRect<CameraFrame>{lower(at.x), lower(at.y), upper(at.x), upper(at.y)}.clipped(
            compiled.document.scene.size());
    Patch patch;
    patch.window = {square.x0, square.y0, square.x1, square.y1};
    const Size size{square.width(), square.height()};
    patch.surfaces =
        view::surfaces(patchLayers(compiled.document, regions, at, patch.window), {0, 0, size.width, size.height});
    patch.before = hardLights(regions, compiled.plan, patch.window);
    patch.after = view::lights(compiled.document, compiled.plan, compiled.program,
                               view::viewScale(compiled.document, 1.0), patch.window);
    patch.white = Image<float>(
        size, 1,
        std::vector<float>(static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height), 1.0F));
    return patch;
}

/// What an eye that looks at the blurred surface receives from the patch.
Block seen(const Compiled& compiled, const Patch& patch, Metre attended, Eye eye, const std::vector<Light>& lights) {
    const Plan& plan = compiled.plan;
    const view::Attention attention =
        plan.input.camera ? view::Attention{} : view::Attention{true, attended, plan.focusPower, {}};
    Block image(patch.white.width(), patch.white.height(), 1);
    for (const Light& light : lights) {
        std::vector<Appearance> looks;
        for (const Surface& surface : patch.surfaces) {
            looks.push_back(view::appearance(compiled.document, plan, eye, attention,
                                             view::viewScale(compiled.document, 1.0), patch.window, surface.distance,
                                             light.power));
        }
        view::addLight(image, patch.surfaces, looks, patch.white, light);
    }
    return image;
}

}  // namespace

std::optional<SeamProfile> seamProfile(const Compiled& compiled, Point<CameraFrame> cursor, double withinPixels) {
    const Plan& plan = compiled.plan;
    if (!compiled.document.scene.picture || !plan.sweeps() ||
        compiled.program.imageOfSlot.size() != plan.slots.size()) {
        return std::nullopt;
    }
    const LitRegions regions(compiled);
    const auto crossing = view::nearestCrossing(regions, cursor, withinPixels);
    if (!crossing) return std::nullopt;

    SeamProfile profile;
    profile.at = {crossing->x + 0.5 + 0.5 * crossing->dx, crossing->y + 0.5 + 0.5 * crossing->dy};
    std::tie(profile.nx, profile.ny) = view::normalAt(regions, *crossing);
    const Lit& blurred = regions.all()[crossing->blurred];
    profile.blurred = blurred.region->id;
    profile.other = regions.all()[crossing->other].region->id;
    const auto distance = distanceAt(compiled.document, *blurred.region, profile.at);
    if (!distance) return std::nullopt;
    const auto behind = distanceAt(compiled.document, *regions.all()[crossing->other].region, profile.at);
    profile.depthStep = behind && abs(1.0 / *behind - 1.0 / *distance) > kDepthStep;
    const Border border =
        borderAt(compiled, profile, *distance, plan.levels[static_cast<std::size_t>(*blurred.level)].power);
    const auto millimetres = [&](double pixels) { return pixels / border.pixelsPerMetre * 1e3; };
    // Magnified light moves away from the centre: outwards over the neighbour (overlap) or away from it (gap).
    profile.gap = border.seam < 0.0;
    profile.seamWidth_mm = millimetres(std::abs(border.seam));

    // Far enough to both sides that all blending lies inside.
    const double feather = border.pixelsPerMetre * compiled.document.seam.feather.si();
    const double reach = std::max(4.0, feather + 2.0 * border.radius + std::abs(border.seam));
    const Patch patch = patchAround(compiled, regions, profile.at, border, reach);
    std::vector<Point<ViewFrame>> points;
    for (int i = 0; i < kSamples; ++i) {
        const double along = reach * (2.0 * i / (kSamples - 1) - 1.0);
        const Point<ViewFrame> point{profile.at.x + along * profile.nx, profile.at.y + along * profile.ny};
        if (!regions.inside(static_cast<int>(std::floor(point.x)), static_cast<int>(std::floor(point.y)))) continue;
        points.push_back({point.x - patch.window.x0, point.y - patch.window.y0});
        profile.millimetres.push_back(static_cast<float>(millimetres(along)));
    }
    const auto across = [&](Eye eye, const std::vector<Light>& lights, double& worst) {
        const Block image = seen(compiled, patch, border.distance, eye, lights);
        std::vector<float> values;
        for (const auto& point : points) {
            values.push_back(sampled(image, point.x, point.y));
            worst = std::max(worst, std::abs(static_cast<double>(values.back()) - 1.0));
        }
        return values;
    };
    for (const Eye eye : {Eye::left, Eye::right}) {
        EyeProfile& one = eye == Eye::left ? profile.left : profile.right;
        one.before = across(eye, patch.before, one.worstWeberBefore);
        one.after = across(eye, patch.after, one.worstWeberAfter);
    }
    return profile;
}

}  // namespace ilf
