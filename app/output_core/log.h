// The log of one of the output core's processes: a rotating text file in the state directory.
#pragma once

#include <string>

namespace ilf::app {

/// Sends spdlog's default logger to `ROLE.log` (ten files of 5 MB at most); to standard error if that cannot be
/// written. Call it once, first.
void startLog(const std::string& role);

}  // namespace ilf::app
