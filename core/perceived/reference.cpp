// The perceived view by rays: no closed form of blur or magnification, nothing shared with the fast way but the scene.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/parallel.h"
#include "core/perceived/perceived.h"
#include "core/perceived/setting.h"

namespace ilf {
namespace {

/// A paraxial ray at one plane: height in metres, slope in radians, light travelling towards the eye.
struct Ray {
    double height, slope;
};

/// Acts on (height, slope). T(gap): free space; R(power): a thin lens.
struct Transfer {
    double a, b, c, d;
    Ray operator()(Ray r) const { return {a * r.height + b * r.slope, c * r.height + d * r.slope}; }
    friend Transfer operator*(const Transfer& m, const Transfer& n) {
        return {m.a * n.a + m.b * n.c, m.a * n.b + m.b * n.d, m.c * n.a + m.d * n.c, m.c * n.b + m.d * n.d};
    }
};
Transfer freeSpace(double gap) { return {1.0, gap, 0.0, 1.0}; }
Transfer thinLens(double power) { return {1.0, 0.0, -power, 1.0}; }

/// From a ray at the pupil back to where it left a surface at `distance`.
Transfer backToSurface(const EyeOptics& eye, Metre distance, Dioptre lens) {
    return freeSpace(-distance.si()) * thinLens(-lens.si()) * freeSpace(-eye.lensToPupil.si());
}

/// How much the eye's power exceeds what focuses parallel light on its retina, while it attends what it attends.
double surplusPower(const EyeOptics& eye, const Plan& plan, const view::Attention& attention) {
    const double relaxed = -eye.ametropia.si();
    if (plan.input.camera || attention.attended <= 0.0_m) return relaxed;
    // The attended point is sharp when every ray from one retinal point meets it, whatever its height in the pupil.
    const Transfer back = backToSurface(eye, attention.attended, attention.lens);
    const double sharp = -back.a / back.b;
    return std::clamp(sharp, relaxed, relaxed + eye.accommodation.si());
}

/// Where rays of one light meet one surface: view pixel = centre + gain * (pixel - centre) + spread * pupil height.
struct Meeting {
    double centreX, centreY, gain, spread;
};

Meeting meeting(const Document& document, const Plan& plan, Eye whose, double surplus, const view::ViewScale& scale,
                Metre distance, Dioptre lens) {
    const EyeOptics& eye = plan.input.eye;
    const Point<CameraFrame> centre = opticalCentre(document, whose, distance);
    const double pixelsPerMetreHere = pixelsPerMetre(document, distance) * scale.nominal;
    // The picture shows the surface at the focus power: that fixes the slope of a pixel's chief ray.
    const double heightOfSlope = backToSurface(eye, distance, plan.focusPower)({0.0, 1.0}).height;
    const Transfer back = backToSurface(eye, distance, lens);
    // A ray through the pupil at height p ends where the chief ray of slope theta does if its slope is theta + surplus
    // p.
    const double chief = back({0.0, 1.0}).height, marginal = back({1.0, surplus}).height;
    return {centre.x * scale.x, centre.y * scale.y, chief / heightOfSlope, marginal * pixelsPerMetreHere};
}

/// What a ray meets on a surface: bilinear between pixel centres, nothing outside the picture.
struct Met {
    double coverage = 0.0;
    std::array<double, 3> light{};
};
Met looked(const Image<float>& alpha, const Image<float>& light, const Radiance& albedo, double x, double y) {
    Met met;
    const double left = std::floor(x - 0.5), top = std::floor(y - 0.5);
    const double fx = x - 0.5 - left, fy = y - 0.5 - top;
    for (int corner = 0; corner < 4; ++corner) {
        const int dx = corner & 1, dy = corner >> 1;
        const int i = static_cast<int>(left) + dx, j = static_cast<int>(top) + dy;
        if (i < 0 || j < 0 || i >= alpha.width() || j >= alpha.height()) continue;
        const double part = (dx == 1 ? fx : 1.0 - fx) * (dy == 1 ? fy : 1.0 - fy);
        const double covered = part * alpha.at(i, j);
        if (covered <= 0.0) continue;
        met.coverage += covered;
        const double lit = covered * light.at(i, j);
        for (int c = 0; c < 3; ++c)
            met.light[static_cast<std::size_t>(c)] += lit * albedo.at(i, j, c);
    }
    return met;
}

/// More than half a pixel beyond all that a surface covers: a ray passes.
bool outside(PixelRect<view::ViewFrame> covered, double x, double y) {
    return x < covered.x0 - 0.5 || y < covered.y0 - 0.5 || x > covered.x1 + 0.5 || y > covered.y1 + 0.5;
}

/// Low-discrepancy points of the pupil's disc (R2 sequence), in metres.
std::vector<Point<view::ViewFrame>> pupilPoints(double diameter, int samples) {
    std::vector<Point<view::ViewFrame>> points;
    const double plastic = 1.32471795724474602596;
    for (int i = 0; i < samples; ++i) {
        const double u = std::fmod(0.5 + (i + 1) / plastic, 1.0),
                     v = std::fmod(0.5 + (i + 1) / (plastic * plastic), 1.0);
        const double radius = 0.5 * diameter * std::sqrt(u), angle = 2.0 * std::numbers::pi * v;
        points.push_back({radius * std::cos(angle), radius * std::sin(angle)});
    }
    return points;
}

/// Turns the pupil by a different angle for every pixel, so that neighbours do not share their error.
double turnOfPixel(int x, int y, unsigned seed) {
    std::uint32_t h =
        static_cast<std::uint32_t>(x) * 0x9e3779b1U ^ static_cast<std::uint32_t>(y) * 0x85ebca77U ^ seed * 0xc2b2ae3dU;
    h ^= h >> 15U;
    h *= 0x2c1b3c6dU;
    h ^= h >> 12U;
    h *= 0x297a2d39U;
    h ^= h >> 15U;
    return 2.0 * std::numbers::pi * (static_cast<double>(h) / 4294967296.0);
}

}  // namespace

Result<Radiance> perceivedReference(const Document& document, const Plan& plan, const Program& program,
                                    const ViewRequest& request, int samples, unsigned seed) {
    const auto setting = view::setting(document, plan, program, request);
    if (!setting) return tl::unexpected(setting.error());
    if (samples < 1) return fail(Fault::outOfRange, "The reference needs at least one ray for each pixel.");
    const Radiance albedo = view::albedo(document, setting->scale);
    if (setting->plain) return albedo;

    const Size size = setting->scale.size;
    const PixelRect<view::ViewFrame> window{0, 0, size.width, size.height};
    const auto surfaces = view::surfaces(layers(document, plan, request.scale), window);
    const auto lights = view::lights(document, plan, program, setting->scale, window);
    const auto pupil = pupilPoints(plan.input.eye.pupil.si(), samples);
    const double surplus = surplusPower(plan.input.eye, plan, setting->attention);
    std::vector<std::vector<Meeting>> meetings;
    for (const view::Light& light : lights) {
        auto& row = meetings.emplace_back();
        for (const view::Surface& surface : surfaces) {
            row.push_back(meeting(document, plan, request.eye, surplus, setting->scale, surface.distance, light.power));
        }
    }

    std::vector<float> pixels(albedo.pixels().size());
    parallelFor(size.height, [&](int y) {
        for (int x = 0; x < size.width; ++x) {
            const double turn = turnOfPixel(x, y, seed), cosine = std::cos(turn), sine = std::sin(turn);
            std::array<double, 3> sum{};
            for (std::size_t l = 0; l < lights.size(); ++l) {
                const double weight = lights[l].weight / samples;
                for (const auto& p : pupil) {
                    const double px = p.x * cosine - p.y * sine, py = p.x * sine + p.y * cosine;
                    double passing = weight;
                    for (std::size_t k = 0; k < surfaces.size() && passing > 0.0; ++k) {
                        const Meeting& m = meetings[l][k];
                        const double atX = m.centreX + m.gain * (x + 0.5 - m.centreX) + m.spread * px;
                        const double atY = m.centreY + m.gain * (y + 0.5 - m.centreY) + m.spread * py;
                        if (outside(surfaces[k].covered, atX, atY)) continue;
                        const Met met = looked(surfaces[k].alpha, lights[l].light, albedo, atX, atY);
                        for (std::size_t c = 0; c < 3; ++c)
                            sum[c] += passing * met.light[c];
                        passing *= 1.0 - met.coverage;
                    }
                }
            }
            float* out =
                pixels.data() +
                (static_cast<std::size_t>(y) * static_cast<std::size_t>(size.width) + static_cast<std::size_t>(x)) * 3;
            for (std::size_t c = 0; c < 3; ++c)
                out[c] = static_cast<float>(sum[c]);
        }
    });
    return Radiance(size, 3, std::move(pixels));
}

}  // namespace ilf
