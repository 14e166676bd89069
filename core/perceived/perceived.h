// The perceived view: what one eye sees of the scene while a program plays.
#pragma once

#include <optional>

#include "core/base/image.h"
#include "core/compile/program.h"
#include "core/document/document.h"
#include "core/plan/plan.h"

namespace ilf {

/// Whose view, and how large. The picture is the view from the pupil through the lens at rest.
struct ViewRequest {
    Eye eye = Eye::left;
    /// The eye accommodates to what it looks at: a region's id; none: to the nearest focused object (or stays relaxed
    /// if nothing is focused).
    std::optional<RegionId> attending;
    /// Output pixels per picture pixel, 0 < scale <= 1. Blur and magnification shrink along.
    double scale = 1.0;
    bool operator==(const ViewRequest&) const = default;
};

/// One surface of the scene as an eye meets it: constant distance, coverage in the picture (0..1, topmost wins).
struct SceneLayer {
    RegionId region;
    Metre distance;         ///< of the layer's surface (sloped ones are cut into layers)
    Image<float> coverage;  ///< at the request's scale
};

/// The scene cut into layers, nearest first. Planes and depth maps are cut where blur would change by more than half a
/// pixel or an eighth of itself.
std::vector<SceneLayer> layers(const Document& document, const Plan& plan, double scale);

/// Radiance that reaches the eye, linear RGB at the request's scale, normalised so that a scene in steady light looks
/// like its picture: per slot and layer light * albedo, blurred by the disc of that layer's defocus, magnified about
/// the eye's optical centre, hidden by nearer layers, summed over the sweep. Radiance is conserved (no 1/s^2).
/// Light comes from the program's own slot images through the registration, not from the document's masks.
Result<Radiance> perceived(const Document& document, const Plan& plan, const Program& program,
                           const ViewRequest& request);

/// The plain view: the scene in steady light, no blur. Same scale and norm.
Radiance plainView(const Document& document, double scale);

/// The same as `perceived` by brute force: rays through the pupil and the lens (ray transfer matrices T and R, none of
/// the closed forms), joint visibility, `samples` points of the pupil per pixel, seeded. Slow: for checks.
Result<Radiance> perceivedReference(const Document& document, const Plan& plan, const Program& program,
                                    const ViewRequest& request, int samples, unsigned seed);

/// Peak signal-to-noise ratio in dB, peak 1; infinite for equal pictures. Sizes must agree.
double psnr(const Radiance& a, const Radiance& b);

}  // namespace ilf
