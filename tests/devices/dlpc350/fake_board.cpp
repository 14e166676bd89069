#include "tests/devices/dlpc350/fake_board.h"

#include <algorithm>
#include <cstdio>

namespace ilf::devices::test {
namespace {

std::string hex(std::span<const std::uint8_t> bytes) {
    std::string text;
    char byte[4];
    for (const std::uint8_t b : bytes) {
        std::snprintf(byte, sizeof byte, "%02X", b);
        text += byte;
    }
    return text;
}

}  // namespace

FakeBoard::FakeBoard() {
    registers[0x0205] = {0x07, 0x00, 0x04, 0x04, 0, 0, 0, 1, 0, 0, 0, 2, 0, 0, 0, 3};  // 4.4.7
    registers[0x1AFF] = {'L', 'C', 'R', 0};
    registers[0x1A0A] = {0x01};
    registers[0x1A0B] = {0x01};
    registers[0x1A0C] = {0x08};
    // Locked, 912 = 0x0390 by 1140 = 0x0474, 60.00 Hz = 6000 = 0x1770 at byte 14.
    registers[0x071C] = {0x02, 0x90, 0x03, 0x74, 0x04, 0, 1, 1, 0, 0, 0, 0, 0, 0,
                         0x70, 0x17, 0,    0,    0,    0, 0, 0, 0, 0, 0, 0, 0, 0};
    registers[0x1A00] = {0x08};  // the parallel port, 24 bits
    registers[0x1203] = {7};
    registers[0x1204] = Bytes(12, 0);
    registers[0x1A1B] = {0};
    registers[0x1A22] = {3};
    registers[0x1A23] = {1};
    registers[0x1A24] = {0};
    registers[0x1A29] = Bytes(8, 0);
    registers[0x1A31] = Bytes(4, 0);
    registers[0x1A07] = {0x08};
    registers[0x1A1A] = {0x00};
    registers[0x1A1D] = {0, 0xBB, 0xBB};
    registers[0x1A1E] = {0, 0xBB};
    registers[0x1A32] = {0};
    registers[0x1A33] = {0};
    registers[0x1A34] = Bytes(384, 0);
}

void FakeBoard::flipToVideo() {
    registers[0x1A1B] = {0};
    registers[0x1A24] = {0};
    registers[0x1A0C][0] &= 0xFD;
}

Result<void> FakeBoard::send(Endpoint to, std::span<const std::uint8_t> data, Milliseconds) {
    if (unplugged) return fail(Fault::device, "The device is gone.");
    if (++calls == failAt) return fail(Fault::device, "Injected fault.");
    if (to.address != 0x01 || data.size() != 64) return fail(Fault::device, "Not a report of 64 bytes.");
    incoming_.insert(incoming_.end(), data.begin(), data.end());
    const std::size_t length = static_cast<std::size_t>(incoming_[2] | (incoming_[3] << 8));
    if (incoming_.size() >= 4 + length) {
        obey();
        incoming_.clear();
    }
    return {};
}

Result<Bytes> FakeBoard::receive(Endpoint from, std::size_t most, Milliseconds) {
    if (unplugged) return fail(Fault::device, "The device is gone.");
    if (++calls == failAt) {
        incoming_.clear();
        return fail(Fault::device, "Injected fault.");
    }
    if (from.address != 0x81 || most < 64) return fail(Fault::device, "Not a report of 64 bytes.");
    if (replies.empty()) return fail(Fault::device, "Timed out.");
    const Bytes packet = replies.front();
    replies.pop_front();
    return packet;
}

void FakeBoard::answer(Bytes message) {
    message.resize((message.size() + 63) / 64 * 64, 0);
    for (auto at = message.begin(); at != message.end(); at += 64)
        replies.emplace_back(at, at + 64);
}

void FakeBoard::obey() {
    const std::uint8_t sequence = incoming_[1];
    const int command = (incoming_[5] << 8) | incoming_[4];
    const std::size_t length = static_cast<std::size_t>(incoming_[2] | (incoming_[3] << 8));
    const Bytes payload(incoming_.begin() + 6, incoming_.begin() + 4 + static_cast<std::ptrdiff_t>(length));
    const std::string name = hex(std::array<std::uint8_t, 2>{incoming_[5], incoming_[4]});
    if (ignores.contains(command)) return;

    if (incoming_[0] == 0xC0) {
        asked.push_back(name);
        if (refuses.contains(command)) return answer({0xE0, sequence, 0, 0});
        Bytes data = registers.contains(command) ? registers[command] : Bytes{};
        if (command == 0x1A1A) data = checks_++ < busyChecks ? Bytes{0x80} : checkResult;
        // Not locked, whatever comes.
        if (command == 0x071C && (patternMode() || (registers[0x1A00][0] & 7) == 1)) data[0] = 0x01;
        if (command == 0x1A34) data = Bytes(data.begin() + 3 * offset_, data.end());
        if (lies.contains(command)) data = lies[command];
        Bytes message{0xC0, sequence, static_cast<std::uint8_t>(data.size() & 0xFF),
                      static_cast<std::uint8_t>(data.size() >> 8)};
        message.insert(message.end(), data.begin(), data.end());
        return answer(message);
    }

    if (incoming_[0] != 0x40) return answer({0x60, sequence, 2, 0, incoming_[4], incoming_[5]});
    // Settings are taken only while no pattern runs.
    const bool locked = runs() && command != 0x1A24;
    if (refuses.contains(command) || locked) return answer({0x60, sequence, 2, 0, incoming_[4], incoming_[5]});
    told.push_back(name + " " + hex(payload));
    if (command == 0x1A34)
        std::copy(payload.begin(), payload.end(), registers[command].begin() + 3 * offset_);
    else
        registers[command] = payload;
    if (command == 0x1A32) offset_ = payload[0];
    if (command == 0x1A1A) checks_ = 0;
    if (command == 0x1A24) {
        starts_ = payload[0] == 2 ? starts_ + 1 : 0;
        registers[0x1A0C][0] = static_cast<std::uint8_t>(starts_ >= startsNeeded && patternMode() ? 0x02 : 0x00);
    }
    if (losesAck.contains(command)) return;
    answer({0x40, sequence, 2, 0, incoming_[4], incoming_[5]});
}

}  // namespace ilf::devices::test
