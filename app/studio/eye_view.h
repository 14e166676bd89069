// What one eye sees of a program, by two engines: one for the frames of gestures, one for when the hand is still.
#pragma once

#include <functional>
#include <memory>
#include <optional>

#include "app/studio/screen_view.h"
#include "core/compile/compile.h"
#include "core/perceived/view_engine.h"

namespace ilf::app {

/// What can be asked of this program: `seeing` through `eye`, less what is gone. What it attends may have been deleted
/// or hidden and a rig may have forgotten its primaries; the view goes on without.
ViewRequest askedOf(const Compiled& compiled, const ViewRequest& seeing, Eye eye);

/// An engine that is asked for another rung works everything out anew. With two of them the first frame of a gesture
/// costs only the tiles that were edited since the last one, and so does every other. The price is memory: at 1920x1080
/// an engine with four blurred or focused objects holds about 100 MB, and its view as codes 8 MB (resident, measured at
/// as many pixels); more with every surface and every power of the lens.
class EyeView {
public:
    using Cancelled = std::function<bool()>;

    /// Sees `request` and shows it, whole: never tiles of two rungs. False: cancelled, what was shown stays.
    Result<bool> look(const Compiled& compiled, const ViewRequest& request, const Cancelled& cancelled);
    /// Works out ahead what a gesture's next frame of `request` will need, and shows nothing of it. A part of it that
    /// was done before it was cancelled is not done again.
    void prepareGesture(const Compiled& compiled, ViewRequest request, const Cancelled& cancelled);

    /// What was shown is no longer of what is being looked at.
    void sceneChanged() { reached_.reset(); }
    std::optional<Rung> reached() const { return reached_; }  ///< of the scene being looked at
    const std::shared_ptr<const ScreenView>& shown() const { return shown_; }
    const ViewCounters& counters() const { return counters_; }
    double took_ms() const { return took_ms_; }

private:
    struct Sight {
        ViewEngine engine;
        PerceivedView seen;
        ScreenView codes;  ///< of `seen`
    };
    Result<bool> see(Sight& sight, const Compiled& compiled, const ViewRequest& request, const Cancelled& cancelled);

    Sight gesture_, still_;
    std::shared_ptr<const ScreenView> shown_;
    std::optional<Rung> reached_;
    ViewCounters counters_;
    double took_ms_ = 0.0;
};

}  // namespace ilf::app
