#include "core/perceived/seam_patch.h"

#include <algorithm>
#include <cmath>

#include "core/compile/patch.h"

namespace ilf::view {
namespace {

/// Calls `set(i, x, y)` for subsamples of each patch pixel i: the picture pixel (x, y) they lie in, kept inside it.
template <class Visit>
void forEachSample(const PatchWindow& window, Size picture, Visit&& visit) {
    const int fine = std::max(1, static_cast<int>(std::ceil(window.pitch - 1e-9)));
    std::size_t i = 0;
    for (int y = 0; y < window.size.height; ++y) {
        for (int x = 0; x < window.size.width; ++x, ++i) {
            for (int v = 0; v < fine; ++v) {
                for (int u = 0; u < fine; ++u) {
                    const auto at = window.toPicture(x + (u + 0.5) / fine, y + (v + 0.5) / fine);
                    visit(i, std::clamp(static_cast<int>(std::floor(at.x)), 0, picture.width - 1),
                          std::clamp(static_cast<int>(std::floor(at.y)), 0, picture.height - 1),
                          1.0F / static_cast<float>(fine * fine));
                }
            }
        }
    }
}

std::size_t pixelCount(const PatchWindow& window) {
    return static_cast<std::size_t>(window.size.width) * static_cast<std::size_t>(window.size.height);
}

/// A level's image near a patch, as one dense array.
class NearRaster {
public:
    NearRaster(const LightImage& image, PixelRect<ProjectorFrame> rect) : pixels_(gathered(image, rect)) {}

    /// Bilinear, 0..1.
    float at(Point<ProjectorFrame> p) const {
        const auto& rect = pixels_.at;
        const double u = std::clamp(p.x - 0.5, static_cast<double>(rect.x0), rect.x1 - 2.0);
        const double v = std::clamp(p.y - 0.5, static_cast<double>(rect.y0), rect.y1 - 2.0);
        const int i = static_cast<int>(std::floor(u)), j = static_cast<int>(std::floor(v));
        const auto fx = static_cast<float>(u - i), fy = static_cast<float>(v - j);
        const auto value = [&](int x, int y) { return static_cast<float>(pixels_(x, y)); };
        const float top = value(i, j) * (1.0F - fx) + value(i + 1, j) * fx;
        const float bottom = value(i, j + 1) * (1.0F - fx) + value(i + 1, j + 1) * fx;
        return (top * (1.0F - fy) + bottom * fy) / 255.0F;
    }

private:
    Patch<std::uint8_t> pixels_;
};

/// `image` moved by (dx, dy) patch pixels; what comes in repeats the edge.
Image<float> moved(const Image<float>& image, double dx, double dy) {
    Block block(image.width(), image.height(), 1);
    std::ranges::copy(image.pixels(), block.values.begin());
    std::vector<float> out;
    out.reserve(block.values.size());
    for (int y = 0; y < image.height(); ++y) {
        for (int x = 0; x < image.width(); ++x)
            out.push_back(sampled(block, x + 0.5 - dx, y + 0.5 - dy));
    }
    return Image<float>(image.size(), 1, std::move(out));
}

}  // namespace

PatchWindow PatchWindow::around(double left, double top, double right, double bottom, double halo, double pitch) {
    // Whole picture pixels, so that a patch of pitch 1 has the picture's own.
    PatchWindow window;
    window.pitch = pitch;
    window.x0 = std::floor(left - halo);
    window.y0 = std::floor(top - halo);
    window.size = {static_cast<int>(std::ceil((right + halo - window.x0) / pitch)),
                   static_cast<int>(std::ceil((bottom + halo - window.y0) / pitch))};
    return window;
}

std::vector<Surface> patchSurfaces(const Document& document, const LitRegions& regions, Point<CameraFrame> at,
                                   const PatchWindow& window) {
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
        if (same == parts.end()) parts.push_back({distance, lit.region->id, std::vector<float>(pixelCount(window))});
    }
    if (parts.size() == 1) {
        std::ranges::fill(parts.front().share, 1.0F);
    } else {
        std::vector<float> shares(regions.all().size());
        forEachSample(window, document.scene.size(), [&](std::size_t i, int x, int y, float part) {
            regions.shares(x, y, shares);
            for (std::size_t r = 0; r < shares.size(); ++r)
                parts[partOf[r]].share[i] += part * shares[r];
        });
    }
    std::ranges::sort(parts, {}, &Part::distance);
    std::vector<SceneLayer> layers;
    for (Part& part : parts)
        layers.push_back({part.region, part.distance, Image<float>(window.size, 1, std::move(part.share))});
    return surfaces(layers, {0, 0, window.size.width, window.size.height});
}

std::vector<Light> hardLights(const LitRegions& regions, const Plan& plan, const PatchWindow& window) {
    const auto total = static_cast<double>(plan.slots.size());
    double litSlots = 0.0;
    for (const Level& level : plan.levels)
        litSlots += level.exposure;
    const double even = plan.light * total / litSlots;
    std::vector<std::vector<float>> values(plan.levels.size(), std::vector<float>(pixelCount(window)));
    forEachSample(window, regions.size(), [&](std::size_t i, int x, int y, float part) {
        const auto own = regions.all()[regions.owner(x, y)].level;
        for (std::size_t l = 0; l < values.size(); ++l) {
            const double share = !own ? even : *own == static_cast<int>(l) ? 1.0 : 0.0;
            values[l][i] += part * static_cast<float>(share);
        }
    });
    std::vector<Light> lights;
    for (std::size_t l = 0; l < plan.levels.size(); ++l) {
        lights.push_back({Image<float>(window.size, 1, std::move(values[l])), plan.levels[l].power,
                          plan.levels[l].exposure / total / plan.light});
    }
    return lights;
}

std::vector<Light> programLights(const Compiled& compiled, const PatchWindow& window) {
    const Plan& plan = compiled.plan;
    std::vector<double> slots(plan.levels.size(), 0.0);
    for (const Slot& slot : plan.slots) {
        for (const LevelLight& lit : slot.lit)
            slots[static_cast<std::size_t>(lit.level)] += lit.weight;
    }
    const PixelMap map = pixelMap(compiled.document);
    const auto under = rasterUnder(window, map, compiled.program.projector);
    std::vector<Light> lights;
    for (std::size_t l = 0; l < plan.levels.size() && l < compiled.program.images.size(); ++l) {
        if (slots[l] <= 0.0) continue;
        const NearRaster raster(compiled.program.images[l], under);
        std::vector<float> light;
        light.reserve(pixelCount(window));
        for (int y = 0; y < window.size.height; ++y) {
            for (int x = 0; x < window.size.width; ++x)
                light.push_back(raster.at(map.toProjector(window.toPicture(x + 0.5, y + 0.5))));
        }
        const double share = slots[l] / static_cast<double>(plan.slots.size());
        lights.push_back({Image<float>(window.size, 1, std::move(light)), plan.levels[l].power, share / plan.light});
    }
    return lights;
}

PixelRect<ProjectorFrame> rasterUnder(const PatchWindow& window, const PixelMap& map, Size raster) {
    double x0 = 1e9, y0 = 1e9, x1 = -1e9, y1 = -1e9;
    const int parts = map.dense() ? 32 : 2;  // a scanned map may bulge anywhere
    for (int i = 0; i <= parts; ++i) {
        for (int j = 0; j <= parts; ++j) {
            const double x = static_cast<double>(i) / parts, y = static_cast<double>(j) / parts;
            const auto p = map.toProjector(window.toPicture(x * window.size.width, y * window.size.height));
            x0 = std::min(x0, p.x);
            x1 = std::max(x1, p.x);
            y0 = std::min(y0, p.y);
            y1 = std::max(y1, p.y);
        }
    }
    // What lies farther out than this repeats the edge anyway.
    constexpr double kBeyond = 2.0;
    const auto low = [&](double v, int length) {
        return static_cast<int>(std::floor(std::clamp(v - 2.0, -kBeyond, length - 2.0)));
    };
    const auto high = [&](double v, int length) {
        return static_cast<int>(std::ceil(std::clamp(v + 2.0, 2.0, length + kBeyond)));
    };
    return {low(x0, raster.width), low(y0, raster.height), high(x1, raster.width), high(y1, raster.height)};
}

Seen seenThrough(const Plan& plan, const Looking& looking, Metre planned, Dioptre lens) {
    const Misplaced& off = looking.off;
    EyeOptics eye = plan.input.eye;
    eye.pupil += off.pupil;
    eye.lensToPupil += off.lensToPupil;
    const Attention attention =
        plan.input.camera ? Attention{} : Attention{true, off.distance * looking.attended, plan.focusPower, {}};
    // Lengths are taken on the surface, where the light lies, whatever the eye's true place.
    const Metre distance = off.distance * planned;
    const Dioptre defocus = seenDefocus(eye, attention, distance, lens);
    const Metre lever = (distance + eye.lensToPupil) / magnification(eye, distance, 0.0_D, lens);
    return {lever * (0.5 * (eye.pupil * defocus)), magnification(eye, distance, plan.focusPower, lens)};
}

Block seenPatch(const Compiled& compiled, const PatchWindow& window, const std::vector<Surface>& surfaces,
                const std::vector<Light>& lights, const Looking& looking) {
    const Plan& plan = compiled.plan;
    const Misplaced& off = looking.off;
    const double metre = pixelsPerMetre(compiled.document, looking.centreDistance);
    Block image(window.size.width, window.size.height, 1);
    const Image<float> white(window.size, 1, std::vector<float>(pixelCount(window), 1.0F));
    for (const Light& light : lights) {
        std::vector<Appearance> looks;
        for (const Surface& surface : surfaces) {
            const Seen seen = seenThrough(plan, looking, surface.distance, light.power);
            const double pixels = pixelsPerMetre(compiled.document, surface.distance) / window.pitch;
            const auto centre = opticalCentre(compiled.document, looking.eye, surface.distance);
            const auto at = window.toPatch({centre.x + metre * off.centreX.si(), centre.y + metre * off.centreY.si()});
            looks.push_back({pixels * seen.radius.si(), seen.magnification, at.x, at.y});
        }
        const bool shifts = off.registrationX != 0.0_m || off.registrationY != 0.0_m;
        if (!shifts || abs(light.power - plan.focusPower) < 1e-4_D) {
            addLight(image, surfaces, looks, white, light);
            continue;
        }
        const double pixels = metre / window.pitch;
        addLight(image, surfaces, looks, white,
                 {moved(light.light, pixels * off.registrationX.si(), pixels * off.registrationY.si()), light.power,
                  light.weight});
    }
    return image;
}

double Displacement::reach(const Seam& seam) const {
    return std::max(4.0, pixelsPerMetre * seam.feather.si() + 2.0 * radius + std::abs(this->seam()));
}

Displacement displacementAt(const Compiled& compiled, Point<CameraFrame> at, double nx, double ny, Metre distance,
                            Dioptre power) {
    const Plan& plan = compiled.plan;
    Displacement found;
    found.distance = distance;
    found.pixelsPerMetre = pixelsPerMetre(compiled.document, distance);
    found.radius = found.pixelsPerMetre * blurRadiusOnSurface(plan.input.eye, distance, plan.focusPower, power).si();
    found.stretch = magnification(plan.input.eye, distance, plan.focusPower, power) - 1.0;
    for (const Eye eye : {Eye::left, Eye::right}) {
        const Point<CameraFrame> c = opticalCentre(compiled.document, eye, distance);
        const double dx = at.x - c.x, dy = at.y - c.y;
        found.shift = std::max(found.shift, std::abs(found.stretch) * std::hypot(dx, dy));
        found.along[eye == Eye::left ? 0 : 1] = found.stretch * (dx * nx + dy * ny);
    }
    return found;
}

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

}  // namespace ilf::view
