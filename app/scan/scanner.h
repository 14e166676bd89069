// A scan, or a part of one, on a thread of its own, for a window: start, how far it is, cancel, result.
#pragma once

#include <functional>
#include <stop_token>
#include <thread>
#include <variant>

#include "app/scan/board_scan.h"
#include "app/scan/light_check.h"
#include "app/scan/pose_scan.h"
#include "app/scan/scan.h"
#include "core/base/latest.h"

namespace ilf::app {

/// What a piece of work found.
using ScanWorkDone = std::variant<ScanOutcome, LightCheck, PairedRegistration, PosesOutcome>;
using ScanWork = std::function<Result<ScanWorkDone>(const devices::ScanWatch&, const std::stop_token&)>;

/// All functions are for the thread that made it and never wait; its end cancels and waits (a frame or two, and for
/// safe light). While it lives: close the camera's port first, and send nothing to the core.
class Scanner {
public:
    /// `onNews` is called from the scan's thread whenever progress or result wait.
    Scanner(ScanWork work, std::function<void()> onNews);
    Scanner(const Scanner&) = delete;
    Scanner& operator=(const Scanner&) = delete;

    void cancel() { thread_.request_stop(); }
    /// The newest, once. Older ones are dropped; `result` never is.
    std::optional<devices::ScanProgress> progress() { return progress_.tryTake(); }
    /// Once, at the end; after a cancel an error that says so.
    std::optional<Result<ScanWorkDone>> result() { return result_.tryTake(); }

private:
    Latest<devices::ScanProgress> progress_;
    Latest<Result<ScanWorkDone>> result_;
    std::jthread thread_;  // last: joins before what it uses goes
};

}  // namespace ilf::app
