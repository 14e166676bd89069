// What may be wrong with the wearer a program was made for, and what that does to a seam.
#pragma once

#include <string>
#include <vector>

#include "core/base/quantity.h"
#include "core/optics/eye.h"

namespace ilf {

enum class SeamErrorKind { pupil, distance, registration, gaze, lensToPupil };

/// Errors a seam is judged under. Each is taken alone and in both directions.
struct SeamErrors {
    Metre pupil = 1.0_mm;               ///< the pupil is that much larger or smaller than thought
    double nearer = 0.05;               ///< the wearer stands nearer than thought by this part of the distance,
    double farther = 0.10;              ///< or farther by this one; the light stays where it is on the surface
    Metre registration = 0.25_mm;       ///< light of the blur levels against the other light, on the surface
    Metre coarseRegistration = 0.5_mm;  ///< shown as well, not counted
    Metre gaze = 5.0_mm;                ///< the optical centre against where it was thought, on the surface
    double turned_deg = 10.0;           ///< the eye turned by this, its pupil moves aside; shown as well, not counted
    Metre lensToPupil = 2.0_mm;         ///< d_Ee is that much larger or smaller
    bool operator==(const SeamErrors&) const = default;
};

/// How one eye and its place differ from the plan; the default is as planned.
struct Misplaced {
    Metre pupil;                         ///< added to its diameter
    double distance = 1.0;               ///< times the planned distance
    Metre lensToPupil;                   ///< added to d_Ee
    Metre registrationX, registrationY;  ///< of the blur levels' light, on the surface
    Metre centreX, centreY;              ///< of the optical centre, on the surface
    bool operator==(const Misplaced&) const = default;
};

/// One error: what it is called and the eyes it gives (its two directions). `nx`, `ny`: the border's normal, along
/// which displacements count.
struct SeamErrorCase {
    SeamErrorKind kind = SeamErrorKind::pupil;
    std::string what;
    std::vector<Misplaced> eyes;
    bool counts = true;
};
std::vector<SeamErrorCase> errorCases(const SeamErrors& errors, const EyeOptics& eye, Metre distance, double nx,
                                      double ny);

/// The feather that hides a seam: W = clamp(shift / 1 % - 2 R, 2 R, a third of the region) (scheduling 4.3).
struct HidingWidth {
    Metre shift;           ///< light of the two levels apart, along the normal: two axes, and all counted errors
    Metre axesShift;       ///< the part of it that two lens axes cause: each eye is half their distance off the middle
    Metre blurRadius;      ///< R on the surface
    Metre asked;           ///< shift / 1 % - 2 R, before clamping
    Metre width;           ///< W
    bool clamped = false;  ///< the region has no room for what is asked
    double left = 0.0;     ///< contrast that W leaves: shift / W
};
/// `region`: its extent across the surface.
HidingWidth hidingWidth(Metre axesShift, Metre errorShift, Metre blurRadius, Metre region);

/// The closed form's contrast where light of the two levels is `shift` apart and the feather `width` wide:
/// shift / width, at most 1.  The least that any blending could leave: shift / (width + 2 R) (scheduling 4.3).
double contrastOfShift(Metre shift, Metre width);
double leastContrastOfShift(Metre shift, Metre width, Metre blurRadius);
/// Where the blur disc is `change` larger or smaller than thought: 0.212 change / width, for width >= 2 R. (The corner
/// of a ramp, smoothed by a disc of radius R, lies 2 R / (3 pi) W beside itself.)
double contrastOfBlur(Metre change, Metre width);

}  // namespace ilf
