#include "core/optics/gaze.h"

#include <cmath>

#include "core/optics/aperture.h"

namespace ilf {

Metre pupilShift(double radians) { return kPupilToRotationCentre * std::sin(radians); }

Metre scalingCentre(const EyeOptics& eye, Metre distance, const OffAxis& at) {
    return at.lens + (distance / eye.lensToPupil) * (at.lens - at.pupil);
}

Metre apparentPosition(const EyeOptics& eye, Metre distance, Dioptre from, Dioptre to, const OffAxis& at, Metre x) {
    const Metre centre = scalingCentre(eye, distance, at);
    return centre + magnification(eye, distance, from, to) * (x - centre);
}

Metre viewpointDistance(const EyeOptics& eye, MagnificationFrom from, Metre lensAperture, Metre distance,
                        Dioptre lens) {
    switch (from) {
    case MagnificationFrom::rotationCentre:
        return eye.lensToPupil + kPupilToRotationCentre;
    case MagnificationFrom::camera:
        return lensIsStop(eye, lensAperture, distance, lens) ? 0.0_m : eye.lensToPupil;
    case MagnificationFrom::pupil:
        break;
    }
    return eye.lensToPupil;
}

double magnificationFrom(const EyeOptics& eye, MagnificationFrom reference, Metre lensAperture, Metre distance,
                         Dioptre from, Dioptre to) {
    EyeOptics seenFrom = eye;
    seenFrom.lensToPupil = viewpointDistance(eye, reference, lensAperture, distance, to);
    return magnification(seenFrom, distance, from, to);
}

}  // namespace ilf
