// Keeps the white guard running below the player's window.
#pragma once

#include <chrono>

#include "app/output_core/start_role.h"

namespace ilf::app {

/// Only rigs whose light comes through a display have one.
class GuardKeeper {
public:
    explicit GuardKeeper(const CoreSetup& setup) : setup_(setup) {}

    /// Starts it where none runs; one that keeps white on another rig's display is replaced. `environment`: see
    /// DevicesKeeper.
    void watch(const Environment& environment);
    /// Gives the display back.
    void stop() const { stopGuard(setup_.runtimeDirectory); }
    static void stopGuard(const std::filesystem::path& runtimeDirectory);

private:
    const CoreSetup& setup_;
    std::chrono::steady_clock::time_point next_;
    std::string keeps_;  ///< what the running guard was found to be started for
};

}  // namespace ilf::app
