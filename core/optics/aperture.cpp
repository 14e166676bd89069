#include "core/optics/aperture.h"

#include <algorithm>

namespace ilf {
namespace {

/// D_ETL N / w, with N / w = 1 - e V for V = P - 1/w, so that infinity needs no case of its own.
Metre rimAtPupil(const EyeOptics& eye, Metre lensAperture, Metre distance, Dioptre lens) {
    return lensAperture * (1.0 - eye.lensToPupil * (lens - 1.0 / distance));
}

}  // namespace

Metre effectivePupil(const EyeOptics& eye, Metre lensAperture, Metre distance, Dioptre lens) {
    return std::min(eye.pupil, rimAtPupil(eye, lensAperture, distance, lens));
}

bool lensIsStop(const EyeOptics& eye, Metre lensAperture, Metre distance, Dioptre lens) {
    return rimAtPupil(eye, lensAperture, distance, lens) < eye.pupil;
}

Metre blurDiameterStopped(const EyeOptics& eye, Metre lensAperture, Metre distance, Dioptre lens) {
    return effectivePupil(eye, lensAperture, distance, lens) * (eye.retina * abs(defocus(eye, distance, lens)));
}

}  // namespace ilf
