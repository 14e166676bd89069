// The perceived view by brute force: what the fast way is measured against.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/perceived/perceived.h"

namespace ilf {

namespace reference {
struct Setup;  // reference_integral.h
}

/// How many rays, and which.
struct ReferenceRays {
    int samples = 4096;  ///< of pupil and time together, for each pixel, each level and (`chromatic`) each colour; >= 2
    unsigned seed = 1;
};

/// A pixel of the view.
struct ViewPixel {
    int x = 0, y = 0;
    bool operator==(const ViewPixel&) const = default;
};

/// Linear RGB radiance of single pixels, in the order asked, with its own noise floor.
struct ReferencePixels {
    std::vector<std::array<double, 3>> radiance;
    /// The PSNR a perfect view would have against this one: each half of the rays is a randomised quasi-Monte-Carlo
    /// estimate of its own (other shifts of the sequence), and half their difference has the variance of their mean.
    /// Infinite where nothing is random (a plain view).
    double noiseFloor_dB = 0.0;
    bool operator==(const ReferencePixels&) const = default;
};

struct ReferencePicture {
    Radiance radiance;
    double noiseFloor_dB = 0.0;
};

/// The integral that `perceived` stands for, over pupil and time together: for each level, the moments at which it is
/// lit (`view::exposures`; the lens's power is the waveform's at that moment) and the points of the pupil are one
/// low-discrepancy sequence (Sobol, shifted at random for each pixel). Rays are traced through T and R matrices
/// (core/optics/ray_matrix.h) to the surfaces of the scene, in double; neither the closed forms of D_r and s nor
/// anything of the fast way is used.
///
/// Surfaces: constant ones are planes across the axis; planes are met where the ray is, not cut into layers; a depth
/// map is bilinear in vergence and torn where neighbouring pixels lie apart. Hits are taken front to back, by distance.
/// What covers a pixel is the topmost region's share of it; behind a nearer surface nothing is known, and no light
/// comes from there. Between pixel centres light times reflectance times coverage is bilinear, and nothing lies outside
/// the picture.
///
/// The view's own frame is the picture: every surface is drawn where the view through the lens at
/// `Plan::focusPower` shows it, for an eye turned aside too.
class Reference {
public:
    /// Refusals as `perceived`, and colours that the eye's refraction is not known for.
    static Result<Reference> of(const Document& document, const Plan& plan, const Program& program,
                                const ViewRequest& request);

    Size size() const;
    /// Only if rays.samples >= 2 (else a refusal in one sentence). The same for any number of threads.
    Result<ReferencePicture> picture(const ReferenceRays& rays) const;
    /// Also refused: a pixel outside the view.
    Result<ReferencePixels> pixels(std::span<const ViewPixel> pixels, const ReferenceRays& rays) const;

    /// 32 hexadecimal digits that name a result: equal only if everything it depends on is (what was drawn from scene,
    /// masks, distances, plan, program and request; the rays; the method's own version). Empty `pixels`: the picture.
    std::string key(const ReferenceRays& rays, std::span<const ViewPixel> pixels = {}) const;

private:
    explicit Reference(std::shared_ptr<const reference::Setup> setup) : setup_(std::move(setup)) {}
    std::shared_ptr<const reference::Setup> setup_;
};

}  // namespace ilf
