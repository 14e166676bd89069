#include "core/document/plane_fit.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <optional>
#include <random>
#include <vector>

#include "core/document/plane_anchors.h"
#include "core/document/seen_pixels.h"

namespace ilf {

namespace {

/// A measured pixel: place, vergence, and how far that may be off (1: not known).
struct Sample {
    double x, y, vergence, sigma;
};

constexpr std::size_t kMostSamples = 20'000;
constexpr std::size_t kFewestSamples = 100;
constexpr double kLeastSpread = 0.02;  // dioptres: less is no other surface
constexpr double kMostScatter = 0.1;   // dioptres, median: more is no plane, or a sensor of no use

std::vector<Sample> samplesOf(const Document& document, const Region& region) {
    const DepthMap& depth = *document.scene.depth;
    const bool sigmaKnown = depth.sigma.size() == depth.metres.size();
    std::size_t pixels = 0;
    forEachSeenTile(document, region, [&](const SeenTile& seen) {
        pixels += static_cast<std::size_t>(seen.pixels.width()) * static_cast<std::size_t>(seen.pixels.height());
    });
    const int step = std::max(1, static_cast<int>(std::sqrt(static_cast<double>(pixels) / kMostSamples)));
    std::vector<Sample> samples;
    forEachSeenTile(document, region, [&](const SeenTile& seen) {
        for (int y = (seen.pixels.y0 + step - 1) / step * step; y < seen.pixels.y1; y += step) {
            for (int x = (seen.pixels.x0 + step - 1) / step * step; x < seen.pixels.x1; x += step) {
                const double metres = static_cast<double>(depth.metres.at(x, y));
                if (!seen.at(x, y) || !(metres > 0.0)) continue;
                const double sigma = sigmaKnown ? static_cast<double>(depth.sigma.at(x, y)) / (metres * metres) : 0.0;
                samples.push_back({x + 0.5, y + 0.5, 1.0 / metres, sigma > 0.0 ? sigma : 1.0});
            }
        }
    });
    return samples;
}

std::optional<AffineVergence> through(const Sample& a, const Sample& b, const Sample& c) {
    const double bx = b.x - a.x, by = b.y - a.y, cx = c.x - a.x, cy = c.y - a.y;
    const double doubleArea = bx * cy - by * cx;
    if (std::abs(doubleArea) < 16.0) return std::nullopt;
    const double vb = b.vergence - a.vergence, vc = c.vergence - a.vergence;
    AffineVergence plane;
    plane.dx = (vb * cy - vc * by) / doubleArea;
    plane.dy = (vc * bx - vb * cx) / doubleArea;
    plane.at = a.vergence - plane.dx * a.x - plane.dy * a.y;
    return plane;
}

double residual(const AffineVergence& plane, const Sample& s) { return std::abs(s.vergence - plane(s.x, s.y)); }

/// Weighted least squares around the middle of the samples; nothing where they lie on a line.
std::optional<AffineVergence> fitted(const std::vector<Sample>& samples) {
    double w = 0.0, mx = 0.0, my = 0.0, mv = 0.0;
    for (const Sample& s : samples) {
        const double weight = 1.0 / (s.sigma * s.sigma);
        w += weight;
        mx += weight * s.x;
        my += weight * s.y;
        mv += weight * s.vergence;
    }
    mx /= w, my /= w, mv /= w;
    double xx = 0.0, xy = 0.0, yy = 0.0, xv = 0.0, yv = 0.0;
    for (const Sample& s : samples) {
        const double weight = 1.0 / (s.sigma * s.sigma), x = s.x - mx, y = s.y - my, v = s.vergence - mv;
        xx += weight * x * x;
        xy += weight * x * y;
        yy += weight * y * y;
        xv += weight * x * v;
        yv += weight * y * v;
    }
    const double determinant = xx * yy - xy * xy;
    // The smaller variance, in square pixels: a strip thinner than two pixels tells no slope across itself.
    const double trace = xx + yy;
    const double smaller = 0.5 * (trace - std::sqrt(std::max(0.0, trace * trace - 4.0 * determinant)));
    if (!(smaller > 0.33 * w)) return std::nullopt;
    AffineVergence plane;
    plane.dx = (xv * yy - yv * xy) / determinant;
    plane.dy = (yv * xx - xv * xy) / determinant;
    plane.at = mv - plane.dx * mx - plane.dy * my;
    return plane;
}

/// Of triples of samples the plane with the least median distance, and that median.
struct Candidate {
    AffineVergence plane;
    double median = INFINITY;
};
Candidate bestOfTriples(const std::vector<Sample>& samples) {
    constexpr int kTriples = 200;
    constexpr std::size_t kJudges = 1000;
    std::mt19937 random(0x1f0c5);  // the same map gives the same plane
    const auto any = [&] { return samples[random() % samples.size()]; };
    std::vector<Sample> judges;
    for (std::size_t i = 0; i < std::min(kJudges, samples.size()); ++i)
        judges.push_back(samples.size() <= kJudges ? samples[i] : any());
    Candidate best;
    std::vector<double> off(judges.size());
    for (int i = 0; i < kTriples; ++i) {
        const auto plane = through(any(), any(), any());
        if (!plane) continue;
        std::ranges::transform(judges, off.begin(), [&](const Sample& s) { return residual(*plane, s); });
        const auto middle = off.begin() + static_cast<std::ptrdiff_t>(off.size() / 2);
        std::nth_element(off.begin(), middle, off.end());
        if (*middle < best.median) best = {*plane, *middle};
    }
    return best;
}

tl::unexpected<Error> refused(const std::string& what) { return fail(Fault::outOfRange, what); }

}  // namespace

std::array<Point<CameraFrame>, 3> planeAnchors(const Document& document, const Region& region) {
    const Size size = document.scene.size();
    PixelRect<CameraFrame> box{};
    forEachSeenTile(document, region, [&](const SeenTile& seen) {
        for (int y = seen.pixels.y0; y < seen.pixels.y1; ++y) {
            for (int x = seen.pixels.x0; x < seen.pixels.x1; ++x) {
                if (!seen.at(x, y)) continue;
                const bool first = box.empty();
                box.x0 = first ? x : std::min(box.x0, x);
                box.y0 = first ? y : std::min(box.y0, y);
                box.x1 = first ? x + 1 : std::max(box.x1, x + 1);
                box.y1 = first ? y + 1 : std::max(box.y1, y + 1);
            }
        }
    });
    if (box.empty()) box = {0, 0, std::max(3, size.width), std::max(3, size.height)};
    const double x0 = box.x0, y0 = box.y0, w = box.width(), h = box.height();
    return {{{x0 + 0.2 * w, y0 + 0.8 * h}, {x0 + 0.8 * w, y0 + 0.8 * h}, {x0 + 0.5 * w, y0 + 0.15 * h}}};
}

Result<FittedPlane> fittedPlane(const Document& document, const Region& region) {
    const std::string name = "\"" + region.name + "\"";
    if (!document.scene.depth || document.scene.depth->metres.size() != document.scene.size()) {
        return fail(Fault::notFound, "There is no depth map to fit the plane of " + name +
                                         " to: load one, or place "
                                         "three points.");
    }
    const std::vector<Sample> samples = samplesOf(document, region);
    if (samples.size() < kFewestSamples) {
        return refused("Only " + std::to_string(samples.size()) + " measured pixels lie beneath " + name +
                       ", and a plane needs " + std::to_string(kFewestSamples) + ": paint more of the surface.");
    }
    const Candidate best = bestOfTriples(samples);
    const double within = std::max(kLeastSpread, 3.0 * 1.4826 * best.median);
    std::vector<Sample> on;
    const auto collect = [&](const AffineVergence& plane) {
        on.clear();
        std::ranges::copy_if(samples, std::back_inserter(on),
                             [&](const Sample& s) { return residual(plane, s) <= within; });
    };
    collect(best.plane);
    std::optional<AffineVergence> plane = fitted(on);
    if (plane) {
        collect(*plane);
        plane = fitted(on);
    }
    if (!plane) {
        return refused(name + " is too thin for a plane: its slope across cannot be told. Paint more of the surface.");
    }
    FittedPlane result;
    result.inliers = static_cast<double>(on.size()) / static_cast<double>(samples.size());
    if (result.inliers < 0.5 || best.median > kMostScatter) {
        return refused("No plane fits what the depth map has beneath " + name +
                       ": give it the depth map itself, or split it.");
    }
    const double farthest = 1.0 / kFarthestDistance.si();
    double squares = 0.0;
    for (const Sample& s : on) {
        const double vergence = (*plane)(s.x, s.y);
        if (vergence < farthest) {
            return refused("The plane of " + name + " reaches infinity inside it: erase what lies beyond its horizon.");
        }
        const double off = 1.0 / vergence - 1.0 / s.vergence;
        squares += off * off;
    }
    result.rms = Metre::fromSi(std::sqrt(squares / static_cast<double>(on.size())));
    const auto places = planeAnchors(document, region);
    for (std::size_t i = 0; i < places.size(); ++i) {
        const double vergence = (*plane)(places[i].x, places[i].y);
        if (vergence < farthest) {
            return refused("The plane of " + name + " reaches infinity inside it: erase what lies beyond its horizon.");
        }
        result.distance.anchors[i] = {places[i], Metre::fromSi(1.0 / vergence)};
    }
    result.distance.tolerance = 2.0 * result.rms;
    return result;
}

}  // namespace ilf
