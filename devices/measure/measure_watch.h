// Who watches a measurement while it goes on: what is heard, and each wave as it is recorded.
#pragma once

#include <functional>
#include <string>

#include "core/lens/record.h"
#include "devices/usb1208/analog_input.h"

namespace ilf::devices {

/// Called on the measuring thread, so what they do must be quick; empty ones: nobody watches.
struct MeasureWatch {
    /// AI0 (`trigger`) and AI1 (`second`, the photodiode), at this many samples a second of each.
    std::function<void(const HeardBlock& heard, double samplesPerSecond)> heard;
    std::function<void(const LensRecord& wave)> recorded;
};

}  // namespace ilf::devices
