// The wire from the emulated projector's TRIG_OUT_2 to an analog input of the emulated converter.
#pragma once

#include <cstdint>
#include <deque>

#include "devices/emulators/daq.h"
#include "devices/emulators/light_crafter.h"

namespace ilf::devices::emulators {

/// Volts at the end of the wire: 0 or `high_V`. Asked for times that go forward. The wire takes the projector's edges
/// (`takeTriggers`), so nobody else should.
class TriggerWire {
public:
    explicit TriggerWire(EmulatedLightCrafter& projector, double high_V = 3.3)
        : projector_(&projector), high_V_(high_V) {}

    double volts(std::int64_t time_ns) {
        for (const TriggerEdge& edge : projector_->takeTriggers(time_ns))
            high_ = edge.high;
        return high_ ? high_V_ : 0.0;
    }

private:
    EmulatedLightCrafter* projector_;
    double high_V_;
    bool high_ = false;
};

/// Joins `wire` to one input of the converter, all others to `others` (0 V where empty); both must outlive it. Both
/// devices' calls must come from one thread, or under one lock (UsbHost's).
inline void connect(EmulatedDaq& daq, int channel, TriggerWire& wire, const EmulatedLightCrafter& projector,
                    EmulatedDaq::AnalogInput others = {}) {
    daq.setInput(
        [channel, &wire, others = std::move(others)](int asked, std::int64_t time_ns) {
            if (asked == channel) return wire.volts(time_ns);
            return others ? others(asked, time_ns) : 0.0;
        },
        [&projector](std::int64_t now_ns) { return projector.knownUntil(now_ns); });
}

}  // namespace ilf::devices::emulators
