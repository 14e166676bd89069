// The viewer: works out what the eyes see of the newest program on a thread of its own, coarsely first, then finely.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <thread>
#include <vector>

#include "app/studio/eye_view.h"
#include "core/base/latest.h"
#include "core/compile/compile.h"
#include "core/perceived/seam_border.h"
#include "core/perceived/seam_profile.h"
#include "core/plan/report.h"

namespace ilf::app {

/// Views have the picture's own pixels up to this width; wider pictures are seen scaled down to it, and the caption of
/// the view says so. Beyond it a refined view would take seconds and its textures outgrow some graphics drivers.
inline constexpr int kViewWidth = 2048;

/// What to look at. Newest wins.
struct ViewJob {
    std::uint64_t serial = 0;  ///< Editor::serial of the document
    std::shared_ptr<const Compiled> compiled;
    bool dragging = false;                     ///< a gesture is going on: answer fast
    std::array<bool, 2> eyes{};                ///< perceived views that are on screen, left and right
    bool plain = false;                        ///< the plain view is on screen
    ViewRequest seeing;                        ///< gaze, attention, colour, rim; eye, scale and rung are the viewer's
    std::optional<Point<CameraFrame>> cursor;  ///< for the seam profile
};

/// What was seen so far, complete in itself: who misses one of these loses nothing by taking the next.
struct Seen {
    std::uint64_t serial = 0;
    std::optional<Error> refusal;
    std::array<std::shared_ptr<const ScreenView>, 2> perceived;  ///< none: not asked for
    std::array<ViewCounters, 2> counters;                        ///< of the frames that gave them
    Rung rung = Rung::dragging;                                  ///< the coarsest of the eyes
    double scale = 1.0;                                          ///< pixels of the view per picture pixel
    Image<std::uint8_t> plain;                                   ///< sRGB, 3 channels; empty: not asked for
    std::optional<SeamProfile> seam;
    std::shared_ptr<const std::vector<BorderSeam>> seams;  ///< of this program; none until it is looked at in rest
    std::shared_ptr<const PlanReport> report;
    double view_ms = 0.0;  ///< of the eyes' last frames together
    bool settled = false;  ///< nothing finer follows unless something is posted
};

/// A program never waits for a view: programs are made on another thread. While a gesture goes on every job is seen
/// through at Rung::dragging (one at a time, so the view is at most one job old); once it is still the view is seen at
/// Rung::rest, which a newer view ends early; then borders are judged and the view is seen at Rung::idle, and then the
/// next gesture is made ready; any newer job ends these early.
class Viewer {
public:
    /// `onNews` is called on the viewer's thread whenever `tryTake` has something new.
    explicit Viewer(std::function<void()> onNews = {});

    /// From one thread at a time.
    void post(ViewJob job);
    std::optional<Seen> tryTake() { return news_.tryTake(); }

private:
    struct Posted {
        ViewJob job;
        std::uint64_t scene = 0;  ///< jobs with the same number show the same
    };

    void run(std::stop_token stop);
    void work(const Posted& posted, const std::stop_token& stop);
    /// False: ended early by newer work, or refused.
    bool look(std::size_t eye, const ViewJob& job, Rung rung, const std::function<bool()>& cancelled);
    void publish();

    Latest<Posted> jobs_;
    Latest<Seen> news_;
    std::function<void()> onNews_;
    ViewJob lastPosted_;  ///< of the posting thread
    std::atomic<std::uint64_t> newestScene_{0};

    // Owned by the viewer's thread alone.
    std::array<EyeView, 2> eyes_;
    Seen seen_;
    std::uint64_t scene_ = 0;
    std::shared_ptr<const Compiled> compiled_;  ///< of the last job
    std::optional<Plan> reported_;              ///< the plan of seen_.report
    Scene plainOf_;
    std::optional<Point<CameraFrame>> cursor_;  ///< of seen_.seam

    std::jthread thread_;  // last: joins before what it uses goes
};

}  // namespace ilf::app
