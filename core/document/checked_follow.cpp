// What a region may follow.
#include <algorithm>
#include <variant>

#include "core/document/edit.h"
#include "core/document/edit_parts.h"

namespace ilf {

namespace {

Result<void> checkedTarget(const MarkerTarget& marker, Size) {
    if (marker.dictionary.empty()) {
        return fail(Fault::outOfRange, "A marker needs the name of its dictionary, such as APRILTAG_36h11.");
    }
    return inRange("the number of a marker", marker.id, 0, 100'000, "");
}

Result<void> checkedTarget(const PlanarTarget& target, Size picture) {
    constexpr int kSmallest = 16;
    const auto& patch = target.patch;
    const bool inside = patch.x0 >= 0 && patch.y0 >= 0 && patch.x1 <= picture.width && patch.y1 <= picture.height;
    if (inside && patch.width() >= kSmallest && patch.height() >= kSmallest) return {};
    return fail(Fault::outOfRange, "What a region follows must be a part of the picture of at least 16 x 16 pixels: "
                                   "draw it again.");
}

Result<void> checkedTarget(const StreamTarget& target, Size) {
    const bool plain = std::ranges::all_of(target.address, [](char c) { return c > ' ' && c < 0x7f; });
    if (target.address.size() > 1 && target.address.front() == '/' && plain) return {};
    return fail(Fault::outOfRange, "The address of a pose stream starts with / and has no spaces, as in /pose/1.");
}

}  // namespace

Result<void> checked(const Follow& follow, Size picture) {
    const auto target = [&](const auto& what) { return checkedTarget(what, picture); };
    if (auto ok = std::visit(target, follow.target); !ok) return ok;
    if (auto ok = inRange("the time it stays when lost", follow.hold.si(), 0.0, 60.0, "s"); !ok) return ok;
    return inRange("the time it fades when lost", follow.fade.si(), 0.0, 60.0, "s");
}

}  // namespace ilf
