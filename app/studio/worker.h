// The worker: plans, compiles and previews the newest document on a thread of its own.
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <thread>

#include "app/lens/lens_planner.h"
#include "core/base/latest.h"
#include "core/compile/compile.h"
#include "core/perceived/perceived.h"
#include "core/perceived/seam_profile.h"
#include "core/plan/report.h"

namespace ilf::app {

using Clock = std::chrono::steady_clock;

/// What to work out, newest wins. Equal parts are not worked out again.
struct Job {
    std::uint64_t serial = 0;  ///< Editor::serial of the document
    Document document;
    bool dragging = false;                     ///< a gesture is going on: the view may be coarse
    std::array<bool, 2> eyes{};                ///< perceived views that are on screen, left and right
    bool plain = false;                        ///< the plain view is on screen
    std::optional<Point<CameraFrame>> cursor;  ///< for the seam profile
    Clock::time_point strokeAt;                ///< when the operator made the edit
};

/// An sRGB picture ready to be uploaded, 3 channels.
using ViewPicture = Image<std::uint8_t>;

/// What was worked out. Sent in steps: first the program (light must not wait for a preview), then the views.
struct Done {
    std::uint64_t serial = 0;
    Clock::time_point strokeAt;
    std::optional<Error> refusal;              ///< no plan or no program, and why
    std::shared_ptr<const Compiled> compiled;  ///< of this serial, unless refused
    std::array<ViewPicture, 2> perceived;      ///< empty: not asked for, or still to come
    ViewPicture plain;
    std::optional<SeamProfile> seam;
    std::shared_ptr<const PlanReport> report;  ///< with the views; before that the one of the plan before
    double plan_ms = 0.0, compile_ms = 0.0, view_ms = 0.0;
    std::string rung;  ///< quality of the views: "dragging", "at rest"
    bool viewsDone = false;
};

/// Views are computed at most this wide while a gesture goes on, and at rest. The perceived-view issue makes the engine
/// fast enough to drop the difference.
inline constexpr int kDraggingWidth = 320;
inline constexpr int kRestWidth = 1024;

class Worker {
public:
    /// `lens` is the simulated one that plans are made for where the rig names no calibration. `onDone` is called on
    /// the worker's thread whenever `done` has something new (to wake the window).
    explicit Worker(devices::SimulatedLens lens, std::function<void()> onDone = {});

    void post(Job job) { jobs_.put(std::move(job)); }
    std::optional<Done> tryTake() { return done_.tryTake(); }

private:
    void run(std::stop_token stop);
    void work(Job job);

    Latest<Job> jobs_;
    Latest<Done> done_;
    std::function<void()> onDone_;

    // Owned by the worker's thread alone.
    LensPlanner planner_;
    std::shared_ptr<const Compiled> last_;
    std::optional<Job> lastViewed_;
    Done lastDone_;
    std::shared_ptr<const PlanReport> report_;
    std::optional<Plan> reported_;  ///< the plan of report_

    std::jthread thread_;  // last: joins before what it uses goes
};

}  // namespace ilf::app
