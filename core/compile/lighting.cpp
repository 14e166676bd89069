#include "core/compile/lighting.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "core/compile/compile.h"
#include "core/plan/fade.h"

namespace ilf {

namespace {

/// Powers nearer than this show the same picture: a thousandth of the acceptable defocus.
constexpr Dioptre kSamePower = 1e-4_D;
/// Vergences of a surface are kept in here: 50 m is as good as infinity, and 5 cm is nearer than anything is looked at.
constexpr double kLeastVergence = 0.02, kMostVergence = 20.0;

const RegionPlan* planOf(const Plan& plan, const RegionId& id) {
    const auto found = std::ranges::find(plan.regions, id, &RegionPlan::id);
    return found == plan.regions.end() ? nullptr : &*found;
}

/// Where the eye rests: the focus level nearest the plan's focus power, or the weakest level if nothing is focused.
int baseLevel(const Plan& plan) {
    int best = 0;
    const auto cost = [&](int l) {
        const Level& level = plan.levels[static_cast<std::size_t>(l)];
        return abs(level.power - plan.focusPower) + (level.kind == LevelKind::focus ? 0.0_D : 1000.0_D);
    };
    for (int l = 1; l < static_cast<int>(plan.levels.size()); ++l) {
        if (cost(l) < cost(best)) best = l;
    }
    return best;
}

Sheet sheetFor(const Region& region, const Plan& plan, int base) {
    Sheet sheet{std::nullopt, region.distance, 1.0_D};
    const RegionPlan* planned = planOf(plan, faded(region) ? fadedId(region.id) : region.id);
    const Look look = faded(region) ? region.fade->look : region.look;
    if (look != Look::neutral) sheet.level = planned != nullptr ? planned->level.value_or(base) : base;
    const bool fromMap = std::holds_alternative<FromDepthMap>(region.distance);
    if (fromMap && planned != nullptr) sheet.fallback = 0.5 * (1.0 / planned->nearest + 1.0 / planned->farthest);
    return sheet;
}

/// The maps between picture and raster, and how large a picture pixel lands on the raster.
struct RasterMaps {
    PixelMap map;

    /// Projector pixels per camera pixel around a point: square root of how areas grow.
    double scaleAt(Point<CameraFrame> p) const {
        const double nominal = scaleOver(p, 1.0, [&](Point<CameraFrame> at) { return map.nearest()(at); });
        if (map.plane() != nullptr) return nominal;
        // Over as many pixels as a scan's jitter needs; beside a depth step the plane knows better.
        constexpr double kBase = 16.0;
        const Point<CameraFrame> corner{p.x - 0.5 * kBase, p.y - 0.5 * kBase};
        const double scanned = scaleOver(corner, kBase, [&](Point<CameraFrame> at) { return map.toProjector(at); });
        return scanned > 0.5 * nominal && scanned < 2.0 * nominal ? scanned : nominal;
    }
    /// From the raster's point `from`, which the camera sees at `at`, to where it would see `to`. Where a scanned map
    /// is torn there (a depth step, a guess), the homography that fits it best tells.
    Shift shift(Point<ProjectorFrame> from, Point<CameraFrame> at, Point<CameraFrame> to) const {
        const auto between = [](Point<ProjectorFrame> a, Point<ProjectorFrame> b) {
            return Shift{static_cast<float>(b.x - a.x), static_cast<float>(b.y - a.y)};
        };
        if (map.plane() != nullptr) return between(from, map.toProjector(to));
        const Shift plane = between(map.nearest()(at), map.nearest()(to));
        const Shift scanned = between(map.toProjector(at), map.toProjector(to));
        const float off = std::hypot(scanned.x - plane.x, scanned.y - plane.y);
        return off <= 1.0F + 0.5F * std::hypot(plane.x, plane.y) ? scanned : plane;
    }

private:
    template <class Map>
    static double scaleOver(Point<CameraFrame> p, double base, const Map& to) {
        const Point<ProjectorFrame> o = to(p);
        const Point<ProjectorFrame> x = to(Point<CameraFrame>{p.x + base, p.y});
        const Point<ProjectorFrame> y = to(Point<CameraFrame>{p.x, p.y + base});
        return std::sqrt(std::abs((x.x - o.x) * (y.y - o.y) - (x.y - o.y) * (y.x - o.x))) / base;
    }
};

/// What magnification and blur do to one sheet's light in one level.
struct Sight {
    const Document& document;
    const RasterMaps& registration;
    EyeOptics eye;
    Dioptre rest, lit;

    LayerNode node(const Sheet& sheet, bool blurred, Point<ProjectorFrame> at) const {
        const Point<CameraFrame> p = registration.map.toCamera(at);
        const Metre d = 1.0 / Dioptre::fromSi(vergenceAt(document, sheet, p));
        const double s = magnification(eye, d, rest, lit);
        const Point<CameraFrame> left = opticalCentre(document, Eye::left, d);
        const Point<CameraFrame> right = opticalCentre(document, Eye::right, d);
        const Point<CameraFrame> c{0.5 * (left.x + right.x), 0.5 * (left.y + right.y)};
        const auto scaled = [&](double k) { return Point<CameraFrame>{c.x + k * (p.x - c.x), c.y + k * (p.y - c.y)}; };
        const double perMetre = pixelsPerMetre(document, d) * registration.scaleAt(p);
        LayerNode node;
        node.toPainted = registration.shift(at, p, scaled(2.0 * s / (1.0 + s)));
        node.toSeen = registration.shift(at, p, scaled(s));
        node.toLit = registration.shift(at, p, scaled(1.0 / s));
        node.feather = static_cast<float>(document.seam.feather.si() * perMetre);
        if (blurred) {
            node.blurRadius = static_cast<float>(blurRadiusOnSurface(eye, d, rest, lit).si() * perMetre / s);
        }
        return node;
    }
};

float length(Shift shift) { return std::hypot(shift.x, shift.y); }

/// Marks the pairs of sheets that may lie farther apart than a depth step. A depth map may step anywhere.
std::vector<bool> possibleSteps(const Document& document, const RasterMaps& registration, const Lighting& light) {
    struct Range {
        double low = kMostVergence, high = kLeastVergence;
        bool any = false;
    };
    std::vector<Range> ranges;
    for (const Sheet& sheet : light.sheets) {
        Range range;
        if (std::holds_alternative<FromDepthMap>(sheet.distance)) range = {kLeastVergence, kMostVergence, true};
        for (int row = 0; row <= light.rows && !range.any; ++row) {
            for (int column = 0; column <= light.columns; ++column) {
                const Point<ProjectorFrame> at{static_cast<double>(column * kTile), static_cast<double>(row * kTile)};
                const double v = vergenceAt(document, sheet, registration.map.toCamera(at));
                range.low = std::min(range.low, v);
                range.high = std::max(range.high, v);
            }
        }
        ranges.push_back(range);
    }
    std::vector<bool> may;
    for (const Range& a : ranges) {
        for (const Range& b : ranges)
            may.push_back(std::max(a.high - b.low, b.high - a.low) > kDepthStep.si());
    }
    return may;
}

/// Gives each tile of a layer the blur disc nearest to the mean of its corners. Radii are kept to a sixteenth of a
/// pixel: over a slanted surface they change by less than that from tile to tile, and equal ones share a disc.
void addDiscs(Lighting& light) {
    std::map<int, int> discOfSixteenths;
    for (Layer& layer : light.layers) {
        for (int row = 0; row < light.rows; ++row) {
            for (int column = 0; column < light.columns; ++column) {
                const float sum =
                    light.node(layer, column, row).blurRadius + light.node(layer, column + 1, row).blurRadius +
                    light.node(layer, column, row + 1).blurRadius + light.node(layer, column + 1, row + 1).blurRadius;
                const int sixteenths = static_cast<int>(std::lround(4.0F * sum));
                const auto [found, isNew] =
                    discOfSixteenths.try_emplace(sixteenths, static_cast<int>(light.discs.size()));
                if (isNew) light.discs.emplace_back(sixteenths / 16.0);
                layer.discOf.push_back(found->second);
            }
        }
    }
}

void measureReach(Lighting& light) {
    float shift = 0.0F, feather = 0.0F, radius = 0.0F;
    for (const Layer& layer : light.layers) {
        for (const LayerNode& node : layer.nodes) {
            shift = std::max({shift, length(node.toPainted), length(node.toSeen), length(node.toLit)});
            feather = std::max(feather, node.feather);
            radius = std::max(radius, node.blurRadius);
        }
    }
    const bool closed = light.blending == Blending::closedForm;
    // Closed form: the ramp ends W/2 from the border. Linear: the band between a border and its image is as wide as the
    // shift. Two pixels more, because distances are interpolated between pixels.
    light.distanceReach = 2.0F + (closed ? 0.5F * feather : shift);
    light.layerReach = static_cast<int>(std::ceil(shift + std::max(light.distanceReach, radius + shift))) + 3;
    light.blendReach = closed ? static_cast<int>(std::ceil(shift + radius)) + 3 : 0;
    if (light.blending == Blending::none) light.layerReach = 0;
}

}  // namespace

double vergenceAt(const Document& document, const Sheet& sheet, Point<CameraFrame> at) {
    Region surface;
    surface.distance = sheet.distance;
    const std::optional<Metre> d = distanceAt(document, surface, at);
    return std::clamp(d ? 1.0 / d->si() : sheet.fallback.si(), kLeastVergence, kMostVergence);
}

Lighting lighting(const Document& document, const Plan& plan) {
    Lighting light;
    light.projector = document.rig.projector;
    light.columns = (light.projector.width + kTile - 1) / kTile;
    light.rows = (light.projector.height + kTile - 1) / kTile;
    light.blending = document.seam.blending;
    light.levels = static_cast<int>(plan.levels.size());
    light.base = baseLevel(plan);
    std::vector<double> given;  // light of a level over the sweep: what "evenly in all lit slots" shares out
    double allGiven = 0.0;
    for (const Level& level : plan.levels) {
        given.push_back(level.exposure);
        allGiven += given.back();
    }

    std::vector<const Region*> regions = activeRegions(document);
    regions.push_back(&*document.background);
    for (const Region* region : regions) {
        Sheet sheet = sheetFor(*region, plan, light.base);
        const auto same = std::ranges::find(light.sheets, sheet);
        light.sheetOf.push_back(static_cast<int>(same - light.sheets.begin()));
        if (same == light.sheets.end()) light.sheets.push_back(std::move(sheet));
    }

    const RasterMaps registration{pixelMap(document)};
    const EyeOptics eye = eyeOptics(document.wearer);
    const Dioptre rest = plan.levels[static_cast<std::size_t>(light.base)].power;
    for (int sheet = 0; sheet < static_cast<int>(light.sheets.size()); ++sheet) {
        const Sheet& surface = light.sheets[static_cast<std::size_t>(sheet)];
        for (int l = 0; l < static_cast<int>(plan.levels.size()); ++l) {
            if (l == light.base || (surface.level && *surface.level != l)) continue;
            const Level& level = plan.levels[static_cast<std::size_t>(l)];
            Layer layer;
            layer.sheet = sheet;
            layer.level = l;
            if (!surface.level) layer.share = given[static_cast<std::size_t>(l)] / allGiven;
            // Light at the rest power needs no correction, but a level of its own still has to carry it. An object
            // focused at a power of its own is sharp there: the eye accommodates, only the magnification is left.
            const bool blurred = level.kind == LevelKind::blur || !surface.level;
            const Dioptre lit = abs(level.power - rest) < kSamePower ? rest : level.power;
            const Sight sight{document, registration, eye, rest, lit};
            for (int row = 0; row <= light.rows; ++row) {
                for (int column = 0; column <= light.columns; ++column) {
                    const Point<ProjectorFrame> at{static_cast<double>(column * kTile),
                                                   static_cast<double>(row * kTile)};
                    layer.nodes.push_back(sight.node(surface, blurred, at));
                }
            }
            light.layers.push_back(std::move(layer));
        }
    }
    light.stepBetween = possibleSteps(document, registration, light);
    if (light.blending == Blending::closedForm) addDiscs(light);
    measureReach(light);
    return light;
}

}  // namespace ilf
