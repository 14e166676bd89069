// The perceived view: what one eye sees of the scene while a program plays.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "core/base/image.h"
#include "core/compile/program.h"
#include "core/document/document.h"
#include "core/plan/plan.h"

namespace ilf {

/// How carefully a view is worked out: what a frame of a drag may cost, one at rest, one that nobody waits for.
enum class Rung : std::uint8_t { dragging, rest, idle };
std::string_view word(Rung rung);  ///< "while dragging", "at rest", "refined"

/// Where the eye is turned while it attends what it attends.
enum class Gaze : std::uint8_t {
    ahead,    ///< along the lens's axis
    fixed,    ///< to ViewRequest::gazeAt, and stays: its pupil moves aside, and the centre of magnification with it
    follows,  ///< to every point in turn: magnified as seen from the eye's centre of rotation
};

/// Whose view, how large and how carefully. The picture is the view from the pupil through the lens at rest.
struct ViewRequest {
    Eye eye = Eye::left;
    /// The eye accommodates to what it looks at: a region's id; none: to the nearest focused object (or stays relaxed
    /// if nothing is focused).
    std::optional<RegionId> attending;
    /// Output pixels per picture pixel, 0 < scale <= 1. Blur and magnification shrink along.
    double scale = 1.0;
    Rung rung = Rung::rest;
    Gaze gaze = Gaze::ahead;
    Point<CameraFrame> gazeAt{};  ///< of Gaze::fixed
    /// Red, green and blue of the rig's primaries each in the focus the eye has for them (an eye's, not a camera's).
    bool chromatic = false;
    /// What lies beyond the lens's rim is seen past it: sharp, in steady light. An eye's, not a camera's.
    bool lensField = false;
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
/// like its picture: per light and layer light * albedo, blurred by the disc of that layer's defocus, magnified about
/// the eye's optical centre, hidden by nearer layers through the pupil, summed over the lens's powers while each level
/// is lit. Radiance is conserved (no 1/s^2). Light comes from the program's own images through the registration, not
/// from the document's masks; the room's ambient light falls on all of it during the whole sweep. One frame of a
/// `ViewEngine` that has seen nothing before.
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
