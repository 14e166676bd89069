// A lens driver 4 on a serial line, written from its public table by hand: it shares nothing with the driver under
// test.
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <deque>
#include <string>
#include <utility>
#include <vector>

#include "devices/clock.h"
#include "devices/serial/serial_link.h"

namespace ilf::devices::test {

/// A clock that only tests move.
struct VirtualTime {
    std::chrono::nanoseconds at{0};
    Clock clock() {
        return {[this] { return at; }, [this](std::chrono::nanoseconds time) { at += time; }};
    }
};

/// What the device is, and what it has been told. Lives outside the link so that it can be looked at afterwards.
struct FakeDriver {
    VirtualTime time;
    // What it is.
    char type = 'F';
    std::string serial = "ANAB1234";
    int mostHundredths = 29284, upper = 4095, lower = -4095;
    int temperature = 30 * 16;
    std::uint32_t status = 0;
    int powerHigh = 2000, powerLow = -2000;  ///< codes
    bool oldFirmware = false, damages = false, silent = false;
    // What it does.
    int mode = 2;
    int current = 700, power = 0;
    int codesPerPower = 0;  ///< of current, in focal power mode; 0: whatever it was
    std::uint32_t milliHertz = 1;
    int swingHigh = 0, swingLow = 0;
    int starts = 0, eepromWrites = 0;
    std::vector<std::pair<std::chrono::nanoseconds, int>> currents;  ///< when, code
    std::deque<std::uint8_t> out;
    std::vector<std::uint8_t> in;
    // Faults: the n-th call of the line fails, or the line is gone from then on.
    int calls = 0, failsAt = 0;
    bool gone = false, goneForGood = false;

    bool failing() {
        ++calls;
        if (failsAt != 0 && calls == failsAt) gone = goneForGood;
        return gone || calls == failsAt;
    }

    static unsigned crc(const std::vector<std::uint8_t>& bytes) {
        // CRC-16/ARC by nibbles.
        static constexpr std::array<unsigned, 16> kTable{0x0000, 0xCC01, 0xD801, 0x1400, 0xF001, 0x3C00,
                                                         0x2800, 0xE401, 0xA001, 0x6C00, 0x7800, 0xB401,
                                                         0x5000, 0x9C01, 0x8801, 0x4400};
        unsigned value = 0;
        for (const unsigned byte : bytes) {
            value = kTable[(value ^ byte) & 15U] ^ (value >> 4);
            value = kTable[(value ^ (byte >> 4)) & 15U] ^ (value >> 4);
        }
        return value;
    }
    void say(const std::string& letters, const std::vector<int>& data = {}) {
        std::vector<std::uint8_t> bytes(letters.begin(), letters.end());
        for (const int byte : data)
            bytes.push_back(static_cast<std::uint8_t>(byte & 0xFF));
        const unsigned sum = crc(bytes);
        bytes.push_back(static_cast<std::uint8_t>(sum & 0xFF));
        bytes.push_back(static_cast<std::uint8_t>(sum >> 8));
        if (damages) bytes[bytes.size() / 2] ^= 0x10;
        bytes.push_back('\r');
        bytes.push_back('\n');
        if (!silent) out.insert(out.end(), bytes.begin(), bytes.end());
    }
    void refuse(int error) {
        if (oldFirmware) {
            for (const char c : std::string("N\r\n"))
                out.push_back(static_cast<std::uint8_t>(c));
        } else {
            say("E", {error});
        }
    }
    bool takesPowers() const { return serial != std::string(8, '\0') && type != 'D'; }
    /// Milliamperes that flow in a steady mode.
    double milliamperes() const { return current * mostHundredths / 100.0 / 4095.0; }

    void hear(const std::vector<std::uint8_t>& message) {
        const auto at = [&](std::size_t i) { return static_cast<int>(message[i]); };
        const auto i16 = [&](std::size_t i) {
            return static_cast<int>(static_cast<std::int16_t>(at(i) << 8 | at(i + 1)));
        };
        const std::string name(message.begin(),
                               message.begin() + static_cast<std::ptrdiff_t>(std::min<std::size_t>(4, message.size())));
        const auto begins = [&](const char* with) { return name.rfind(with, 0) == 0; };
        const auto hiLo = [](int value) { return std::vector<int>{value >> 8, value}; };
        if (begins("MMA")) return say("MMA", {mode});
        if (begins("MwDA")) return mode = 1, say("MDA");
        if (begins("MwSA")) return mode = 2, say("MSA");
        if (begins("MwCA")) {
            if (!takesPowers()) return refuse(type == 'D' ? 2 : 4);
            mode = 5;
            return say("MCA", {0, powerHigh >> 8, powerHigh, powerLow >> 8, powerLow});
        }
        if (begins("PwTA")) {
            if (!takesPowers()) return refuse(4);
            return say("PT", {0, powerHigh >> 8, powerHigh, powerLow >> 8, powerLow});
        }
        if (begins("PwDA")) {
            if (mode != 5) return refuse(2);
            power = i16(4);
            if (codesPerPower != 0) current = power * codesPerPower;
            return;
        }
        if (begins("PwFA")) {
            milliHertz =
                static_cast<std::uint32_t>(at(4)) << 24 | static_cast<std::uint32_t>(at(5) << 16 | at(6) << 8 | at(7));
            return;
        }
        if (begins("PwUA")) return void(swingHigh = i16(4));
        if (begins("PwLA")) return void(swingLow = i16(4));
        if (begins("PrFA"))
            return say("PFA", {static_cast<int>(milliHertz >> 24), static_cast<int>(milliHertz >> 16),
                               static_cast<int>(milliHertz >> 8), static_cast<int>(milliHertz)});
        if (begins("CrMA")) return say("CMA", hiLo(mostHundredths));
        if (begins("CrUA")) return say("CUA", hiLo(upper));
        if (begins("CrLA")) return say("CLA", hiLo(lower));
        if (begins("Aw")) {
            current = i16(2);
            currents.emplace_back(time.at, current);
            return;
        }
        if (begins("Ar")) return say("A", hiLo(current));
        if (begins("TCA")) return say("TCA", hiLo(temperature));
        if (begins("Sr"))
            return say("S", {static_cast<int>(status >> 24), static_cast<int>(status >> 16),
                             static_cast<int>(status >> 8), static_cast<int>(status)});
        if (begins("H")) return say("H", {type});
        if (begins("V")) return say("V", {1, 6, 0, 12, 0, 3});
        if (begins("X")) return say("X", std::vector<int>(serial.begin(), serial.end()));
        if (begins("Z") || begins("Cw") || begins("RESE")) ++eepromWrites;
        refuse(3);
    }
    void receive(std::span<const std::uint8_t> data) {
        in.assign(data.begin(), data.end());
        if (std::string(in.begin(), in.end()) == "Start") {
            ++starts;
            current = 0;
            for (const char c : std::string("Ready\r\n"))
                out.push_back(static_cast<std::uint8_t>(c));
            return;
        }
        if (in.size() < 3 || crc(in) != 0) return refuse(1);
        in.resize(in.size() - 2);
        hear(in);
    }
};

/// The line to it. An empty receive costs the time limit, like the real one.
class FakeLine final : public SerialLink {
public:
    explicit FakeLine(FakeDriver& device) : device_(device) {}
    const std::string& name() const override { return name_; }
    Result<void> send(std::span<const std::uint8_t> data, Milliseconds) override {
        if (device_.failing()) return fail(Fault::device, "the line failed");
        device_.time.at += std::chrono::milliseconds(1);
        device_.receive(data);
        return {};
    }
    Result<Bytes> receive(std::size_t most, Milliseconds limit) override {
        if (device_.failing()) return fail(Fault::device, "the line failed");
        if (device_.out.empty()) {
            device_.time.at += limit;
            return Bytes();
        }
        // In dribs and drabs, as USB delivers.
        Bytes bytes;
        while (!device_.out.empty() && bytes.size() < std::min<std::size_t>(most, 3)) {
            bytes.push_back(device_.out.front());
            device_.out.pop_front();
        }
        return bytes;
    }

private:
    FakeDriver& device_;
    std::string name_ = "/dev/ttyACM7";
};

}  // namespace ilf::devices::test
