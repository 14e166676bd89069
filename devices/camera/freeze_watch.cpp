#include "devices/camera/freeze_watch.h"

#include <chrono>

namespace ilf::devices {

void FreezeWatch::arrived(const Frame& frame) {
    if (!last_ || !(last_->rgb == frame.rgb)) changed_ = frame.time;
    last_ = frame;
}

Second steadyNow() {
    return Second::fromSi(std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count());
}

}  // namespace ilf::devices
