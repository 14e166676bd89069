#include "app/output_core/priority.h"

#include <sys/resource.h>

namespace ilf::app {

void comeFirst() {
    constexpr int kNice = -10;
    setpriority(PRIO_PROCESS, 0, kNice);
}

}  // namespace ilf::app
