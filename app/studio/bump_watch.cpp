#include "app/studio/bump_watch.h"

#include <exception>

#include "core/base/grey.h"

namespace ilf::app {

BumpWatch::BumpWatch(std::function<void()> onNews)
    : onNews_(std::move(onNews)), thread_([this](const std::stop_token& stop) { run(stop); }) {}

void BumpWatch::run(const std::stop_token& stop) {
    Box<Picture> shown;
    std::optional<BumpAlarm> alarm;  // none: the picture has too few features
    while (const auto pair = pairs_.take(stop)) {
        try {
            if (!pair->reference.same(shown)) {
                shown = pair->reference;
                auto made = BumpAlarm::of(greyOf(*shown));
                alarm = made ? std::optional(*std::move(made)) : std::nullopt;
            }
            if (!alarm) continue;
            const auto report = alarm->compared(greyOf(pair->frame));
            if (!report) continue;
            reports_.put(*report);
        } catch (const std::exception&) {  // OpenCV's: no report is no alarm, and the next second looks again
            continue;
        }
        if (onNews_) onNews_();
    }
}

}  // namespace ilf::app
