#include "core/perceived/reference_integral.h"

#include <algorithm>

#include "core/perceived/reference_points.h"

namespace ilf::reference {
namespace {

/// The moment that a fraction of a light's weight has fallen by.
Second momentOf(const Light& light, double fraction) {
    double left = fraction * light.weight;
    for (const view::Exposure& exposure : light.exposures) {
        if (left < exposure.weight) return exposure.start + (left / exposure.weight) * exposure.duration;
        left -= exposure.weight;
    }
    return light.exposures.back().start + light.exposures.back().duration;
}

}  // namespace

/// Of one half and light: the lens's power at each sample, and the way back to each flat surface through it.
struct Integral::Moments {
    std::vector<double> powers;
    std::vector<RayMatrix> back;  ///< sample by sample
};

Colour Halves::mean() const {
    Colour mean;
    for (std::size_t c = 0; c < 3; ++c)
        mean[c] = 0.5 * (half[0][c] + half[1][c]);
    return mean;
}

double Halves::squaredError() const {
    double sum = 0.0;
    for (std::size_t c = 0; c < 3; ++c) {
        const double error = 0.5 * (half[0][c] - half[1][c]);
        sum += error * error;
    }
    return sum;
}

Integral::~Integral() = default;

Integral::Integral(const Setup& setup, const ReferenceRays& rays)
    : setup_(setup), seed_(rays.seed), samples_(static_cast<std::size_t>(rays.samples + 1) / 2),
      points_(sobolPoints(static_cast<int>(samples_))) {
    for (std::uint64_t half = 0; half < 2; ++half) {
        // All pixels share the moments: their errors differ by the points of the pupil that go with them.
        const auto shift = static_cast<std::uint32_t>(mixed(seed_, half, 3));
        for (const Light& light : setup.scene.lights) {
            Moments& moments = moments_.emplace_back();
            for (const auto& point : points_) {
                const double power = setup.wave.powerAt(momentOf(light, shifted(point[2], shift))).si();
                moments.powers.push_back(power);
                for (const Surface& surface : setup.scene.surfaces) {
                    if (surface.kind != Surface::Kind::flat) break;
                    moments.back.push_back(backTo(1.0 / surface.vergence.at, power, setup.optics.lensToPupil));
                }
            }
        }
    }
}

Halves Integral::at(ViewPixel pixel) const {
    Halves halves;
    for (std::size_t half = 0; half < 2; ++half)
        addHalf(pixel, half, halves.half[half]);
    return halves;
}

void Integral::addHalf(ViewPixel pixel, std::size_t half, Colour& sum) const {
    const Scene& scene = setup_.scene;
    const Optics& optics = setup_.optics;
    const Frame& frame = scene.frame;
    const std::size_t here = frame.index(pixel.x, pixel.y);
    const Pair view{pixel.x + 0.5, pixel.y + 0.5};
    const std::uint64_t shift = mixed(static_cast<std::uint64_t>(here), seed_, half);  // two of 32 bits
    std::vector<Pair> pupil;
    for (const auto& point : points_) {
        Pair& at = pupil.emplace_back();
        onDisc(shifted(point[0], static_cast<std::uint32_t>(shift)),
               shifted(point[1], static_cast<std::uint32_t>(shift >> 32U)), at.x, at.y);
        at = {optics.pupilRadius * at.x, optics.pupilRadius * at.y};
    }
    std::vector<ChiefRay> chiefs;  // of flat surfaces
    std::vector<Shown> shown;
    for (const Surface& surface : scene.surfaces) {
        if (surface.kind != Surface::Kind::flat) break;
        chiefs.push_back(chiefRay(optics, view, 1.0 / surface.vergence.at));
        shown.emplace_back(optics, 1.0 / surface.vergence.at);
    }
    const bool sloped = chiefs.size() < scene.surfaces.size();

    struct Hit {
        double vergence;
        Met met;
    };
    std::vector<Hit> hits;
    std::vector<Meeting> meetings;
    std::vector<double> through(samples_, 1.0);  // share of the view that the ray sees through the lens
    const double each = 1.0 / static_cast<double>(samples_);
    // Colours that focus alike are one ray.
    for (std::size_t first = 0; first < 3;) {
        const std::size_t last = optics.colours() ? first + 1 : 3;
        const double surplus = optics.surplus[first];
        if (optics.rim) {
            std::ranges::fill(through, 1.0);
            for (const Surface& surface : scene.surfaces) {
                if (surface.share[here] <= 0.0) continue;
                const ChiefRay chief = chiefRay(optics, view, 1.0 / surface.at(frame, pixel.x, pixel.y));
                for (std::size_t i = 0; i < samples_; ++i) {
                    if (pastRim(optics, chief, pupil[i], surplus)) through[i] -= surface.share[here];
                }
            }
            for (std::size_t i = 0; i < samples_; ++i) {
                for (std::size_t c = first; c < last; ++c)
                    sum[c] += each * (1.0 - through[i]) * scene.plain[3 * here + c];
            }
        }
        for (std::size_t l = 0; l < scene.lights.size(); ++l) {
            const Light& light = scene.lights[l];
            const Moments& moments = moments_[half * scene.lights.size() + l];
            for (std::size_t i = 0; i < samples_; ++i) {
                double passing = each * light.weight * through[i];
                if (passing <= 0.0) continue;
                const auto pass = [&](const Met& met) {
                    for (std::size_t c = first; c < last; ++c)
                        sum[c] += passing * met.light[c];
                    passing *= 1.0 - met.coverage;
                    return passing > 0.0;
                };
                hits.clear();
                for (std::size_t k = 0; k < chiefs.size(); ++k) {
                    const Surface& surface = scene.surfaces[k];
                    const Pair at = traced(shown[k], moments.back[i * chiefs.size() + k], chiefs[k], pupil[i], surplus);
                    if (misses(surface, at)) continue;
                    const Met what = met(frame, surface, light, at, surface.vergence.at);
                    if (sloped) {
                        hits.push_back({surface.vergence.at, what});
                    } else if (!pass(what)) {
                        break;
                    }
                }
                if (!sloped) continue;
                const Path path{optics, view, pupil[i], surplus, moments.powers[i]};
                for (std::size_t k = chiefs.size(); k < scene.surfaces.size(); ++k) {
                    const Surface& surface = scene.surfaces[k];
                    meetings.clear();
                    if (surface.kind == Surface::Kind::plane) {
                        if (const auto one = meetsPlane(surface, path)) meetings.push_back(*one);
                    } else {
                        meetsMap(frame, surface, path, meetings);
                    }
                    for (const Meeting& one : meetings) {
                        if (!misses(surface, one.at))
                            hits.push_back({one.vergence, met(frame, surface, light, one.at, one.vergence)});
                    }
                }
                std::ranges::stable_sort(hits, [](const Hit& a, const Hit& b) { return a.vergence > b.vergence; });
                for (const Hit& hit : hits) {
                    if (!pass(hit.met)) break;
                }
            }
        }
        first = last;
    }
}

}  // namespace ilf::reference
