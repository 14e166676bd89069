// What the eye is accommodated to, and how blurred and magnified that makes a surface.
#pragma once

#include "core/base/geometry.h"
#include "core/document/document.h"
#include "core/perceived/perceived.h"
#include "core/perceived/surfaces.h"

namespace ilf::view {

/// The eye holds `attended` sharp through `lens`, or, where its range does not reach, accommodates by `amount`.
struct Attention {
    bool holds = false;
    Metre attended;
    Dioptre lens;
    Dioptre amount;
};

/// To the region asked for, else to the nearest focused one, else relaxed. A camera keeps its focus.
Result<Attention> attention(const Plan& plan, const ViewRequest& request);

/// Signed defocus of a surface for that eye.
Dioptre seenDefocus(const EyeOptics& eye, const Attention& attention, Metre distance, Dioptre lens);

/// How a surface looks at one lens power, in view pixels of a window.
struct Appearance {
    /// Signed radius of the blur disc on the surface, before magnification: f_px E (D_e / 2) N(P) / (d + e).
    double radius = 0.0;
    double magnification = 1.0;  ///< about `centre`, against the focus power
    double centreX = 0.0, centreY = 0.0;
    bool operator==(const Appearance&) const = default;
};
/// `colour` is the eye's refraction in that light against the one it is focused with, dioptres (chromaticRefraction).
Appearance appearance(const Document& document, const Plan& plan, const ViewRequest& request,
                      const Attention& attention, const ViewScale& scale, PixelRect<ViewFrame> window, Metre distance,
                      Dioptre lens, Dioptre colour = {});

/// How far a fixed gaze moves the pupil aside, across the lens: kPupilToRotationCentre sin(angle), towards the point.
struct PupilShift {
    Metre right, down;
    bool operator==(const PupilShift&) const = default;
};
PupilShift pupilShiftOf(const Document& document, const Plan& plan, const ViewRequest& request);

}  // namespace ilf::view
