// Rays from a view's pixel through pupil and lens back to the scene, by ray transfer matrices.
#pragma once

#include <array>
#include <optional>

#include "core/optics/ray_matrix.h"
#include "core/perceived/perceived.h"
#include "core/perceived/reference_scene.h"

namespace ilf::reference {

/// Across and down; metres or pixels.
struct Pair {
    double x = 0.0, y = 0.0;
};

/// The eye (or camera) behind its lens. Heights are from the lens's axis, which is parallel to the picture camera's.
struct Optics {
    double lensToPupil = 0.0, pupilRadius = 0.0;
    double restPower = 0.0;  ///< through which the picture shows the scene
    /// How much the eye's power exceeds what would focus parallel light, in red, green and blue: rays that meet on the
    /// retina converge by it at the pupil.
    std::array<double, 3> surplus{};
    Pair pupil;                 ///< centre of a pupil that stands still
    double turning = 0.0;       ///< above 0: the eye turns to each pixel about a point this far behind its pupil
    std::optional<double> rim;  ///< radius of the lens, beyond which the eye looks past it

    Pair lens;  ///< the lens's axis from the camera's, metres
    Pair axis;  ///< the camera's axis in the picture, pixels of the picture
    double focalPixels = 1.0;
    Frame frame;

    bool colours() const { return surplus[0] != surplus[1] || surplus[2] != surplus[1]; }
};

/// Refused: a region to look at that is not there, colours without known refraction, a gaze at nothing.
Result<Optics> optics(const Document& document, const Plan& plan, const ViewRequest& request, const Frame& frame);

/// From the pupil back through a lens of `power` to a plane `distance` before it.
constexpr RayMatrix backTo(double distance, double power, double lensToPupil) {
    return travel(-distance) * thinLens(-power) * travel(-lensToPupil);
}

/// One pixel of the view, as the picture shows it on surfaces at one distance: the ray through the pupil's centre.
struct ChiefRay {
    Pair height;  ///< at the pupil
    Pair slope;
};
ChiefRay chiefRay(const Optics& optics, Pair view, double distance);

/// A plane across the axis, as the picture shows it: the picture is taken from the pupil's plane, where a pixel is
/// 1 / f_px of slope. Heights on it, in metres from the lens's axis, to view pixels and back.
struct Shown {
    double perMetreX, perMetreY, axisX, axisY;

    Shown(const Optics& optics, double distance)
        : perMetreX(optics.focalPixels / (distance + optics.lensToPupil) * optics.frame.perPictureX),
          perMetreY(optics.focalPixels / (distance + optics.lensToPupil) * optics.frame.perPictureY),
          axisX(optics.axis.x * optics.frame.perPictureX + optics.lens.x * perMetreX),
          axisY(optics.axis.y * optics.frame.perPictureY + optics.lens.y * perMetreY) {}
    Pair view(double x, double y) const { return {axisX + x * perMetreX, axisY + y * perMetreY}; }
    Pair metres(Pair view) const { return {(view.x - axisX) / perMetreX, (view.y - axisY) / perMetreY}; }
};

/// The ray that meets the pupil `aside` its centre (metres) and the retina where the chief ray does, traced by `back`
/// (backTo the plane that is shown); `surplus` of its colour. Gives the view position of the point it comes from.
inline Pair traced(const Shown& shown, const RayMatrix& back, const ChiefRay& chief, Pair aside, double surplus) {
    const Ray across = back * Ray{chief.height.x + aside.x, chief.slope.x + surplus * aside.x};
    const Ray down = back * Ray{chief.height.y + aside.y, chief.slope.y + surplus * aside.y};
    return shown.view(across.height, down.height);
}

/// Whether that ray passes the lens outside its rim.
bool pastRim(const Optics& optics, const ChiefRay& chief, Pair aside, double surplus);

}  // namespace ilf::reference
