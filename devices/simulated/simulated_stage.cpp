#include "devices/simulated/simulated_stage.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <exception>

#include "devices/link/program_update.h"

namespace ilf::devices {
namespace {

// A lens that has not settled by then never will: thirty sweeps of the slowest that are played.
constexpr std::int64_t kLongestSettlingNs = 500'000'000, kSettlingStepNs = 5'000'000;

}  // namespace

Result<void> SimulatedStage::load(const Program& program) {
    const std::uint64_t hash = contentHash(program);
    const bool hasBase = loadedHash_ != 0;
    auto answer = port_.call(difference(program, hash, hasBase ? &loaded_ : nullptr, loadedHash_));
    if (hasBase && answer) {
        const auto* refused = std::get_if<Refused>(&*answer);
        if (refused != nullptr && refused->sendWhole) answer = port_.call(difference(program, hash));
    }
    loadedHash_ = 0;  // unless the devices say that they hold it
    if (!answer) return tl::unexpected(answer.error());
    if (const auto* refused = std::get_if<Refused>(&*answer)) return tl::unexpected(refused->error);
    loaded_ = program;
    loadedHash_ = hash;
    return {};
}

Result<void> SimulatedStage::swap() {
    if (loadedHash_ == 0) return fail(Fault::device, "Nothing is loaded that could be put on show.");
    if (told_ != loaded_.waveform || slotRate_ != loaded_.slotRate) {
        const auto started = startSweep();
        if (!started) return started;
    }
    const auto done = ask<Done>(port_, Swap{});
    if (!done) return tl::unexpected(done.error());
    shownHash_ = loadedHash_;
    port_.waitUntil(done->at_ns);
    return confirmed();
}

Result<void> SimulatedStage::startSweep() {
    shownHash_ = 0;
    told_.reset();
    if (const auto steady = ask<Done>(port_, SteadyLight{}); !steady) return tl::unexpected(steady.error());
    if (const auto rate = ask<Done>(port_, SetSlotRate{loaded_.slotRate}); !rate) return tl::unexpected(rate.error());
    slotRate_ = loaded_.slotRate;
    const auto wave = ask<Done>(port_, SetWaveform{loaded_.waveform});
    if (!wave) return tl::unexpected(wave.error());
    predicted_ = predicted_.told(loaded_.waveform, wave->at_ns);
    told_ = loaded_.waveform;
    if (const auto still = settled(); !still) return still;
    return withinBudgets();
}

Result<void> SimulatedStage::settled() {
    port_.waitUntil(predicted_.settledNs(kSettledLens));
    const std::int64_t deadline = port_.nowNs() + kLongestSettlingNs;
    while (true) {
        if (const auto known = read(); !known) return known;
        if (state_->lensError <= kSettledLens) return {};
        if (port_.nowNs() >= deadline) break;
        port_.waitUntil(port_.nowNs() + kSettlingStepNs);
    }
    return fail(Fault::device, "The lens does not settle on its wave; the light stays steady. Check the lens driver.");
}

Result<void> SimulatedStage::withinBudgets() const {
    if (!told_) return {};
    const auto number = [](const char* format, double value) {
        std::array<char, 32> text{};
        std::snprintf(text.data(), text.size(), format, value);
        return std::string(text.data());
    };
    // Between cold and as warm as its own drive makes it, the lens is where the plan has it.
    const double coldest_C = told_->temperature_C, warmest_C = told_->temperature_C + told_->warming_C;
    const double now_C = state_->lensTemperature_C, off_C = now_C - std::clamp(now_C, coldest_C, warmest_C);
    if (std::abs(off_C) > kTemperatureBudget_C) {
        return fail(Fault::device, "The lens is at " + number("%.1f C", now_C) + ", " +
                                       number("%.1f C", std::abs(off_C)) + (off_C > 0.0 ? " above" : " below") +
                                       " what its wave was planned for; let it come back, or plan again at this "
                                       "temperature.");
    }
    if (state_->light != LightMode::slotted) return {};
    if (state_->triggersLost > 0) {
        return fail(Fault::device, "The projector missed a trigger, so that its slots are " +
                                       number("%.2f ms", state_->phaseError.in(1.0_ms)) +
                                       " off the lens's sweep; check the trigger cable, then TAKE.");
    }
    if (!told_->still() && abs(state_->phaseError) > kPhaseBudget) {
        return fail(Fault::device, "Slots and lens have drifted " +
                                       number("%.2f ms", abs(state_->phaseError).in(1.0_ms)) +
                                       " apart; let both run from one clock, then TAKE.");
    }
    return {};
}

Result<void> SimulatedStage::read() {
    // A question may be asked again: one lost answer is no lost device.
    auto state = ask<DeviceState>(port_, Read{});
    if (!state) state = ask<DeviceState>(port_, Read{});
    if (!state) {
        state_.reset();
        return tl::unexpected(state.error());
    }
    state_ = *std::move(state);
    return {};
}

Result<void> SimulatedStage::confirmed() {
    if (const auto known = read(); !known) return known;
    if (state_->hashShown != shownHash_)
        return fail(Fault::device, shownHash_ == 0 ? "The projector shows slots although it was told steady light."
                                   : state_->light == LightMode::steady
                                       ? "The projector went to steady light by itself; was it switched off and on?"
                                       : "The projector shows another program than it was told.");
    const LensMode expected = !told_ ? LensMode::rest : told_->still() ? LensMode::holding : LensMode::sweeping;
    if (state_->lens != expected || (told_ && state_->waveform != *told_))
        return fail(Fault::device, "The lens does something else than it was told; was its driver restarted?");
    return withinBudgets();
}

StageReport SimulatedStage::report() const {
    StageReport report;
    if (!state_) {
        report.projectorLine = "simulated projector: no answer";
        report.lensLine = "simulated lens: no answer";
        return report;
    }
    report.lensName = state_->lensName;
    report.light = state_->light;
    report.lens = state_->lens;
    report.lensPower = state_->powerNow;
    report.low = state_->waveform.low;
    report.high = state_->waveform.high;
    report.well = true;
    std::array<char, 96> line{};
    if (state_->light == LightMode::slotted)
        std::snprintf(line.data(), line.size(), "simulated projector: %zu slots at %.0f Hz", state_->slotHashes.size(),
                      state_->slotRate.si());
    else
        std::snprintf(line.data(), line.size(), "simulated projector: steady white");
    report.projectorLine = line.data();
    if (state_->lens == LensMode::sweeping)
        std::snprintf(line.data(), line.size(), "simulated lens: %.2f to %.2f D at %.0f Hz", report.low.si(),
                      report.high.si(), state_->waveform.rate.si());
    else
        std::snprintf(line.data(), line.size(), "simulated lens: %s at %.2f D",
                      state_->lens == LensMode::rest ? "at rest" : "still", state_->waveform.low.si());
    report.lensLine = line.data();
    if (state_->offWave > kOffWave) {
        std::snprintf(line.data(), line.size(), "; it is %.2f D from its predicted wave: calibrate again",
                      state_->offWave.si());
        report.lensLine += line.data();
    }
    return report;
}

Result<void> SimulatedStage::heartbeat() { return confirmed(); }

void SimulatedStage::safeLight() noexcept {
    shownHash_ = 0;
    told_.reset();
    // A command may fail once (a lost message, a busy device); light comes before the lens.
    constexpr int kTries = 3;
    try {
        bool steady = false, resting = false;
        for (int i = 0; i < kTries && !steady; ++i)
            steady = ask<Done>(port_, SteadyLight{}).has_value();
        for (int i = 0; i < kTries && steady && !resting; ++i) {
            const auto rest = ask<Done>(port_, LensToRest{});
            resting = rest.has_value();
            if (!resting) continue;
            const Waveform& wave = predicted_.wave();
            predicted_ = predicted_.told(stillWave(wave.rest, wave.rest, wave.rate), rest->at_ns);
        }
        if (!steady) loadedHash_ = 0;  // whoever answers next may be another device with an empty buffer
        if (steady && !read()) loadedHash_ = 0;
    } catch (const std::exception&) {
        // Out of memory: the devices' own watchdog is left.
        loadedHash_ = 0;
    }
}

}  // namespace ilf::devices
