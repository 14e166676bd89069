#include <algorithm>
#include <array>
#include <cmath>

#include "devices/emulators/light_crafter.h"

namespace ilf::devices::emulators {

namespace {

// devices.md 1.6: the shortest exposure of each depth, and the gap black needs, in microseconds.
constexpr std::array<std::uint32_t, 9> kShortest_us = {0, 235, 700, 1570, 1700, 2000, 2500, 4500, 8333};
constexpr std::int64_t kGap_ns = 230'000;
// devices.md 1.3: a delay code is 107.136 ns long, and 0xBB is none.
constexpr double kDelayStep_ns = 107.136;
constexpr int kNoDelay = 0xBB;
constexpr int kBlack = 24, kWhite = 25, kNone = 0x3F;

bool external(int trigger) { return trigger == 1 || trigger == 2; }

}  // namespace

bool EmulatedLightCrafter::variableExposure() const { return byteOf(0x1A23) >= 3; }

// devices.md 1.4
EmulatedLightCrafter::Entry EmulatedLightCrafter::decoded(const std::uint8_t* bytes, std::uint32_t exposure_us,
                                                          std::uint32_t period_us) const {
    Entry entry;
    entry.trigger = bytes[0] & 3;
    entry.pattern = bytes[0] >> 2;
    entry.depth = bytes[1] & 15;
    entry.leds = static_cast<std::uint8_t>(bytes[1] >> 4U & 7U);
    entry.invert = (bytes[2] & 1U) != 0;
    entry.blackAfter = (bytes[2] & 2U) != 0;
    entry.swaps = (bytes[2] & 4U) != 0;
    entry.sharesTrigger = (bytes[2] & 8U) != 0;
    entry.exposure_ns = std::int64_t(exposure_us) * 1000;
    entry.period_ns = std::int64_t(period_us) * 1000;
    return entry;
}

std::vector<EmulatedLightCrafter::Entry> EmulatedLightCrafter::sequence() const {
    std::vector<Entry> entries;
    if (variableExposure()) {
        const Bytes& control = registers_.at(0x1A40);
        const std::size_t count = std::min<std::size_t>(variableLut_.size(), control[0] + 256U * control[1] + 1U);
        const auto number = [](const std::uint8_t* bytes) {
            return bytes[0] | std::uint32_t(bytes[1]) << 8U | std::uint32_t(bytes[2]) << 16U |
                   std::uint32_t(bytes[3]) << 24U;
        };
        for (std::size_t i = 0; i < count; ++i) {
            const auto& bytes = variableLut_[i];
            entries.push_back(decoded(bytes.data(), number(bytes.data() + 4), number(bytes.data() + 8)));
        }
        return entries;
    }
    const std::size_t count = std::size_t(byteOf(0x1A31)) + 1;
    for (std::size_t i = 0; i < count; ++i)
        entries.push_back(decoded(patternLut_[i].data(), numberOf(0x1A29, 0), numberOf(0x1A29, 4)));
    return entries;
}

// devices.md 1.3 (1A/1A) and the constraints of 1.6.
std::uint8_t EmulatedLightCrafter::validated() const {
    const std::vector<Entry> entries = sequence();
    const bool bySync = byteOf(0x1A23) == 0 || byteOf(0x1A23) == 4;
    unsigned bits = 0;
    for (std::size_t i = 0; i < entries.size(); ++i) {
        const Entry& entry = entries[i];
        const Entry& before = entries[(i + entries.size() - 1) % entries.size()];
        const std::int64_t gap = entry.period_ns - entry.exposure_ns;
        const auto depth = static_cast<std::size_t>(entry.depth);
        const bool known = patternCount(entry.depth) > 0;
        const bool tooShort = known && entry.exposure_ns < std::int64_t(kShortest_us[depth]) * 1000;
        if (entry.exposure_ns == 0 || gap < 0 || (gap > 0 && gap <= kGap_ns) || (bySync && gap != 0) || tooShort)
            bits |= 1U;
        const bool special =
            entry.pattern == kBlack || (entry.pattern == kWhite && entry.depth == 1) || entry.pattern == kNone;
        if (!known || !(special || lowestPlane(entry.depth, entry.pattern))) bits |= 2U;
        if (entry.sharesTrigger && (i == 0 || before.blackAfter)) bits |= 4U;
        if (external(entry.trigger) && !before.blackAfter) bits |= 8U;
        if ((gap > 0 && gap < kGap_ns) || (entry.blackAfter && gap < kGap_ns)) bits |= 16U;
    }
    return static_cast<std::uint8_t>(bits);
}

std::int64_t EmulatedLightCrafter::own_ns(std::int64_t nominal_ns) const {
    const double drift = faults_.amount(Mishap::clockDrift) * 1e-6;
    if (drift == 0.0) return nominal_ns;
    return std::max<std::int64_t>(1000, std::llround(double(nominal_ns) * (1.0 + drift)));
}

std::uint8_t EmulatedLightCrafter::ledsFor(std::uint8_t wanted) const {
    const bool dark = (byteOf(0x0609) & 1U) != 0 || byteOf(0x0200) == 1;  // parked, or in standby
    const std::uint8_t enabled = byteOf(0x1A07);
    if (dark) return 0;
    return (enabled & 8U) != 0 ? wanted : static_cast<std::uint8_t>(enabled & 7U);
}

MirrorSettings EmulatedLightCrafter::mirrors() const {
    const bool swapsChannels = byteOf(0x1A37) != 4;  // as the board wires HDMI; what others do to it is not known
    return {(byteOf(0x1008) & 1U) != 0, (byteOf(0x1009) & 1U) != 0, swapsChannels};
}

void EmulatedLightCrafter::begin(std::int64_t now_ns) {
    stopSequence(now_ns);
    playing_ = sequence();
    cursor_ = 0;
    freeAt_ns_ = now_ns;
    running_ = true;
    forcedSwap_ = false;
    advance(now_ns);
}

void EmulatedLightCrafter::stopSequence(std::int64_t now_ns) {
    if (slot_) {
        slot_->end_ns = std::min(slot_->end_ns, now_ns);
        emit(std::move(*slot_));
    }
    slot_.reset();
    stopBy_ns_.reset();
    running_ = waiting_ = false;
}

void EmulatedLightCrafter::emit(LightSlot slot) {
    constexpr std::size_t kForgets = 8192;  // light nobody asked for: some five seconds
    if (slot.end_ns > slot.start_ns) light_.push_back(std::move(slot));
    while (light_.size() > kForgets)
        light_.pop_front();
}

LightSlot EmulatedLightCrafter::videoSlot(std::int64_t start_ns, std::int64_t end_ns, FramePtr frame) const {
    LightSlot slot;
    slot.start_ns = start_ns;
    slot.end_ns = end_ns;
    slot.video = true;
    slot.gamma = (byteOf(0x1A0E) & 0x80U) != 0 ? 2.2 : 1.0;  // the curve of its table 0 is not known
    slot.leds = ledsFor(7);
    slot.mirrors = mirrors();
    slot.frame = std::move(frame);
    return slot;
}

/// Plays entries until `now_ns` or until one waits for its trigger.
void EmulatedLightCrafter::advance(std::int64_t now_ns) {
    draw(now_ns);
    while (running_) {
        const std::int64_t next = slot_ ? slot_->end_ns : waiting_ ? now_ns + 1 : freeAt_ns_;
        if (stopBy_ns_ && *stopBy_ns_ <= std::min(next, now_ns)) return stopSequence(*stopBy_ns_);
        if (next > now_ns) return;
        if (slot_) {
            emit(std::move(*slot_));
            slot_.reset();
            continue;
        }
        if (cursor_ == playing_.size()) {
            const bool repeats = variableExposure() ? registers_.at(0x1A40)[5] != 0 : registers_.at(0x1A31)[1] != 0;
            if (!repeats) return stopSequence(now_ns);
            cursor_ = 0;
        }
        if (external(playing_[cursor_].trigger))
            waiting_ = true;
        else
            expose(playing_[cursor_], freeAt_ns_);
    }
}

void EmulatedLightCrafter::expose(const Entry& entry, std::int64_t now_ns) {
    const std::size_t group = variableExposure() ? registers_.at(0x1A40)[2] + 256U * registers_.at(0x1A40)[3] + 1U
                                                 : std::size_t(registers_.at(0x1A31)[2]) + 1U;
    if (cursor_ % group == 0) {
        constexpr std::size_t kForgets = 4096;
        const Bytes& trigger = registers_.at(0x1A1E);
        const bool idle = (trigger[0] & options_.quirks.triggerPolarityBit) != 0;
        const std::int64_t at = now_ns + std::llround((int(trigger[1]) - kNoDelay) * kDelayStep_ns);
        edges_.push_back({at, !idle});
        edges_.push_back({at + options_.triggerWidth_ns, idle});
        while (edges_.size() > kForgets)
            edges_.pop_front();
    }
    const bool swaps = entry.swaps || (options_.quirks.swapsWithoutBit && cursor_ == 0);
    if (swaps && !frozen_ && !faults_.strikes(Mishap::stuckFrame)) {
        const bool atSync = lastSync_ns_ == now_ns;
        shown_ = atSync ? arrived_ : arriving_;
        shownNumber_ = atSync ? arrivedNumber_ : arrivingNumber_;
    }
    LightSlot slot;
    slot.start_ns = now_ns;
    slot.end_ns = now_ns + own_ns(entry.exposure_ns);
    slot.pattern = entry.pattern;
    slot.depth = entry.depth;
    slot.inverted = entry.invert != ((byteOf(0x1A30) & 1U) != 0);
    slot.leds = ledsFor(entry.leds);
    slot.mirrors = mirrors();
    if (byteOf(0x1A22) == 0) slot.frame = shown_;
    slot.frameNumber = shownNumber_;
    freeAt_ns_ = now_ns + own_ns(entry.period_ns);
    if (entry.blackAfter) freeAt_ns_ = std::max(freeAt_ns_, slot.end_ns + kGap_ns);
    waiting_ = false;
    ++cursor_;
    slot_ = std::move(slot);
}

/// A trigger has come. Where entries of the last one are still being shown they are cut short and the sequence goes on
/// at the next that waits for one (devices.md 1.3, HW status bit 3).
void EmulatedLightCrafter::triggered(std::int64_t now_ns) {
    if (!waiting_) {
        std::size_t next = cursor_;
        for (std::size_t tried = 0; tried < playing_.size(); ++tried, ++next)
            if (external(playing_[next % playing_.size()].trigger)) break;
        if (!external(playing_[next % playing_.size()].trigger)) return;
        forcedSwap_ = true;
        if (slot_) {
            slot_->end_ns = now_ns;
            emit(std::move(*slot_));
            slot_.reset();
        }
        cursor_ = next % playing_.size();
    }
    expose(playing_[cursor_], now_ns);
}

void EmulatedLightCrafter::verticalSync(FramePtr frame, std::int64_t now_ns) {
    advance(now_ns);
    if (!source_ || input() != 0) return;  // not plugged, or not looked at
    arrived_ = std::move(arriving_);
    arrivedNumber_ = arrivingNumber_++;
    arriving_ = std::move(frame);
    lastSync_ns_ = now_ns;

    if (!patternMode(now_ns)) {
        if (videoFrom_ns_) {
            LightSlot slot = videoSlot(*videoFrom_ns_, now_ns, shown_);
            slot.frameNumber = shownNumber_;
            emit(std::move(slot));
        }
        videoFrom_ns_ = now_ns;
        if (frozen_ || faults_.strikes(Mishap::stuckFrame)) return;
        shown_ = arrived_;
        shownNumber_ = arrivedNumber_;
        return;
    }
    videoFrom_ns_.reset();
    if (stopBy_ns_) return stopSequence(now_ns);
    const bool bySync = byteOf(0x1A23) == 0 || byteOf(0x1A23) == 4;
    if (running_ && bySync && !faults_.strikes(Mishap::droppedTrigger)) triggered(now_ns);
}

void EmulatedLightCrafter::triggerIn(std::int64_t now_ns) {
    advance(now_ns);
    const bool bySync = byteOf(0x1A23) == 0 || byteOf(0x1A23) == 4;
    if (running_ && waiting_ && !bySync && !faults_.strikes(Mishap::droppedTrigger)) triggered(now_ns);
}

std::int64_t EmulatedLightCrafter::knownUntil(std::int64_t now_ns) const {
    if (!source_ || !lastSync_ns_ || source_->refresh_Hz <= 0.0) return now_ns;
    const auto period_ns = static_cast<std::int64_t>(1e9 / source_->refresh_Hz);
    const std::int64_t overdue_ns =
        *lastSync_ns_ + options_.framesAwaited * period_ns;  // then there are no frames any more
    return now_ns > overdue_ns ? now_ns : std::min(now_ns, *lastSync_ns_ + period_ns * 9 / 10);
}

std::vector<LightSlot> EmulatedLightCrafter::takeLight(std::int64_t now_ns) {
    advance(now_ns);
    std::vector<LightSlot> taken(std::make_move_iterator(light_.begin()), std::make_move_iterator(light_.end()));
    light_.clear();
    return taken;
}

std::vector<TriggerEdge> EmulatedLightCrafter::takeTriggers(std::int64_t now_ns) {
    advance(now_ns);
    std::vector<TriggerEdge> taken;
    while (!edges_.empty() && edges_.front().time_ns <= now_ns) {
        taken.push_back(edges_.front());
        edges_.pop_front();
    }
    return taken;
}

}  // namespace ilf::devices::emulators
