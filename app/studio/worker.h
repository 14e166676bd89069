// The worker: plans and compiles the newest document on a thread of its own, then has the viewer look at the program.
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <thread>

#include "app/lens/lens_planner.h"
#include "app/studio/following_compiler.h"
#include "app/studio/viewer.h"
#include "core/base/latest.h"
#include "core/compile/compile.h"

namespace ilf::app {

using Clock = std::chrono::steady_clock;

/// What to work out, newest wins. Equal parts are not worked out again.
struct Job {
    std::uint64_t serial = 0;  ///< Editor::serial of the document
    Document document;
    std::vector<RegionMove> moves{};        ///< of regions that follow something: the program is of where they are
    std::optional<std::int64_t> seen_ns{};  ///< when what made new moves was seen; see Latency
    /// What is on show, where that is not `document`: it must move along all the same.
    std::optional<Document> onShow{};
    bool dragging = false;                     ///< a gesture is going on: the view may be coarse
    std::array<bool, 2> eyes{};                ///< perceived views that are on screen, left and right
    bool plain = false;                        ///< the plain view is on screen
    ViewRequest seeing;                        ///< see ViewJob
    std::optional<Point<CameraFrame>> cursor;  ///< for the seam profile
    Clock::time_point strokeAt;                ///< when the operator made the edit
};

/// The program, on its way to light. What is seen of it follows by itself: light must not wait for a view.
struct Done {
    std::uint64_t serial = 0;
    Clock::time_point strokeAt;
    std::optional<Error> refusal;              ///< no plan or no program, and why
    std::shared_ptr<const Compiled> compiled;  ///< of this serial, unless refused
    std::uint64_t hash = 0;                    ///< content of its program
    double plan_ms = 0.0, compile_ms = 0.0;
    std::optional<std::int64_t> seen_ns{};     ///< of the job
    Document painted{};                        ///< the job's
    std::shared_ptr<const Compiled> onShow{};  ///< of the job's, where it has one and that can be compiled
    std::uint64_t onShowHash = 0;
};

class Worker {
public:
    /// `lens` is the simulated one that plans are made for where the rig names no calibration. `onNews` is called on
    /// other threads whenever there is something new to take (to wake the window).
    explicit Worker(devices::SimulatedLens lens, std::function<void()> onNews = {});

    void post(Job job) { jobs_.put(std::move(job)); }
    std::optional<Done> tryTake() { return done_.tryTake(); }
    std::optional<Seen> tryTakeSeen() { return viewer_.tryTake(); }

private:
    void run(std::stop_token stop);
    Done program(const Job& job);
    void follow(const Job& job, Done& done);

    Latest<Job> jobs_;
    Latest<Done> done_;
    std::function<void()> onNews_;

    // Owned by the worker's thread alone.
    LensPlanner planner_;
    FollowingCompiler compiler_;
    std::shared_ptr<const Compiled> last_;
    FollowingCompiler showCompiler_;
    std::shared_ptr<const Compiled> lastShow_;
    std::shared_ptr<const Compiled> hashed_;
    std::uint64_t hash_ = 0;  ///< of hashed_

    Viewer viewer_;
    std::jthread thread_;  // last: joins before what it uses goes
};

}  // namespace ilf::app
