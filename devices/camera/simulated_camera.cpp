#include "devices/camera/simulated_camera.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numbers>
#include <thread>
#include <utility>
#include <vector>

namespace ilf::devices {
namespace {

constexpr Size kSize{640, 480};
constexpr Second kPeriod = Second::fromSi(1.0 / 30.0);

/// Even noise of 0..3 codes (SplitMix64's mixing step).
int noise(std::uint64_t seed) {
    seed += 0x9E3779B97F4A7C15U;
    seed = (seed ^ (seed >> 30)) * 0xBF58476D1CE4E5B9U;
    return static_cast<int>((seed ^ (seed >> 27)) >> 62);
}

}  // namespace

Image<std::uint8_t> simulatedScene(Second time, std::uint64_t number, bool locked) {
    const double turn = 2.0 * std::numbers::pi * time.si();
    const double x = 0.5 * kSize.width + 200.0 * std::sin(turn / 8.0);
    const double y = 0.5 * kSize.height + 120.0 * std::sin(turn / 5.0);
    const double gain = locked ? 1.0 : 1.0 + 0.1 * std::sin(turn / 20.0);
    std::vector<std::uint8_t> pixels;
    pixels.reserve(3U * static_cast<std::size_t>(kSize.width) * static_cast<std::size_t>(kSize.height));
    const auto code = [&](double value, int grain) {
        return static_cast<std::uint8_t>(std::clamp(static_cast<int>(gain * value) + grain, 0, 255));
    };
    for (int j = 0; j < kSize.height; ++j) {
        for (int i = 0; i < kSize.width; ++i) {
            const auto place = static_cast<std::uint64_t>(j * kSize.width + i);
            const int grain = noise(number * 0x100000001U + place);
            // Softened over one pixel, like anything a lens images.
            const double disc = std::clamp(60.5 - std::hypot(i + 0.5 - x, j + 0.5 - y), 0.0, 1.0);
            const bool tick = i % 80 == 0 || j % 80 == 0;
            const double ground = tick ? 140.0 : 60.0 + 60.0 * i / kSize.width;
            pixels.push_back(code(ground + disc * (225.0 - ground), grain));
            pixels.push_back(code(ground + disc * (170.0 - ground), grain));
            pixels.push_back(code(60.0 + 60.0 * j / kSize.height, grain));
        }
    }
    return Image<std::uint8_t>(kSize, 3, std::move(pixels));
}

Result<std::optional<Frame>> SimulatedCamera::read() {
    Second now = steadyNow();
    if (number_ == 0) due_ = now;
    if (now < due_) {
        std::this_thread::sleep_for(std::chrono::duration<double>((due_ - now).si()));
        now = steadyNow();
    }
    // A reader that was late does not get the frames it missed.
    due_ = std::max(due_, now - kPeriod) + kPeriod;
    ++number_;
    const Second shown = static_cast<double>(number_) * kPeriod;
    return Frame{simulatedScene(shown, number_, locked_), now, number_, 0.0};
}

Result<void> SimulatedCamera::lockExposure(bool locked) {
    locked_ = locked;
    return {};
}

}  // namespace ilf::devices
