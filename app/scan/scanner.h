// A scan on a thread of its own, for a window: start, how far it is, cancel, result.
#pragma once

#include <functional>
#include <thread>

#include "app/scan/scan.h"
#include "core/base/latest.h"

namespace ilf::app {

/// All functions are for the thread that made it and never wait; its end cancels and waits (a frame or two, and for
/// safe light). While it lives: close the camera's port first, and send nothing to the core.
class Scanner {
public:
    /// `onNews` is called from the scan's thread whenever progress or result wait.
    Scanner(ScanOrder order, std::function<void()> onNews);
    Scanner(const Scanner&) = delete;
    Scanner& operator=(const Scanner&) = delete;

    void cancel() { thread_.request_stop(); }
    /// The newest, once. Older ones are dropped; `result` never is.
    std::optional<devices::ScanProgress> progress() { return progress_.tryTake(); }
    /// Once, at the end; after a cancel an error that says so.
    std::optional<Result<ScanOutcome>> result() { return result_.tryTake(); }

private:
    Latest<devices::ScanProgress> progress_;
    Latest<Result<ScanOutcome>> result_;
    std::jthread thread_;  // last: joins before what it uses goes
};

}  // namespace ilf::app
