#include "devices/simulated/emulated_lens.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace ilf::devices {
namespace {

constexpr std::string_view kIdeal = "ideal";
constexpr Dioptre kUnknown = 1.0_D;
// After a longer gap (a process that was stopped) the lens is not played through it; then it is watched afresh.
constexpr std::int64_t kLongestGapNs = 1'000'000'000;
constexpr double kRoom_C = 30.0;  // where the presets' table is at home

std::string text(const char* format, double value) {
    std::string out(32, '\0');
    out.resize(static_cast<std::size_t>(std::snprintf(out.data(), out.size(), format, value)));
    return out;
}

/// Of what is watched; a still wave's rate may be anything.
double watchedRate(const Waveform& wave) { return std::clamp(wave.rate.si(), 1.0, 1000.0); }

}  // namespace

std::string_view word(SimulatedLens lens) { return lens.preset ? word(*lens.preset) : kIdeal; }

std::optional<SimulatedLens> simulatedLensFromWord(std::string_view word) {
    if (word == kIdeal) return SimulatedLens();
    if (const auto preset = lensPresetFromWord(word)) return SimulatedLens(*preset);
    return std::nullopt;
}

std::vector<std::string> coreArguments(SimulatedLens lens) { return {"--simulated-lens", std::string(word(lens))}; }

EmulatedLens::EmulatedLens(LensPreset preset, std::int64_t now_ns)
    : preset_(preset), lens_(lensParameters(preset), kRoom_C), startedNs_(now_ns), nowNs_(now_ns) {
    lens_.hold({});
    lens_.warmUp();
    lens_.advance(0.5_s);
    wave_ = stillWave({}, {}, 60.0_Hz);
}

Result<void> EmulatedLens::playable(const Waveform& wave) const {
    const std::string lens = "The simulated lens (" + std::string(word(preset_)) + ")";
    if (wave.drive.c.empty()) {
        if (wave.still()) return {};
        return fail(Fault::device, lens + " cannot sweep " + text("%.2f", wave.low.si()) + " to " +
                                       text("%.2f D", wave.high.si()) +
                                       ": the program holds no drive for it; calibrate the lens and plan again.");
    }
    if (wave.unit != DriveUnit::volt) {
        return fail(Fault::device, lens + " is driven in volts and the program's drive is in amperes; calibrate this "
                                          "lens and plan again.");
    }
    return devices::playable(wave.drive, wave.rate, lens_.limits());
}

void EmulatedLens::play(const Waveform& wave, std::int64_t now_ns) {
    advance(now_ns);
    if (wave.drive.c.empty())
        lens_.hold(wave.low);
    else
        lens_.play(wave.drive, wave.rate, wave.temperature_C + wave.warming_C);
    wave_ = wave;
    startedNs_ = now_ns;
    ahead_s_ = 0.0;
    nextWatch_ = watchedFrom_ = 1;
}

std::int64_t EmulatedLens::watchNs(std::int64_t index) const {
    const double t = static_cast<double>(index) / (watchedRate(wave_) * kWatched);
    return startedNs_ + static_cast<std::int64_t>(std::llround(1e9 * t));
}

void EmulatedLens::pass(std::int64_t until_ns) {
    const double time = static_cast<double>(until_ns - nowNs_) * 1e-9;
    if (time <= 0.0) return;
    lens_.advance(Second::fromSi(time * (1.0 + drift_)));
    ahead_s_ += time * drift_;
    nowNs_ = until_ns;
}

void EmulatedLens::advance(std::int64_t now_ns) {
    if (now_ns - nowNs_ > kLongestGapNs) {
        const double threeSweeps_ns = 3e9 / watchedRate(wave_);
        const std::int64_t from = now_ns - static_cast<std::int64_t>(threeSweeps_ns);
        pass(from);
        const double sweeps = static_cast<double>(nowNs_ - startedNs_) * 1e-9 * watchedRate(wave_);
        watchedFrom_ = static_cast<std::int64_t>(std::ceil(sweeps * kWatched)) + 1;
        nextWatch_ = std::max(nextWatch_, watchedFrom_);
    }
    while (watchNs(nextWatch_) <= now_ns) {
        pass(watchNs(nextWatch_));
        watch();
    }
    pass(now_ns);
}

void EmulatedLens::watch() {
    const std::size_t i = static_cast<std::size_t>(nextWatch_) % kWatched;
    const double power = lens_.power().si();
    change_[i] = std::abs(power - power_[i]);
    power_[i] = power;
    error_[i] = power - wave_.power.at(static_cast<double>(i) / kWatched);
    ++nextWatch_;
}

Dioptre EmulatedLens::unsettled() const {
    if (nextWatch_ - watchedFrom_ < 2 * static_cast<std::int64_t>(kWatched)) return kUnknown;
    return Dioptre::fromSi(*std::ranges::max_element(change_));
}

Dioptre EmulatedLens::offWave() const {
    if (nextWatch_ - watchedFrom_ < 2 * static_cast<std::int64_t>(kWatched)) return {};
    double sum = 0.0;
    for (const double error : error_)
        sum += error * error;
    return Dioptre::fromSi(std::sqrt(sum / kWatched));
}

void EmulatedLens::setAmbient(double ambient_C) {
    lens_.setAmbient(ambient_C);
    lens_.warmUp();
}

}  // namespace ilf::devices
