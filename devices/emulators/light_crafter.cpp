#include "devices/emulators/light_crafter.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "devices/emulators/light_crafter_commands.h"

namespace ilf::devices::emulators {

namespace {

constexpr std::size_t kPacket = 64, kHeader = 4;
constexpr std::size_t kLongest = 514;  // the two bytes of the command and 512 of data
constexpr std::int64_t kSecond_ns = 1'000'000'000;

void put(Bytes& bytes, std::size_t offset, std::uint32_t value, int count) {
    for (int i = 0; i < count; ++i)
        bytes[offset + std::size_t(i)] = static_cast<std::uint8_t>(value >> (8U * unsigned(i)));
}

}  // namespace

EmulatedLightCrafter::EmulatedLightCrafter(LightCrafterOptions options) : options_(options) { reset(); }

UsbDescriptors EmulatedLightCrafter::descriptors() const {
    const auto in = static_cast<std::uint8_t>(0x80U | options_.endpoint);
    return usbDescriptors(
        {0x0451, 0x6401, 3, "Texas Instruments", "DLPC350", "", {{in, 3, 64}, {options_.endpoint, 3, 64}}});
}

void EmulatedLightCrafter::reset() {
    registers_.clear();
    for (const auto& [id, command] : commands()) {
        Bytes bytes = command.atPowerOn;
        bytes.resize(std::size_t(std::max({command.written, command.readBack, 1})));
        registers_[id] = bytes;
    }
    patternLut_ = {};
    imageLut_ = {};
    variableLut_.assign(1824, {});
    message_.clear();
    replies_.clear();
    halted_ = hung_ = pattern_ = checked_ = frozen_ = false;
    freshLut_ = true;
    running_ = waiting_ = forcedSwap_ = false;
    toggles_ = 0;
    validation_ = 0;
    validateBy_ns_.reset();
    ignoredStart_ns_.reset();
    stopBy_ns_.reset();
    slot_.reset();
    drawn_ = nullptr;
    backOnBus_ns_.reset();
    deafUntil_ns_ = 0;
}

void EmulatedLightCrafter::powerCycle(std::int64_t now_ns) {
    advance(now_ns);
    reset();
    harmed_ = false;
    arriving_ = arrived_ = shown_ = nullptr;
    videoFrom_ns_.reset();
    pluggedAt_ns_ = now_ns;
}

void EmulatedLightCrafter::unplugged(std::int64_t /*now_ns*/) {
    message_.clear();
    replies_.clear();
    halted_ = false;
}

UsbTransfer EmulatedLightCrafter::out(std::uint8_t endpoint, std::span<const std::uint8_t> data, std::int64_t now_ns) {
    if (backOnBus_ns_ && now_ns < *backOnBus_ns_) return {UsbAnswer::gone, 0};
    if (endpoint != options_.endpoint || halted_) return {UsbAnswer::stall, 0};
    const std::size_t passing = faults_.passBefore(Mishap::unplug, data.size());
    for (std::size_t begin = 0; begin < passing && !halted_; begin += kPacket)
        packet(data.subspan(begin, std::min(kPacket, passing - begin)), now_ns);
    if (passing < data.size()) return {UsbAnswer::gone, passing};
    return {UsbAnswer::done, data.size()};
}

UsbTransfer EmulatedLightCrafter::in(std::uint8_t endpoint, std::span<std::uint8_t> room, std::int64_t now_ns) {
    if (backOnBus_ns_ && now_ns < *backOnBus_ns_) return {UsbAnswer::gone, 0};
    if (endpoint != (0x80U | options_.endpoint) || halted_) return {UsbAnswer::stall, 0};
    if (replies_.empty()) return {UsbAnswer::busy, 0};
    const Bytes reply = std::move(replies_.front());
    replies_.pop_front();
    const std::size_t bytes = std::min(room.size(), reply.size());
    std::copy_n(reply.begin(), bytes, room.begin());
    return {UsbAnswer::done, bytes};
}

UsbTransfer EmulatedLightCrafter::control(const ControlSetup& /*setup*/, std::span<std::uint8_t> /*data*/,
                                          std::int64_t /*now_ns*/) {
    return {UsbAnswer::stall, 0};
}

void EmulatedLightCrafter::clearHalt(std::uint8_t /*endpoint*/, std::int64_t /*now_ns*/) { halted_ = false; }

// A message: 4 bytes of header, then as many as bytes 2 and 3 say, in packets of 64 of which only the first has a
// header (devices.md 1.2). Reports of another length are not for this device.
void EmulatedLightCrafter::packet(std::span<const std::uint8_t> bytes, std::int64_t now_ns) {
    if (bytes.size() != kPacket) {
        message_.clear();
        return;
    }
    if (message_.empty()) {
        const std::size_t length = bytes[2] + 256U * bytes[3];
        expected_ = kHeader + length;
        if (length < 2 || length > kLongest) {
            message_.assign(bytes.begin(), bytes.begin() + 6);
            acknowledge(true);
            message_.clear();
            return;
        }
    }
    message_.insert(message_.end(), bytes.begin(), bytes.end());
    if (message_.size() < expected_) return;
    message_.resize(expected_);
    obey(now_ns);
    message_.clear();
}

void EmulatedLightCrafter::obey(std::int64_t now_ns) {
    advance(now_ns);
    ++messages_;
    const std::uint8_t flags = message_[0];
    const unsigned id = message_[4] + 256U * message_[5];
    const std::span<const std::uint8_t> payload = std::span(message_).subspan(6);
    if (faults_.strikes(Mishap::wrongMode)) showVideo(now_ns);
    if (faults_.strikes(Mishap::stall)) {
        halted_ = true;
        return;
    }
    if (faults_.strikes(Mishap::silence) || hung_ || now_ns < deafUntil_ns_) return;
    if (forbidden(id)) {
        harmed_ = hung_ = true;
        return;
    }
    const bool refused = faults_.strikes(Mishap::nack);
    const auto found = commands().find(id);
    if (refused || (flags & 7U) != 0 || found == commands().end()) return acknowledge(true);
    if ((flags & 0x80U) != 0) {
        const auto data = found->second.readBack == kNo ? std::nullopt : read(id, now_ns);
        return data ? answer(*data) : acknowledge(true);
    }

    const Command& command = found->second;
    const bool fits = command.written == kAny || command.written == int(payload.size());
    if (!fits || !allowed(id, payload) || (command.keepsStill && running_)) return acknowledge(true);
    if (id == 0x0802) {  // devices.md 1.3: no reply, 5 to 10 s off the bus
        reset();
        backOnBus_ns_ = now_ns + 5 * kSecond_ns;
        return;
    }
    if (id == 0x0200 && byteOf(id) == 1 && payload[0] == 0) {  // TI's program sees no reply to this, and waits 2 s
        registers_[id][0] = 0;
        deafUntil_ns_ = now_ns + 2 * kSecond_ns;
        return;
    }
    const bool obeyed = write(id, payload, now_ns);
    if (!hung_) acknowledge(!obeyed);
}

bool EmulatedLightCrafter::write(unsigned command, std::span<const std::uint8_t> payload, std::int64_t now_ns) {
    const std::uint8_t first = payload.empty() ? std::uint8_t(0) : payload[0];
    const auto changesSequence = [&] {
        checked_ = false;
        freshLut_ = true;
        ignoredStart_ns_.reset();
    };
    switch (command) {
    case 0x1A24:
        return runCommand(first, now_ns);
    case 0x1A1B: {
        const bool pattern = first == 1;
        if (pattern == pattern_) return true;
        // The controller hangs when it is switched to video again and again (devices.md 1.9).
        if (!pattern && source_ && options_.quirks.togglesUntilHang > 0 &&
            ++toggles_ >= options_.quirks.togglesUntilHang) {
            hung_ = true;
            return false;
        }
        pattern_ = pattern;
        patternSince_ns_ = now_ns + options_.modeSwitch_ns;
        if (!pattern) pluggedAt_ns_ = now_ns;  // the source is looked at anew
        return true;
    }
    case 0x1A1A:
        if (byteOf(0x1A33) != 0) return false;  // the mailbox is open
        validation_ = validated();
        validateBy_ns_ = now_ns + options_.validation_ns;
        checked_ = true;
        return true;
    case 0x1A34: {
        const std::size_t offset = byteOf(0x1A32);
        changesSequence();
        if (byteOf(0x1A33) == 1 && !payload.empty() && offset + payload.size() <= 64) {
            std::copy(payload.begin(), payload.end(), imageLut_.begin() + std::ptrdiff_t(offset));
            return true;
        }
        if (byteOf(0x1A33) != 2 || payload.empty() || payload.size() % 3 != 0) return false;
        if (offset + payload.size() / 3 > patternLut_.size()) return false;
        for (std::size_t i = 0; i < payload.size(); ++i)
            patternLut_[offset + i / 3][i % 3] = payload[i];
        return true;
    }
    case 0x1A3E: {
        const std::size_t offset = registers_[0x1A3F][0] + 256U * registers_[0x1A3F][1];
        if (byteOf(0x1A33) != 3 || offset >= variableLut_.size()) return false;
        changesSequence();
        std::copy(payload.begin(), payload.end(), variableLut_[offset].begin());
        return true;
    }
    case 0x100A:
        frozen_ = first == 1;
        break;
    case 0x0200:
        if (first == 1) stopSequence(now_ns);
        break;
    case 0x0B01:
        ++ledCurrentWrites_;
        break;
    case 0x1A22:
    case 0x1A23:
    case 0x1A29:
    case 0x1A31:
    case 0x1A40:
        changesSequence();
        break;
    case 0x1A00:
        if (input() != (first & 7U)) inputChanged(now_ns);
        break;
    default:
        break;
    }
    const bool drawsOtherwise = (command == 0x1A00 || command == 0x1203 || command == 0x1204) &&
                                !std::ranges::equal(payload, registers_[command]);
    if (drawsOtherwise) endDrawing(now_ns);
    std::copy(payload.begin(), payload.end(), registers_[command].begin());
    if (drawsOtherwise) draw(now_ns);
    return true;
}

bool EmulatedLightCrafter::runCommand(std::uint8_t value, std::int64_t now_ns) {
    constexpr std::int64_t kStops_ns = 34'000'000;  // two frames, where no vertical sync comes before
    if (value == 0) {
        registers_[0x1A24][0] = 0;
        if (running_ && !stopBy_ns_) stopBy_ns_ = now_ns + kStops_ns;
        return true;
    }
    const bool mayRun = patternMode(now_ns) && checked_ && validateBy_ns_ && now_ns >= *validateBy_ns_ &&
                        (validation_ & 3U) == 0 && byteOf(0x1A33) == 0;
    if (!mayRun) return false;
    registers_[0x1A24][0] = value;
    if (value == 1) {
        stopSequence(now_ns);
        return true;
    }
    if (running_ && !stopBy_ns_) return true;
    constexpr std::int64_t kSoon_ns = 50'000'000;
    if (options_.quirks.secondStart && freshLut_) {
        if (!ignoredStart_ns_) ignoredStart_ns_ = now_ns;
        if (now_ns - *ignoredStart_ns_ < kSoon_ns) return true;
    }
    freshLut_ = false;
    begin(now_ns);
    return true;
}

std::optional<Bytes> EmulatedLightCrafter::read(unsigned command, std::int64_t now_ns) {
    switch (command) {
    case 0x0205: {
        Bytes versions(16);
        for (std::size_t i = 0; i < 4; ++i) {
            versions[4 * i] = options_.firmware[3];
            versions[4 * i + 1] = options_.firmware[2];
            versions[4 * i + 2] = options_.firmware[1];
            versions[4 * i + 3] = options_.firmware[0];
        }
        return versions;
    }
    case 0x1AFF: {
        Bytes tag(32);
        const std::string_view name = "emulated";
        std::copy(name.begin(), name.end(), tag.begin());
        return tag;
    }
    case 0x1A0A: {
        const bool starved = running_ && (!source_ || input() != 0) && byteOf(0x1A22) == 0;
        return Bytes{static_cast<std::uint8_t>(1U | (forcedSwap_ ? 8U : 0U) | (starved ? 0x40U : 0U))};
    }
    case 0x1A0B:
        return Bytes{1};
    case 0x1A0C: {
        const bool gamma = (byteOf(0x1A0E) & 0x80U) != 0;
        return Bytes{static_cast<std::uint8_t>((byteOf(0x0609) & 1U) | (running_ ? 2U : 0U) | (frozen_ ? 4U : 0U) |
                                               (gamma ? 8U : 0U))};
    }
    case 0x071C:
        return videoStatus(now_ns);
    case 0x1A1B:
        return Bytes{static_cast<std::uint8_t>(patternMode(now_ns) ? 1 : 0)};
    case 0x1A1A:
        if (validateBy_ns_ && now_ns < *validateBy_ns_) return Bytes{0x80};
        return Bytes{validation_};
    case 0x1A34: {
        // Not in devices.md; TI's own program reads the pattern LUT back through the open mailbox. Taken here: all of
        // it, from the mailbox's entry on.
        if (byteOf(0x1A33) != 2) return std::nullopt;
        Bytes entries;
        for (std::size_t i = byteOf(0x1A32); i < patternLut_.size(); ++i)
            entries.insert(entries.end(), patternLut_[i].begin(), patternLut_[i].end());
        return entries;
    }
    case 0x1A3A:
    case 0x1A42:
        return Bytes(std::size_t(commands().at(command).readBack));
    default:
        return registers_.at(command);
    }
}

// Offsets: devices.md 1.3, 07/1C. Blanking as in the modeline of 1.8, in proportion for other sizes.
Bytes EmulatedLightCrafter::videoStatus(std::int64_t now_ns) const {
    Bytes status(28);
    if (!source_) return status;
    if (patternMode(now_ns) || input() != 0 || now_ns - pluggedAt_ns_ < options_.lock_ns) {
        status[0] = 1;
        return status;
    }
    const int totalColumns = source_->width == 912 ? 1192 : source_->width * 13 / 10;
    const int totalRows = source_->height == 1140 ? 1170 : source_->height * 103 / 100;
    const double rows_Hz = source_->refresh_Hz * totalRows;
    const auto rounded = [](double value) { return static_cast<std::uint32_t>(std::llround(value)); };
    status[0] = 2;
    put(status, 1, std::uint32_t(source_->width), 2);
    put(status, 3, std::uint32_t(source_->height), 2);
    status[6] = status[7] = 1;
    put(status, 8, rounded(rows_Hz * totalColumns / 10.0), 4);
    put(status, 12, rounded(rows_Hz / 10.0), 2);
    put(status, 14, rounded(source_->refresh_Hz * 100.0), 2);
    put(status, 16, std::uint32_t(totalColumns), 2);
    put(status, 18, std::uint32_t(totalRows), 2);
    put(status, 20, std::uint32_t(source_->width), 2);
    put(status, 22, std::uint32_t(source_->height), 2);
    put(status, 24, std::uint32_t(totalColumns - source_->width) * 6 / 7, 2);
    put(status, 26, std::uint32_t(totalRows - source_->height) * 2 / 3, 2);
    return status;
}

// A refused read has bit 5 and no data; an acknowledgement repeats the command (devices.md 1.2).
void EmulatedLightCrafter::acknowledge(bool refused) {
    const std::uint8_t flags = message_[0];
    if ((flags & 0x40U) == 0) return;
    const bool reads = (flags & 0x80U) != 0;
    Bytes reply = {static_cast<std::uint8_t>((flags & 0xC0U) | (refused ? 0x20U : 0U)),
                   message_[1],
                   static_cast<std::uint8_t>(reads ? 0 : 2),
                   0,
                   message_[4],
                   message_[5]};
    enqueue(std::move(reply));
}

void EmulatedLightCrafter::answer(const Bytes& data) {
    if ((message_[0] & 0x40U) == 0) return;
    Bytes reply = {static_cast<std::uint8_t>(message_[0] & 0xC0U), message_[1], static_cast<std::uint8_t>(data.size()),
                   static_cast<std::uint8_t>(data.size() >> 8U)};
    reply.insert(reply.end(), data.begin(), data.end());
    enqueue(std::move(reply));
}

void EmulatedLightCrafter::enqueue(Bytes reply) {
    constexpr std::size_t kForgets = 256;  // reports nobody fetched
    reply.resize((reply.size() + kPacket - 1) / kPacket * kPacket);
    for (std::size_t begin = 0; begin < reply.size(); begin += kPacket)
        replies_.emplace_back(reply.begin() + std::ptrdiff_t(begin), reply.begin() + std::ptrdiff_t(begin + kPacket));
    while (replies_.size() > kForgets)
        replies_.pop_front();
}

void EmulatedLightCrafter::showVideo(std::int64_t now_ns) {
    stopSequence(now_ns);
    pattern_ = false;
    patternSince_ns_ = now_ns;
    registers_[0x1A24][0] = 0;
}

void EmulatedLightCrafter::plugVideo(const VideoSource& source, std::int64_t now_ns) {
    advance(now_ns);
    showVideo(now_ns);
    if (options_.quirks.plugSelectsVideo) {
        endDrawing(now_ns);
        registers_[0x1A00][0] &= 0xF8U;
    }
    source_ = source;
    pluggedAt_ns_ = now_ns;
    arriving_ = arrived_ = nullptr;
    lastSync_ns_.reset();
}

void EmulatedLightCrafter::unplugVideo(std::int64_t now_ns) {
    advance(now_ns);
    source_.reset();
    arriving_ = arrived_ = nullptr;
    lastSync_ns_.reset();
    videoFrom_ns_.reset();
}

bool EmulatedLightCrafter::patternMode(std::int64_t now_ns) const {
    return now_ns >= patternSince_ns_ ? pattern_ : !pattern_;
}

std::uint32_t EmulatedLightCrafter::numberOf(unsigned command, std::size_t offset) const {
    const Bytes& bytes = registers_.at(command);
    assert(offset + 4 <= bytes.size());
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < 4; ++i)
        value |= std::uint32_t(bytes[offset + i]) << (8U * unsigned(i));
    return value;
}

}  // namespace ilf::devices::emulators
