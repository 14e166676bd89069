#include "core/registration/registration.h"

namespace ilf {

Box<Registration> registered(const Homography<ProjectorFrame, CameraFrame>& projectorFromCamera) {
    Registration registration;
    registration.map = PixelMap(projectorFromCamera);
    registration.provenance = "typed";
    return Box<Registration>(std::move(registration));
}

}  // namespace ilf
