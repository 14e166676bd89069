#include "core/perceived/reference_scene.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/base/parallel.h"

namespace ilf::reference {
namespace {

/// Constant surfaces whose vergences differ by less are one surface.
constexpr double kSameVergence = 1e-6;
/// Less than this is left of a pixel only by rounding.
constexpr double kNothing = 1e-9;
/// A depth map is torn where neighbours differ by more than this in vergence ...
constexpr double kLeastTear = 0.1;
/// ... and a ray from the pupil's rim would pass them more than a pixel apart.
constexpr double kTearPixels = 1.0;

Frame frameOf(const Document& document, double scale) {
    const Size full = document.scene.size();
    const Size size{std::max(1, static_cast<int>(std::lround(full.width * scale))),
                    std::max(1, static_cast<int>(std::lround(full.height * scale)))};
    return {size, static_cast<double>(size.width) / full.width, static_cast<double>(size.height) / full.height};
}

/// Mean over what lies under each view pixel.
std::vector<double> averaged(const std::vector<double>& field, Size from, const Frame& to) {
    if (from == to.size) return field;
    const auto along = [](std::size_t lines, std::size_t stride, std::size_t step, int count, int fewer,
                          std::size_t outStride, std::size_t outStep, const std::vector<double>& in) {
        std::vector<double> out(lines * static_cast<std::size_t>(fewer));
        const double ratio = static_cast<double>(count) / fewer;
        for (std::size_t line = 0; line < lines; ++line) {
            for (int i = 0; i < fewer; ++i) {
                const double begin = i * ratio, end = std::min<double>(count, (i + 1) * ratio);
                double sum = 0.0;
                for (int s = static_cast<int>(begin); s < end; ++s) {
                    const double part = std::min(end, s + 1.0) - std::max(begin, static_cast<double>(s));
                    sum += part * in[line * stride + static_cast<std::size_t>(s) * step];
                }
                out[line * outStride + static_cast<std::size_t>(i) * outStep] = sum / ratio;
            }
        }
        return out;
    };
    const auto rows = static_cast<std::size_t>(from.height), width = static_cast<std::size_t>(from.width);
    const auto fewer = static_cast<std::size_t>(to.size.width);
    const auto across = along(rows, width, 1, from.width, to.size.width, fewer, 1, field);
    return along(fewer, 1, fewer, from.height, to.size.height, 1, fewer, across);
}

/// A region's share of each picture pixel after the regions above took theirs.
struct Cover {
    const Region* region = nullptr;
    std::vector<double> share;
};

std::vector<Cover> covers(const Document& document) {
    const Size size = document.scene.size();
    const std::size_t count = static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height);
    std::vector<double> left(count, 1.0);
    std::vector<Cover> all;
    for (const Region* region : activeRegions(document)) {
        if (region->mask.empty() || region->mask.blank()) continue;
        const Image<std::uint8_t> mask = toImage(region->mask);
        Cover cover{region, std::vector<double>(count)};
        for (std::size_t i = 0; i < count; ++i) {
            cover.share[i] = left[i] * (mask.pixels()[i] / 255.0);
            left[i] -= cover.share[i];
        }
        all.push_back(std::move(cover));
    }
    if (document.background) all.push_back({&*document.background, std::move(left)});
    return all;
}

void add(std::vector<double>& to, const std::vector<double>& from) {
    for (std::size_t i = 0; i < to.size(); ++i)
        to[i] += from[i];
}

/// Share times vergence of the depth map, held within what is seen of the region: strays of the sensor are not the
/// surface, and holes lie in its middle.
std::vector<double> weightedVergence(const Document& document, const Cover& cover, const RegionPlan& seen) {
    const double near = 1.0 / seen.nearest.si(), far = 1.0 / seen.farthest.si();
    const Box<DepthMap>& depth = document.scene.depth;
    const int width = document.scene.size().width;
    std::vector<double> weighted(cover.share);
    for (std::size_t i = 0; i < weighted.size(); ++i) {
        if (weighted[i] <= 0.0) continue;
        const int x = static_cast<int>(i) % width, y = static_cast<int>(i) / width;
        const double metres = depth && x < depth->metres.width() && y < depth->metres.height()
                                  ? static_cast<double>(depth->metres.at(x, y))
                                  : 0.0;
        weighted[i] *= metres > 0.0 ? std::clamp(1.0 / metres, far, near) : 0.5 * (near + far);
    }
    return weighted;
}

/// Surfaces without their alphas.
std::vector<Surface> sharedSurfaces(const Document& document, const Plan& plan, const Frame& frame) {
    std::vector<Surface> surfaces;
    const auto onto = [&](Surface::Kind kind, AffineVergence vergence, std::vector<double>&& share) {
        const auto same = std::ranges::find_if(surfaces, [&](const Surface& one) {
            return one.kind == kind && std::abs(one.vergence.at - vergence.at) < kSameVergence &&
                   one.vergence.dx == vergence.dx && one.vergence.dy == vergence.dy;
        });
        if (same != surfaces.end()) return add(same->share, share);
        Surface fresh;
        fresh.kind = kind;
        fresh.vergence = vergence;
        fresh.share = std::move(share);
        surfaces.push_back(std::move(fresh));
    };
    Surface map;
    map.kind = Surface::Kind::map;
    for (const Cover& cover : covers(document)) {
        const Size full = document.scene.size();
        if (const auto* constant = std::get_if<ConstantDistance>(&cover.region->distance)) {
            onto(Surface::Kind::flat, {1.0 / constant->value.si(), 0.0, 0.0}, averaged(cover.share, full, frame));
            continue;
        }
        const auto seen = std::ranges::find(plan.regions, cover.region->id, &RegionPlan::id);
        if (seen == plan.regions.end()) continue;  // nothing of it is seen
        if (const auto affine = affineVergence(*cover.region); affine && *affine) {
            onto(Surface::Kind::plane,
                 {(*affine)->at, (*affine)->dx / frame.perPictureX, (*affine)->dy / frame.perPictureY},
                 averaged(cover.share, full, frame));
            continue;
        }
        const auto share = averaged(cover.share, full, frame);
        const auto weighted = averaged(weightedVergence(document, cover, *seen), full, frame);
        if (map.share.empty()) map.share = map.map = std::vector<double>(frame.count());
        add(map.share, share);
        add(map.map, weighted);
    }
    std::ranges::stable_sort(surfaces, [](const Surface& a, const Surface& b) {
        if (a.kind != b.kind) return a.kind < b.kind;
        return a.kind == Surface::Kind::flat && a.vergence.at > b.vergence.at;
    });
    if (map.share.empty()) return surfaces;
    for (std::size_t i = 0; i < map.map.size(); ++i) {
        if (map.share[i] <= 0.0) continue;
        map.map[i] /= map.share[i];
        map.nearest = std::max(map.nearest, map.map[i]);
        map.farthest = map.farthest == 0.0 ? map.map[i] : std::min(map.farthest, map.map[i]);
    }
    const double pixelsPerDioptre =
        document.scene.scale.focalPixels * frame.perPictureX * 0.5 * plan.input.eye.pupil.si();
    map.tear = std::max(kLeastTear, kTearPixels / std::max(pixelsPerDioptre, 1e-9));
    surfaces.push_back(std::move(map));
    return surfaces;
}

/// What each surface covers of what the nearer ones leave, pixel by pixel: which is nearer may differ between pixels.
void addAlphas(std::vector<Surface>& surfaces, const Frame& frame) {
    for (Surface& surface : surfaces)
        surface.alpha.assign(frame.count(), 0.0);
    std::vector<std::pair<double, Surface*>> order;
    for (int y = 0; y < frame.size.height; ++y) {
        for (int x = 0; x < frame.size.width; ++x) {
            const std::size_t i = frame.index(x, y);
            order.clear();
            for (Surface& surface : surfaces) {
                if (surface.share[i] > 0.0) order.emplace_back(surface.at(frame, x, y), &surface);
            }
            std::ranges::stable_sort(order, [](const auto& a, const auto& b) { return a.first > b.first; });
            double rest = 1.0;
            for (const auto& [vergence, surface] : order) {
                if (rest <= kNothing) break;
                surface->alpha[i] = std::min(1.0, surface->share[i] / rest);
                rest -= surface->share[i];
                if (surface->x1 < surface->x0) {
                    surface->x0 = surface->x1 = x + 0.5;
                    surface->y0 = surface->y1 = y + 0.5;
                }
                surface->x0 = std::min(surface->x0, x - 0.5);
                surface->y0 = std::min(surface->y0, y - 0.5);
                surface->x1 = std::max(surface->x1, x + 1.5);
                surface->y1 = std::max(surface->y1, y + 1.5);
            }
        }
    }
}

/// Bilinear, 0..1; the outermost pixels reach to the raster's edge, beyond it is dark.
double lightAt(const Image<std::uint8_t>& image, Point<ProjectorFrame> at) {
    const Size size = image.size();
    if (!(at.x >= 0.0 && at.y >= 0.0 && at.x <= size.width && at.y <= size.height)) return 0.0;
    const double u = std::clamp(at.x - 0.5, 0.0, size.width - 1.0), v = std::clamp(at.y - 0.5, 0.0, size.height - 1.0);
    const int i = static_cast<int>(u), j = static_cast<int>(v);
    const int right = std::min(i + 1, size.width - 1), below = std::min(j + 1, size.height - 1);
    const double fx = u - i, fy = v - j;
    return ((image.at(i, j) * (1.0 - fx) + image.at(right, j) * fx) * (1.0 - fy) +
            (image.at(i, below) * (1.0 - fx) + image.at(right, below) * fx) * fy) /
           255.0;
}

Light lit(const Document& document, const Scene& scene, const LightImage& shown) {
    const Image<std::uint8_t> image = toImage(shown);
    const PixelMap map = pixelMap(document);
    const Frame& frame = scene.frame;
    Light light;
    light.radiance = scene.plain;
    parallelFor(frame.size.height, [&](int y) {
        for (int x = 0; x < frame.size.width; ++x) {
            const double here =
                lightAt(image, map.toProjector({(x + 0.5) / frame.perPictureX, (y + 0.5) / frame.perPictureY}));
            for (std::size_t c = 0; c < 3; ++c)
                light.radiance[3 * frame.index(x, y) + c] *= here;
        }
    });
    return light;
}

std::vector<Light> lights(const Document& document, const Plan& plan, const Program& program, const Scene& scene) {
    std::vector<Light> lights;
    std::vector<std::optional<std::size_t>> ofLevel(plan.levels.size() + 1);  // the room's last
    for (const view::Exposure& exposure : view::exposures(plan)) {
        const bool ambient = exposure.level == view::Exposure::kAmbient;
        const std::size_t level = ambient ? plan.levels.size() : static_cast<std::size_t>(exposure.level);
        if (!ambient && (level >= program.images.size() || program.images[level].blank())) continue;
        if (!ofLevel[level]) {
            ofLevel[level] = lights.size();
            lights.push_back(ambient ? Light{scene.plain, {}, 0.0} : lit(document, scene, program.images[level]));
        }
        Light& light = lights[*ofLevel[level]];
        light.exposures.push_back(exposure);
        light.weight += exposure.weight;
    }
    return lights;
}

}  // namespace

double Surface::at(const Frame& frame, int x, int y) const {
    if (kind == Kind::map) return map[frame.index(x, y)];
    return std::max(vergence(x + 0.5, y + 0.5), 1.0 / kFarthestDistance.si());
}

Scene scene(const Document& document, const Plan& plan, const Program& program, double scale) {
    Scene made;
    made.frame = frameOf(document, scale);
    const Radiance plain = plainView(document, scale);
    made.plain.assign(plain.pixels().begin(), plain.pixels().end());
    made.surfaces = sharedSurfaces(document, plan, made.frame);
    addAlphas(made.surfaces, made.frame);
    made.lights = lights(document, plan, program, made);
    return made;
}

}  // namespace ilf::reference
