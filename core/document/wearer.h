// Who looks: pupils, lenses, prescription and what counts as blurred for them.
#pragma once

#include <array>
#include <optional>
#include <string>

#include "core/base/quantity.h"

namespace ilf {

/// What "acceptably sharp" means, as a diameter on the retina.
struct CircleOfConfusion {
    enum class Preset {
        oneArcmin,     ///< 1 arcmin: reproduces the paper; below the diffraction limit of a 4 mm pupil
        depthOfField,  ///< 20 um: half the depth of field of the eye (about 0.3 D at 4 mm)
        landolt,       ///< blur that hides a 1 arcmin Landolt gap: 25.6 um (Smith 1991, 0.65 arcmin per mm and D)
        typed,         ///< `diameter` as typed
    };
    Preset preset = Preset::landolt;
    Metre diameter;  ///< used by `typed` only
    bool operator==(const CircleOfConfusion&) const = default;
};

/// Where one lens axis (the optical centre, parallel to the view) passes, from the camera's own axis, in metres.
struct LensAxis {
    Metre right;
    Metre down;
    bool operator==(const LensAxis&) const = default;
};

enum class Eye { left, right };

/// A camera behind one lens instead of a person (the paper's captures): a thin lens of fixed focus.
struct CameraObserver {
    Metre focalLength = 24.0_mm;
    double fNumber = 1.4;
    Metre focusDistance = 0.5_m;  ///< from the wearer's lens, in focus at 0 D
    Metre pixelPitch = 8.4_um;    ///< its circle of confusion is two pixels
    bool operator==(const CameraObserver&) const = default;
};

/// A wearer is a file of its own: one person is the same for every project.
struct Wearer {
    std::string name = "Default wearer";
    Metre pupil = 4.0_mm;         ///< D_e, entrance pupil diameter
    Metre lensToPupil = 20.0_mm;  ///< d_Ee, lens to entrance pupil (vertex distance + half a lens + 3 mm)
    Dioptre eyePower = 60.0_D;    ///< reduced eye; the retina lies at d_er = 1 / eyePower
    Dioptre ametropia;            ///< prescription at the eye plane, 0 D for an emmetrope, negative for a myope
    double ageYears = 28.0;       ///< gives the amplitude of accommodation (Hofstetter's mean) unless it was measured
    std::optional<Dioptre> measuredAccommodation;
    CircleOfConfusion confusion;
    Metre lensAperture = 16.0_mm;  ///< clear diameter of the tunable lens: nothing seen outside it is blurred
    std::array<LensAxis, 2> axes{LensAxis{-31.5_mm, 0.0_m}, LensAxis{31.5_mm, 0.0_m}};  ///< left, right
    std::optional<CameraObserver> camera;  ///< set: the observer is a camera, not an eye
    bool operator==(const Wearer&) const = default;

    const LensAxis& axis(Eye eye) const { return axes[eye == Eye::left ? 0 : 1]; }
    Metre eyeSpacing() const { return axes[1].right - axes[0].right; }
};

}  // namespace ilf
