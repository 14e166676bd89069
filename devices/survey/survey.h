// What is attached to this machine: every known device, where it is, whether it can be used, and what to do if not.
#pragma once

#include <vector>

#include "core/base/result.h"
#include "devices/clock.h"
#include "devices/survey/attached.h"
#include "devices/survey/system_files.h"

namespace ilf::devices {

/// How closely devices are looked at. Asking a projector disturbs patterns that run, for a moment.
enum class Ask {
    nothing,      ///< devices are not opened
    whenNoCore,   ///< only while no output core of ours runs
    evenWithCore  ///< those that the core does not hold, too
};

struct SurveyOptions {
    Ask ask = Ask::whenNoCore;
    std::vector<int> core;  ///< processes of the output core; empty: none runs
    SystemPlaces places;
    Clock clock = Clock::steady();
};

/// In the order projectors, converters, lens drivers, cameras. Reads only: settings, mode and light stay as they are.
/// A device that another program holds is never opened, and one that goes away in the middle is `gone`, not an error.
/// Errors: USB cannot be used at all.
Result<std::vector<Attached>> survey(const SurveyOptions& options);

}  // namespace ilf::devices
