#include "core/perceived/seam_profile.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "core/perceived/composite.h"

namespace ilf {
namespace {

using view::Appearance;
using view::Block;
using view::Light;
using view::Surface;
using view::ViewFrame;

constexpr int kSamples = 129;
/// The normal is read from the mask within this many pixels of the border.
constexpr int kNormalReach = 4;

/// The regions of a document and how the plan lights them, topmost first, the background last.
struct Lit {
    const Region* region;
    std::optional<int> level;
    bool blurred = false;
};

class Regions {
public:
    explicit Regions(const Compiled& compiled) : size_(compiled.document.scene.size()) {
        for (const Region* region : activeRegions(compiled.document))
            add(compiled.plan, region);
        if (compiled.document.background) add(compiled.plan, &*compiled.document.background);
    }
    const std::vector<Lit>& all() const { return all_; }
    bool inside(int x, int y) const { return x >= 0 && y >= 0 && x < size_.width && y < size_.height; }

    /// The topmost that covers at least half of a pixel: an index into all().
    std::size_t owner(int x, int y) const {
        for (std::size_t i = 0; i < all_.size(); ++i) {
            if (all_[i].region->mask.empty() || all_[i].region->mask.at(x, y) >= 128) return i;
        }
        return all_.size() - 1;
    }
    /// What each shows of a pixel, as layers do.
    void shares(int x, int y, std::vector<float>& shares) const {
        float left = 1.0F;
        for (std::size_t i = 0; i < all_.size(); ++i) {
            const Mask& mask = all_[i].region->mask;
            shares[i] = mask.empty() ? left : left * (static_cast<float>(mask.at(x, y)) / 255.0F);
            left -= shares[i];
        }
    }

private:
    void add(const Plan& plan, const Region* region) {
        const auto planned = std::ranges::find(plan.regions, region->id, &RegionPlan::id);
        const auto level = planned == plan.regions.end() ? std::nullopt : planned->level;
        all_.push_back({region, level, level && plan.levels[static_cast<std::size_t>(*level)].kind == LevelKind::blur});
    }
    Size size_;
    std::vector<Lit> all_;
};

/// Two pixels side by side: one blurred, one lit at another level.
struct Crossing {
    std::size_t blurred = 0, other = 0;
    int x = 0, y = 0;    ///< the blurred pixel
    int dx = 0, dy = 0;  ///< towards the other
};

std::optional<Crossing> crossingAt(const Regions& regions, int x, int y) {
    if (!regions.inside(x, y)) return std::nullopt;
    const std::size_t here = regions.owner(x, y);
    if (!regions.all()[here].blurred) return std::nullopt;
    for (const auto& [dx, dy] : {std::pair(1, 0), std::pair(-1, 0), std::pair(0, 1), std::pair(0, -1)}) {
        if (!regions.inside(x + dx, y + dy)) continue;
        const std::size_t there = regions.owner(x + dx, y + dy);
        if (regions.all()[there].level != regions.all()[here].level) return Crossing{here, there, x, y, dx, dy};
    }
    return std::nullopt;
}

/// Rings of growing size around the cursor, until nothing nearer can come.
std::optional<Crossing> nearestCrossing(const Regions& regions, Point<CameraFrame> cursor, double within) {
    std::optional<Crossing> nearest;
    double best = within;
    const int cx = static_cast<int>(std::floor(cursor.x)), cy = static_cast<int>(std::floor(cursor.y));
    const auto look = [&](int x, int y) {
        const double distance = std::hypot(x + 0.5 - cursor.x, y + 0.5 - cursor.y);
        if (distance > best) return;
        if (const auto crossing = crossingAt(regions, x, y)) {
            nearest = crossing;
            best = distance;
        }
    };
    look(cx, cy);
    for (int ring = 1; ring - 1 <= best; ++ring) {
        for (int along = -ring; along <= ring; ++along) {
            look(cx + along, cy - ring);
            look(cx + along, cy + ring);
            look(cx - ring, cy + along);
            look(cx + ring, cy + along);
        }
    }
    return nearest;
}

/// From the blurred side outwards: against the slope of its share around the border.
std::pair<double, double> normalAt(const Regions& regions, const Crossing& crossing) {
    double nx = 0.0, ny = 0.0;
    std::vector<float> shares(regions.all().size());
    for (int dy = -kNormalReach; dy <= kNormalReach; ++dy) {
        for (int dx = -kNormalReach; dx <= kNormalReach; ++dx) {
            const int x = crossing.x + dx, y = crossing.y + dy;
            if (dx * dx + dy * dy > kNormalReach * kNormalReach || !regions.inside(x, y)) continue;
            regions.shares(x, y, shares);
            nx -= static_cast<double>(shares[crossing.blurred]) * dx;
            ny -= static_cast<double>(shares[crossing.blurred]) * dy;
        }
    }
    const double length = std::hypot(nx, ny);
    if (length < 1e-6) return {crossing.dx, crossing.dy};
    return {nx / length, ny / length};
}

/// The scene around a border, all of it at the border's own distances.
struct Patch {
    PixelRect<ViewFrame> window;  ///< in picture pixels
    std::vector<Surface> surfaces;
    std::vector<Light> before, after;
    Image<float> white;
};

/// Hard masks: each pixel is lit in its owner's level; neutral ones evenly in all lit slots.
std::vector<Light> hardLights(const Regions& regions, const Plan& plan, PixelRect<ViewFrame> window) {
    const auto total = static_cast<double>(plan.slots.size());
    double litSlots = 0.0;
    for (const Level& level : plan.levels)
        litSlots += static_cast<double>(level.slots.size());
    const double even = plan.light * total / litSlots;
    std::vector<Light> lights;
    for (std::size_t l = 0; l < plan.levels.size(); ++l) {
        const Level& level = plan.levels[l];
        std::vector<float> light;
        for (int y = window.y0; y < window.y1; ++y) {
            for (int x = window.x0; x < window.x1; ++x) {
                const auto own = regions.all()[regions.owner(x, y)].level;
                const double share = !own ? even : *own == static_cast<int>(l) ? level.weight : 0.0;
                light.push_back(static_cast<float>(share));
            }
        }
        const double weight = static_cast<double>(level.slots.size()) / total / plan.light;
        lights.push_back({Image<float>({window.width(), window.height()}, 1, std::move(light)), level.power, weight});
    }
    return lights;
}

/// Nothing where a region has no distance.
std::vector<SceneLayer> patchLayers(const Document& document, const Regions& regions, Point<CameraFrame> at,
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

}  // namespace

std::optional<SeamProfile> seamProfile(const Compiled& compiled, Point<CameraFrame> cursor, double withinPixels) {
    const Document& document = compiled.document;
    const Plan& plan = compiled.plan;
    if (!document.scene.picture || !plan.sweeps() || compiled.program.imageOfSlot.size() != plan.slots.size()) {
        return std::nullopt;
    }
    const Regions regions(compiled);
    const auto crossing = nearestCrossing(regions, cursor, withinPixels);
    if (!crossing) return std::nullopt;

    SeamProfile profile;
    profile.at = {crossing->x + 0.5 + 0.5 * crossing->dx, crossing->y + 0.5 + 0.5 * crossing->dy};
    std::tie(profile.nx, profile.ny) = normalAt(regions, *crossing);
    const Lit& blurred = regions.all()[crossing->blurred];
    profile.blurred = blurred.region->id;
    profile.other = regions.all()[crossing->other].region->id;

    const auto distance = distanceAt(document, *blurred.region, profile.at);
    if (!distance) return std::nullopt;
    const Dioptre power = plan.levels[static_cast<std::size_t>(*blurred.level)].power;
    const double pixels = pixelsPerMetre(document, *distance);
    const double radius = pixels * blurRadiusOnSurface(plan.input.eye, *distance, plan.focusPower, power).si();
    const double stretch = magnification(plan.input.eye, *distance, plan.focusPower, power) - 1.0;
    double farthestShift = 0.0;
    for (const Eye eye : {Eye::left, Eye::right}) {
        const Point<CameraFrame> c = opticalCentre(document, eye, *distance);
        const double along = (profile.at.x - c.x) * profile.nx + (profile.at.y - c.y) * profile.ny;
        farthestShift = std::max(farthestShift, std::abs(stretch) * std::hypot(profile.at.x - c.x, profile.at.y - c.y));
        const double width = stretch * along / pixels * 1e3;
        if (std::abs(width) < std::abs(profile.seamWidth_mm)) continue;
        profile.seamWidth_mm = width;
    }
    // Magnified light moves away from the centre: outwards over the neighbour (overlap) or away from it (gap).
    profile.gap = profile.seamWidth_mm < 0.0;
    profile.seamWidth_mm = std::abs(profile.seamWidth_mm);

    // Far enough to both sides that all blending lies inside.
    const double reach =
        std::max(4.0, pixels * document.seam.feather.si() + 2.0 * radius + pixels * profile.seamWidth_mm * 1e-3);
    const double halo = std::min(reach + radius + farthestShift + 3.0, 4096.0);
    const view::ViewScale scale = view::viewScale(document, 1.0);
    const PixelRect<CameraFrame> around = PixelRect<CameraFrame>{static_cast<int>(std::floor(profile.at.x - halo)),
                                                                 static_cast<int>(std::floor(profile.at.y - halo)),
                                                                 static_cast<int>(std::ceil(profile.at.x + halo)),
                                                                 static_cast<int>(std::ceil(profile.at.y + halo))}
                                              .clipped(scale.size);
    Patch patch;
    patch.window = {around.x0, around.y0, around.x1, around.y1};
    const Size size{around.width(), around.height()};
    patch.surfaces =
        view::surfaces(patchLayers(document, regions, profile.at, patch.window), {0, 0, size.width, size.height});
    patch.before = hardLights(regions, plan, patch.window);
    patch.after = view::lights(document, plan, compiled.program, scale, patch.window);
    patch.white = Image<float>(
        size, 1,
        std::vector<float>(static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height), 1.0F));

    // The eye looks at the blurred surface, through the power that shows it sharp.
    const view::Attention attention =
        plan.input.camera ? view::Attention{} : view::Attention{true, *distance, plan.focusPower, {}};
    const auto seen = [&](Eye eye, const std::vector<Light>& lights) {
        Block image(size.width, size.height, 1);
        for (const Light& light : lights) {
            std::vector<Appearance> looks;
            for (const Surface& surface : patch.surfaces) {
                looks.push_back(view::appearance(document, plan, eye, attention, scale, patch.window, surface.distance,
                                                 light.power));
            }
            view::addLight(image, patch.surfaces, looks, patch.white, light);
        }
        return image;
    };
    std::vector<Point<ViewFrame>> points;
    for (int i = 0; i < kSamples; ++i) {
        const double along = reach * (2.0 * i / (kSamples - 1) - 1.0);
        const Point<ViewFrame> point{profile.at.x + along * profile.nx, profile.at.y + along * profile.ny};
        if (!regions.inside(static_cast<int>(std::floor(point.x)), static_cast<int>(std::floor(point.y)))) continue;
        points.push_back({point.x - patch.window.x0, point.y - patch.window.y0});
        profile.millimetres.push_back(static_cast<float>(along / pixels * 1e3));
    }
    const auto along = [&](const Block& image, double& worst) {
        std::vector<float> values;
        for (const auto& point : points) {
            values.push_back(sampled(image, point.x, point.y));
            worst = std::max(worst, std::abs(static_cast<double>(values.back()) - 1.0));
        }
        return values;
    };
    for (const Eye eye : {Eye::left, Eye::right}) {
        EyeProfile& one = eye == Eye::left ? profile.left : profile.right;
        one.before = along(seen(eye, patch.before), one.worstWeberBefore);
        one.after = along(seen(eye, patch.after), one.worstWeberAfter);
    }
    return profile;
}

}  // namespace ilf
