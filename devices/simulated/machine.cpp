#include "devices/simulated/machine.h"

#include <cmath>
#include <cstdio>
#include <utility>

#include "devices/link/program_update.h"

namespace ilf::devices {
namespace {

// What the injected faults are.
constexpr double kRoom_C = 30.0, kWarmer_C = 10.0, kDrift_ppm = 100.0;
// Enough to read what happened around a fault.
constexpr std::size_t kLogLines = 64;

std::string written(Dioptre power) {
    std::string out(32, '\0');
    out.resize(static_cast<std::size_t>(std::snprintf(out.data(), out.size(), "%.3f D", power.si())));
    return out;
}

bool canBePlayed(const Waveform& w) {
    return isFinite(w.rest) && isFinite(w.low) && isFinite(w.high) && isFinite(w.rate) && w.rate > 0.0_Hz &&
           w.low <= w.high && isFinite(w.power) && isFinite(w.drive) && std::isfinite(w.temperature_C) &&
           std::isfinite(w.warming_C);
}

Waveform resting(const Waveform& w) { return stillWave(w.rest, w.rest, w.rate); }

std::uint64_t imageHash(const LightImage& image) {
    Program alone;
    alone.projector = image.size();
    alone.images = {image};
    return contentHash(alone);
}

}  // namespace

Machine::Machine(std::int64_t now_ns, SimulatedLens lens)
    : lensName_(std::string("simulated lens, ") + (lens.preset ? "preset " : "") + std::string(word(lens))),
      heardNs_(now_ns) {
    if (lens.preset) emulated_.emplace(*lens.preset, now_ns);
}

void Machine::note(std::string line) {
    log_.push_back(std::move(line));
    if (log_.size() > kLogLines) log_.pop_front();
}

Body Machine::refused(std::string why, bool sendWhole) {
    ++counters_.refusals;
    note("refused: " + why);
    return Refused{{Fault::device, std::move(why)}, sendWhole};
}

void Machine::advance(std::int64_t now_ns) {
    if (emulated_) emulated_->advance(now_ns);
    if (swapAtNs_ && now_ns >= *swapAtNs_) {
        // An image that stayed shares its boxes, so that telling so is much cheaper than hashing it again.
        std::vector<std::uint64_t> hashes;
        for (std::size_t i = 0; i < back_.images.size(); ++i) {
            const bool stayed = i < imageHashes_.size() && front_.images[i] == back_.images[i];
            hashes.push_back(stayed ? imageHashes_[i] : imageHash(back_.images[i]));
        }
        imageHashes_ = std::move(hashes);
        front_ = back_;
        frontHash_ = backHash_;
        light_ = LightMode::slotted;
        ++counters_.swaps;
        counters_.swapped_ns = *std::exchange(swapAtNs_, std::nullopt);
    }
    if (light_ == LightMode::slotted && std::exchange(dropTrigger_, false)) {
        ++counters_.triggersLost;
        slotsLate_ += 1.0 / slotRate_;
        note("a trigger is lost");
    }
    if (watchdogNs_ && light_ == LightMode::slotted && now_ns - heardNs_ > *watchdogNs_) {
        ++counters_.watchdogTrips;
        note("watchdog: the player is silent");
        obeyed(SteadyLight{}, now_ns);
        obeyed(LensToRest{}, now_ns);
    }
}

Body Machine::obeyed(const ProgramUpdate& update) {
    if (swapAtNs_) return refused("The projector is about to swap; load after that.");
    const Program* base = backHash_ != 0 ? &back_ : nullptr;
    if (needsAnotherBase(update, base, backHash_)) return refused("The projector holds another program.", true);
    auto program = assembled(update, base, backHash_);
    if (!program) return refused(program.error().what, true);
    back_ = *std::move(program);
    backHash_ = update.hash;
    counters_.tilesReceived += update.tiles.size();
    note("load " + std::to_string(update.tiles.size()) + " tiles");
    return Done{};
}

Body Machine::obeyed(const SetWaveform& order, std::int64_t now_ns) {
    if (!canBePlayed(order.waveform)) return refused("The lens cannot play a wave without finite powers and a rate.");
    if (light_ == LightMode::slotted) ++counters_.waveformChangesUnderSlottedLight;
    if (emulated_) {
        if (const auto fine = emulated_->playable(order.waveform); !fine) return refused(fine.error().what);
        emulated_->play(order.waveform, now_ns);
    }
    lens_ = lens_.told(order.waveform, now_ns);
    lensMode_ = order.waveform.still() ? LensMode::holding : LensMode::sweeping;
    note("wave " + written(order.waveform.low) + " to " + written(order.waveform.high));
    return Done{now_ns};
}

Body Machine::obeyed(const SetSlotRate& order, std::int64_t now_ns) {
    if (!isFinite(order.rate) || order.rate <= 0.0_Hz) return refused("The projector cannot show slots at that rate.");
    if (light_ == LightMode::slotted && order.rate != slotRate_) {
        ++counters_.rateChangesUnderSlottedLight;
        return refused("The projector does not change its slot rate while slots are on show.");
    }
    slotRate_ = order.rate;
    note("slot rate " + std::to_string(std::lround(order.rate.si())) + " Hz");
    return Done{now_ns};
}

Body Machine::obeyed(const Swap&, std::int64_t now_ns) {
    if (backHash_ == 0) return refused("The projector has nothing loaded to swap in.");
    if (back_.slotRate != slotRate_)
        return refused("The loaded program is for another slot rate than the projector's.");
    swapAtNs_ = lens_.nextSweepStartNs(now_ns);
    note("swap");
    advance(now_ns);
    return Done{swapAtNs_.value_or(counters_.swapped_ns)};
}

Body Machine::obeyed(const SteadyLight&, std::int64_t now_ns) {
    swapAtNs_.reset();
    light_ = LightMode::steady;
    counters_.triggersLost = 0;
    slotsLate_ = {};
    note("steady light");
    return Done{now_ns};
}

Body Machine::obeyed(const LensToRest&, std::int64_t now_ns) {
    if (light_ == LightMode::slotted) ++counters_.waveformChangesUnderSlottedLight;
    if (lensMode_ != LensMode::rest) {
        const Waveform rest = resting(lens_.wave());
        if (emulated_) emulated_->play(rest, now_ns);
        lens_ = lens_.told(rest, now_ns);
    }
    lensMode_ = LensMode::rest;
    note("lens to rest");
    return Done{now_ns};
}

Body Machine::obeyed(const ReadSlot& order) const {
    if (light_ != LightMode::slotted || order.slot < 0 || std::cmp_greater_equal(order.slot, front_.imageOfSlot.size()))
        return Refused{{Fault::notFound, "There is no slot " + std::to_string(order.slot) + " on show."}, false};
    const int image = front_.imageOfSlot[static_cast<std::size_t>(order.slot)];
    if (image == Program::kDark) return SlotImage{order.slot, LightImage(front_.projector), 0};
    const auto index = static_cast<std::size_t>(image);
    return SlotImage{order.slot, front_.images[index], imageHashes_[index]};
}

Body Machine::obeyed(const InjectFault& order, std::int64_t now_ns) {
    using Kind = InjectFault::Kind;
    if ((order.kind == Kind::warmer || order.kind == Kind::drift) && !emulated_)
        return refused("The ideal lens knows neither warmth nor a clock of its own; start an emulated one.");
    if (order.kind == Kind::refuse || order.kind == Kind::silence || order.kind == Kind::die)
        return refused("Only the devices' process can fail like this.");
    if (order.kind == Kind::dropTrigger) dropTrigger_ = true;
    if (order.kind == Kind::warmer) emulated_->setAmbient(kRoom_C + kWarmer_C);
    if (order.kind == Kind::drift) emulated_->setDrift(kDrift_ppm);
    if (order.kind == Kind::none) {
        dropTrigger_ = false;
        if (emulated_) emulated_->setAmbient(kRoom_C), emulated_->setDrift(0.0);
    }
    return Done{now_ns};
}

Body Machine::answered(const Body& request, std::int64_t now_ns) {
    advance(now_ns);
    ++counters_.calls;
    if (const auto* order = std::get_if<ProgramUpdate>(&request)) return obeyed(*order);
    if (const auto* order = std::get_if<SetWaveform>(&request)) return obeyed(*order, now_ns);
    if (const auto* order = std::get_if<SetSlotRate>(&request)) return obeyed(*order, now_ns);
    if (const auto* order = std::get_if<Swap>(&request)) return obeyed(*order, now_ns);
    if (const auto* order = std::get_if<SteadyLight>(&request)) return obeyed(*order, now_ns);
    if (const auto* order = std::get_if<LensToRest>(&request)) return obeyed(*order, now_ns);
    if (const auto* order = std::get_if<ReadSlot>(&request)) return obeyed(*order);
    if (const auto* order = std::get_if<InjectFault>(&request)) return obeyed(*order, now_ns);
    if (std::holds_alternative<Read>(request)) return state(now_ns);
    return refused("Lens and projector do not know this order.");
}

DeviceState Machine::state(std::int64_t now_ns) const {
    DeviceState s = counters_;
    s.now_ns = now_ns;
    s.light = light_;
    s.slotRate = slotRate_;
    s.hashShown = light_ == LightMode::slotted ? frontHash_ : 0;
    s.hashLoaded = backHash_;
    if (light_ == LightMode::slotted)
        for (const int image : front_.imageOfSlot)
            s.slotHashes.push_back(image == Program::kDark ? 0 : imageHashes_[static_cast<std::size_t>(image)]);
    s.lens = lensMode_;
    s.waveform = lens_.wave();
    s.lensName = lensName_;
    s.phaseError = slotsLate_;
    if (emulated_) {
        EmulatedLens then = *emulated_;
        then.advance(now_ns);
        s.powerNow = then.power();
        s.lensError = then.unsettled();
        s.offWave = then.offWave();
        s.lensTemperature_C = then.temperature_C();
        s.phaseError += then.ahead();
    } else {
        s.powerNow = lens_.powerAt(now_ns);
        s.lensError = lens_.errorAt(now_ns);
    }
    s.log.assign(log_.begin(), log_.end());
    return s;
}

}  // namespace ilf::devices
