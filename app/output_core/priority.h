// The output core goes before whatever else the machine does: light must not wait for a compile.
#pragma once

namespace ilf::app {

/// Asks for a higher priority for this thread and those it starts. Needs a right that not every user has (CAP_SYS_NICE
/// or RLIMIT_NICE); without it nothing changes.
void comeFirst();

}  // namespace ilf::app
