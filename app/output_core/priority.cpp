#include "app/output_core/priority.h"

#include <sched.h>
#include <sys/mman.h>
#include <sys/resource.h>

namespace ilf::app {
namespace {

/// As the doctor recommends to allow: below the kernel's own threads (50).
constexpr int kPriority = 20;

bool inRealTime() {
    const sched_param wanted{kPriority};
    return sched_setscheduler(0, SCHED_RR | SCHED_RESET_ON_FORK, &wanted) == 0;
}

/// Only without a limit: with one, memory asked for later would be refused instead of merely not locked.
bool lockedMemory() {
    rlimit limit{};
    if (getrlimit(RLIMIT_MEMLOCK, &limit) != 0 || limit.rlim_cur != RLIM_INFINITY) return false;
    return mlockall(MCL_CURRENT | MCL_FUTURE | MCL_ONFAULT) == 0;
}

}  // namespace

void comeFirst() {
    constexpr int kNice = -10;
    setpriority(PRIO_PROCESS, 0, kNice);
}

std::vector<std::string> keepTime() {
    std::vector<std::string> limits;
    if (!inRealTime())
        limits.emplace_back("Real-time priority is not allowed, so that a busy machine may make the lenses late: allow "
                            "rtprio 20 to this user (illuminatedfocus doctor says how), then start the core again.");
    if (!lockedMemory())
        limits.emplace_back("Locked memory is not allowed without a limit, so that swapping may make the lenses late: "
                            "allow memlock unlimited to this user (illuminatedfocus doctor says how), then start the "
                            "core again.");
    return limits;
}

}  // namespace ilf::app
