#include "app/headless/measure_command.h"

#include <cmath>
#include <cstdio>
#include <iostream>
#include <nlohmann/json.hpp>

#include "app/exit_code.h"
#include "app/headless/prepare.h"
#include "devices/measure/edge_delay.h"

namespace ilf::app {
namespace {

using nlohmann::ordered_json;

std::string text(const char* format, double value) {
    char line[64];
    std::snprintf(line, sizeof line, format, value);
    return line;
}
std::string ms(Second time) { return text("%.3f ms", 1e3 * time.si()); }

ordered_json asJson(const devices::Spread& spread) {
    return {{"median_s", spread.median.si()},
            {"deviation_s", spread.deviation.si()},
            {"p05_s", spread.low.si()},
            {"p95_s", spread.high.si()}};
}

void print(const devices::EdgeDelays& delays, bool json) {
    if (json) {
        ordered_json out{{"delay", asJson(delays.delay)},
                         {"mean_s", delays.mean.si()},
                         {"trigger_interval_s", delays.triggerInterval.si()},
                         {"triggers", delays.triggers},
                         {"missing", delays.missing},
                         {"extra", delays.extra},
                         {"contrast", delays.contrast},
                         {"confidence", word(delays.confidence)},
                         {"delays_s", delays.delay_s}};
        if (delays.fallingLater) out["falling_later_s"] = delays.fallingLater->si();
        std::cout << out.dump(2) << '\n';
        return;
    }
    std::cout << "Light comes " << ms(delays.mean) << " after its trigger (every " << ms(delays.triggerInterval)
              << "), +-" << ms(delays.delay.deviation) << "; 9 of 10 within " << ms(delays.delay.low) << " to "
              << ms(delays.delay.high) << ".\n"
              << delays.triggers << " triggers, " << delays.missing << " without light, " << delays.extra
              << " edges too many; confidence " << word(delays.confidence) << ".\n";
    if (delays.fallingLater) std::cout << "Light goes " << ms(*delays.fallingLater) << " later than it comes.\n";
}

void print(const devices::EdgePace& pace, bool json) {
    if (json) {
        ordered_json out{{"interval_s", pace.interval.si()},
                         {"late", asJson(pace.late)},
                         {"falling_later_s", pace.fallingLater.si()},
                         {"edges", pace.edges.size()},
                         {"held", pace.held},
                         {"extra", pace.extra},
                         {"contrast", pace.contrast},
                         {"confidence", word(pace.confidence)}};
        std::cout << out.dump(2) << '\n';
        return;
    }
    std::cout << pace.edges.size() << " edges, a frame each " << ms(pace.interval) << "; +-" << ms(pace.late.deviation)
              << ", 9 of 10 within " << ms(pace.late.low) << " to " << ms(pace.late.high) << "; " << pace.held.size()
              << " frames shown twice or longer, " << pace.extra << " edges too many; confidence "
              << word(pace.confidence) << ".\nThe recording has no trigger, so it does not tell a delay.\n";
}

}  // namespace

int measureDelayCommand(const MeasureDelayOptions& options) {
    const auto recording = devices::readRecording(options.recording);
    if (!recording) return refused("measure delay", recording.error());
    const Second shortest = Second::fromSi(1e-3 * options.shortest_ms);
    if (!recording->trigger.empty()) {
        const auto delays = devices::delaysIn(*recording, shortest);
        if (!delays) return refused("measure delay", delays.error());
        print(*delays, options.json);
        return kDone;
    }
    std::optional<Second> frame;
    if (options.frames_Hz > 0.0) frame = Second::fromSi(1.0 / options.frames_Hz);
    const auto pace = devices::paceIn(*recording, frame, shortest);
    if (!pace) return refused("measure delay", pace.error());
    print(*pace, options.json);
    return kDone;
}

}  // namespace ilf::app
