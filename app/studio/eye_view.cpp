#include "app/studio/eye_view.h"

#include <algorithm>
#include <chrono>

#include "core/base/elapsed.h"

namespace ilf::app {

ViewRequest askedOf(const Compiled& compiled, const ViewRequest& seeing, Eye eye) {
    ViewRequest request = seeing;
    const auto attended = [&](const RegionPlan& region) { return region.id == request.attending; };
    if (std::ranges::none_of(compiled.plan.regions, attended)) request.attending.reset();
    request.chromatic = request.chromatic && compiled.document.rig.primaries;
    request.eye = eye;
    return request;
}

Result<bool> EyeView::see(Sight& sight, const Compiled& compiled, const ViewRequest& request,
                          const Cancelled& cancelled) {
    auto seen = sight.engine.see(compiled.document, compiled.plan, compiled.program, request, cancelled);
    if (!seen) return tl::unexpected(seen.error());
    if (!seen->complete) return false;
    sight.codes = screenView(*seen, sight.seen, sight.codes);
    if (shown_) shareEqual(sight.codes, *shown_);
    sight.seen = *std::move(seen);
    return true;
}

Result<bool> EyeView::look(const Compiled& compiled, const ViewRequest& request, const Cancelled& cancelled) {
    const auto start = std::chrono::steady_clock::now();
    Sight& sight = request.rung == Rung::dragging ? gesture_ : still_;
    const auto done = see(sight, compiled, request, cancelled);
    if (!done || !*done) return done;
    shown_ = std::make_shared<const ScreenView>(sight.codes);
    reached_ = request.rung;
    counters_ = sight.seen.counters;
    took_ms_ = millisecondsSince(start);
    return true;
}

void EyeView::prepareGesture(const Compiled& compiled, ViewRequest request, const Cancelled& cancelled) {
    if (cancelled && cancelled()) return;  // surfaces and light are worked out before the engine asks
    request.rung = Rung::dragging;
    // A refusal is of the scene, not of the rung: the view that is shown had it already.
    static_cast<void>(see(gesture_, compiled, request, cancelled));
}

}  // namespace ilf::app
