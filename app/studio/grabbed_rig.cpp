#include "app/studio/grabbed_rig.h"

#include <utility>

#include "core/registration/convert.h"

namespace ilf::app {

Result<Rig> rigForGrabbed(const Rig& rig, CameraMode now, Size picture) {
    if (!rig.registration) return rig;
    now.picture = picture;  // what a camera says of itself may be older than its newest picture
    auto converted = convertedTo(*rig.registration, now);
    if (!converted) return tl::unexpected(converted.error());
    if (*converted == *rig.registration) return rig;
    Rig fitting = rig;
    fitting.registration = Box(*std::move(converted));
    return fitting;
}

}  // namespace ilf::app
