#include "core/perceived/setting.h"

#include <algorithm>

namespace ilf::view {

Result<Setting> setting(const Document& document, const Plan& plan, const Program& program,
                        const ViewRequest& request) {
    if (!document.scene.picture)
        return fail(Fault::notFound, "There is no picture to look at. Open one, or grab a frame.");
    if (!(request.scale > 0.0 && request.scale <= 1.0)) {
        return fail(Fault::outOfRange, "A view's scale must be more than 0 and at most 1.");
    }
    if (const auto good = checked(program); !good) return tl::unexpected(good.error());
    if (program.imageOfSlot.size() != plan.slots.size() || program.images.size() < plan.levels.size()) {
        return fail(Fault::outOfRange,
                    "The program and the plan have different numbers of slots or levels. Compile again.");
    }
    const auto eye = attention(plan, request);
    if (!eye) return tl::unexpected(eye.error());
    if (request.gaze == Gaze::fixed && !plan.input.camera) {
        const Size size = document.scene.size();
        const Point<CameraFrame> at = request.gazeAt;
        if (!(at.x >= 0.0 && at.y >= 0.0 && at.x < size.width && at.y < size.height))
            return fail(Fault::outOfRange, "The eye cannot be turned to a point outside the picture.");
    }
    const bool blurs = plan.sweeps() || request.attending || plan.input.camera ||
                       std::ranges::any_of(plan.regions, [](const RegionPlan& region) {
                           return region.look == Look::blur && region.alreadyBlurred;
                       });
    return Setting{viewScale(document, request.scale), *eye, !blurs};
}

}  // namespace ilf::view
