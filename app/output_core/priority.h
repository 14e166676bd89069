// Lets the processes that keep the light go first on a busy machine.
#pragma once

#include <string>
#include <vector>

namespace ilf::app {

/// Ahead of ordinary programs, where that is allowed.
void comeFirst();

/// Real-time priority and memory that is never swapped out, for all of this process; call it before the first thread.
/// What the machine does not allow comes back, one sentence each, with what would help.
std::vector<std::string> keepTime();

}  // namespace ilf::app
