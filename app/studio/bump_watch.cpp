#include "app/studio/bump_watch.h"

#include <exception>

namespace ilf::app {
namespace {

/// 8 bits of grey, of RGB with `unit` codes for each of them.
template <class T>
Image<std::uint8_t> greyOf(const Image<T>& rgb, unsigned unit) {
    std::vector<std::uint8_t> grey;
    grey.reserve(rgb.pixels().size() / 3);
    const auto pixels = rgb.pixels();
    for (std::size_t i = 0; i + 2 < pixels.size(); i += 3) {
        const unsigned sum = 77U * pixels[i] + 150U * pixels[i + 1] + 29U * pixels[i + 2];
        grey.push_back(static_cast<std::uint8_t>((sum + 128U * unit) / (256U * unit)));
    }
    return Image<std::uint8_t>(rgb.size(), 1, std::move(grey));
}

}  // namespace

BumpWatch::BumpWatch(std::function<void()> onNews)
    : onNews_(std::move(onNews)), thread_([this](const std::stop_token& stop) { run(stop); }) {}

void BumpWatch::run(const std::stop_token& stop) {
    Box<Picture> shown;
    std::optional<BumpAlarm> alarm;  // none: the picture has too few features
    while (const auto pair = pairs_.take(stop)) {
        try {
            if (!pair->reference.same(shown)) {
                shown = pair->reference;
                auto made = BumpAlarm::of(greyOf(*shown, 257));
                alarm = made ? std::optional(*std::move(made)) : std::nullopt;
            }
            if (!alarm) continue;
            const auto report = alarm->compared(greyOf(pair->frame, 1));
            if (!report) continue;
            reports_.put(*report);
        } catch (const std::exception&) {  // OpenCV's: no report is no alarm, and the next second looks again
            continue;
        }
        if (onNews_) onNews_();
    }
}

}  // namespace ilf::app
