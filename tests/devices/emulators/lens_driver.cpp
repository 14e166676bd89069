// The emulated lens driver against the published test vectors and coding (devices.md 2.1).
#include <doctest/doctest.h>

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "devices/emulators/lens_driver.h"
#include "tests/support/law.h"

using namespace ilf::devices::emulators;
using Mode = EmulatedLensDriver::Mode;

namespace {

constexpr std::int64_t kSecond = 1'000'000'000;

struct Host {
    EmulatedLensDriver driver;
    std::int64_t now = 9 * kSecond;

    explicit Host(LensDriverOptions options = {}) : driver(options) {}
    Bytes send(const Bytes& bytes) { return driver.receive(bytes, now).reply; }
};

Bytes text(const std::string& letters) { return Bytes(letters.begin(), letters.end()); }

/// With the checksum, worked out the slow way: the remainder of a division by x^16 + x^15 + x^2 + 1, bits reversed.
Bytes sealed(Bytes bytes) {
    unsigned remainder = 0;
    for (std::size_t bit = 0; bit < 8 * (bytes.size() + 2); ++bit) {
        const std::size_t at = bit / 8;
        const unsigned next = at < bytes.size() ? unsigned(bytes[at] >> (bit % 8)) & 1U : 0U;
        const unsigned out = remainder >> 15U & 1U;
        remainder = (remainder << 1U | next) & 0xFFFFU;
        if (out != 0) remainder ^= 0x8005U;
    }
    unsigned reversed = 0;
    for (unsigned bit = 0; bit < 16; ++bit)
        reversed |= (remainder >> bit & 1U) << (15U - bit);
    bytes.push_back(std::uint8_t(reversed));
    bytes.push_back(std::uint8_t(reversed >> 8U));
    return bytes;
}
Bytes sealed(const std::string& letters, const Bytes& data = {}) {
    Bytes bytes = text(letters);
    bytes.insert(bytes.end(), data.begin(), data.end());
    return sealed(bytes);
}
/// As it comes back.
Bytes line(const std::string& letters, const Bytes& data = {}) {
    Bytes bytes = sealed(letters, data);
    bytes.push_back('\r');
    bytes.push_back('\n');
    return bytes;
}
int word(const Bytes& bytes, std::size_t at) { return std::int16_t(bytes.at(at) << 8 | bytes.at(at + 1)); }

}  // namespace

TEST_CASE("lens driver: every published test vector is understood") {
    Host host;
    CHECK(host.send(text("Start")) == text("Ready\r\n"));
    CHECK(host.send({0x41, 0x77, 0x05, 0x7A, 0x26, 0x95}).empty());
    CHECK(host.driver.current_mA(host.now) == doctest::Approx(1402.0 / 4095.0 * 292.84));  // 05 7A
    CHECK(host.send({0x41, 0x77, 0x00, 0x00, 0xA4, 0x26}).empty());
    CHECK(host.driver.current_mA(host.now) == 0.0);
    CHECK(host.send({0x4D, 0x77, 0x53, 0x41, 0x5B, 0xB6}) == line("MSA"));
    CHECK(host.driver.mode() == Mode::sine);
    CHECK(host.send({0x4D, 0x77, 0x44, 0x41, 0x54, 0x46}) == line("MDA"));
    CHECK(host.driver.mode() == Mode::current);
    CHECK(host.send({0x50, 0x77, 0x46, 0x41, 0x00, 0x00, 0xEA, 0x60, 0x7F, 0xDA}).empty());
    CHECK(host.send(sealed("PrFA", Bytes(4))) == line("PFA", {0, 0, 0xEA, 0x60}));
    CHECK(host.send({0x50, 0x77, 0x46, 0x41, 0x00, 0x01, 0x86, 0xA0, 0x03, 0x4A}).empty());
    CHECK(host.send(sealed("PrFA", Bytes(4))) == line("PFA", {0, 1, 0x86, 0xA0}));
    CHECK(host.send({0x50, 0x77, 0x55, 0x41, 0x05, 0x7A, 0x00, 0x00, 0x13, 0x24}).empty());
    CHECK(host.send({0x50, 0x77, 0x4C, 0x41, 0xFA, 0x86, 0x00, 0x00, 0xE1, 0x09}).empty());
    CHECK(host.send({0x50, 0x77, 0x44, 0x41, 0x03, 0xE8, 0x00, 0x00, 0xB1, 0x00}).empty());
    const Bytes focal = host.send({0x4D, 0x77, 0x43, 0x41, 0x56, 0x76});
    REQUIRE(focal.size() == 12);  // "MCA", status, greatest and least power, checksum, end of line
    CHECK(host.driver.mode() == Mode::focalPower);
    CHECK(host.driver.power_D(host.now) == doctest::Approx(5.0));  // code 1000 of type F
    CHECK(host.send({0x4D, 0x4D, 0x41, 0x65, 0x77}) == line("MMA", {5}));
    CHECK(host.send({0x4D, 0x4D, 0x41, 0x58, 0x6B}) == Bytes{0x45, 0x01, 0xF3, 0x50, 0x0D, 0x0A});  // as misprinted
    CHECK(host.send({0x54, 0x43, 0x41, 0xB0, 0xD0}) == line("TCA", {0x01, 0xE0}));                  // 30 degrees
    CHECK(host.send({0x53, 0x72, 0xBC, 0xD5}).size() == 9);
    CHECK(host.send({0x56, 0x80, 0x3E}).size() == 11);
    CHECK(host.send({0x43, 0x72, 0x4D, 0x41, 0x00, 0x00, 0x71, 0x80}) == line("CMA", {0x72, 0x64}));  // 292.84 mA
    CHECK_FALSE(host.driver.harmed());
    CHECK(host.driver.memoryWrites() == 0);
}

TEST_CASE("lens driver: bytes may come one by one and in heaps; half a message is given up after a while") {
    Host host;
    Bytes answers;
    Bytes all = text("Start");
    for (const Bytes& next : {sealed("Aw", {0x01, 0x00}), sealed("Ar", {0, 0}), sealed("MMA")})
        all.insert(all.end(), next.begin(), next.end());
    for (const std::uint8_t byte : all) {
        const Bytes reply = host.send({byte});
        answers.insert(answers.end(), reply.begin(), reply.end());
    }
    Host other;
    CHECK(answers == other.send(all));
    Bytes expected = text("Ready\r\n");
    for (const Bytes& next : {line("A", {0x01, 0x00}), line("MMA", {1})})
        expected.insert(expected.end(), next.begin(), next.end());
    CHECK(answers == expected);

    CHECK(host.send(text("MM")).empty());
    host.now += kSecond;
    CHECK(host.send(sealed("MMA")) == line("MMA", {1}));
}

TEST_CASE("lens driver: errors are told by number, by old firmware as N, and Start clears the current") {
    Host host;
    CHECK(host.send(text("?")) == line("E", {3}));
    Bytes broken = sealed("Aw", {0x0F, 0xFF});
    broken.back() ^= 1;
    CHECK(host.send(broken) == line("E", {1}));
    CHECK(host.driver.current_mA(host.now) == 0.0);
    host.send(sealed("Aw", {0x0F, 0xFF}));
    CHECK(host.driver.current_mA(host.now) == doctest::Approx(292.84));
    host.send(text("Start"));
    CHECK(host.driver.current_mA(host.now) == 0.0);

    LensDriverOptions typeD;
    typeD.firmwareType = 'D';
    Host plain(typeD);
    CHECK(plain.send(sealed("H")) == line("H", {'D'}));
    CHECK(plain.send(sealed("MwCA")) == line("E", {2}));
    LensDriverOptions unknownLens;
    unknownLens.hasLensMemory = false;
    Host bare(unknownLens);
    CHECK(bare.send(sealed("MwCA")) == line("E", {4}));
    CHECK(bare.send(sealed("X")) == line("X", Bytes(8)));
    LensDriverOptions aged;
    aged.oldFirmware = true;
    Host old(aged);
    CHECK(old.send(broken) == text("N\r\n"));
}

TEST_CASE("lens driver: types A and B-F code focal power differently") {
    for (const char type : {'A', 'B', 'C', 'E', 'F'}) {
        LensDriverOptions options;
        options.firmwareType = type;
        Host host(options);
        host.send(sealed("MwCA"));
        const int code = type == 'A' ? (2 + 5) * 200 : 2 * 200;
        CHECK(host.send(sealed("PwDA", {std::uint8_t(code >> 8), std::uint8_t(code), 0, 0})).empty());
        CAPTURE(type);
        CHECK(host.driver.power_D(host.now) == doctest::Approx(2.0).epsilon(1e-6));
        CHECK(word(host.send(sealed("PrDA", Bytes(4))), 3) == code);
    }
}

TEST_CASE("lens driver: its sine runs on its own crystal between the swing limits") {
    LensDriverOptions options;
    options.crystal_ppm = 50.0;
    Host host(options);
    host.send(sealed("PwUA", {0x08, 0x00, 0, 0}));
    host.send(sealed("PwLA", {0xFC, 0x00, 0, 0}));
    host.send(sealed("PwFA", {0, 0, 0xEA, 0x60}));
    host.send(sealed("MwSA"));
    const double upper = 2048 / 4095.0 * 292.84, lower = -1024 / 4095.0 * 292.84;
    double most = -1e9, least = 1e9;
    for (int i = 0; i < 1000; ++i) {
        const double current = host.driver.current_mA(host.now + i * 16'667);
        most = std::max(most, current);
        least = std::min(least, current);
    }
    CHECK(most == doctest::Approx(upper).epsilon(1e-4));
    CHECK(least == doctest::Approx(lower).epsilon(1e-4));
    // 50 ppm of 60 Hz are a quarter of a period after 83 s.
    const std::int64_t later = host.now + 83'333'333'333;
    CHECK(host.driver.current_mA(later) == doctest::Approx(upper).epsilon(1e-3));
    CHECK(host.driver.pinA(host.now + 1'000'000));
    CHECK_FALSE(host.driver.pinA(host.now + 9'000'000));
}

TEST_CASE("lens driver: current is clamped by its maximum and its software limits, which are written to memory") {
    Host host;
    host.send(sealed("CwMA", {0x27, 0x10}));  // 100 mA
    host.send(sealed("Aw", {0x7F, 0xFF}));
    CHECK(host.driver.current_mA(host.now) == doctest::Approx(100.0));
    host.send(sealed("CwUA", {0x02, 0xBB}));  // 699 of 4095: 49.99 mA
    CHECK(host.driver.current_mA(host.now) == doctest::Approx(699.0 / 4095.0 * 292.84));
    host.send(sealed("CwLA", {0xFD, 0x45}));
    host.send(sealed("Aw", {0x80, 0x00}));
    CHECK(host.driver.current_mA(host.now) == doctest::Approx(-699.0 / 4095.0 * 292.84));
    CHECK(host.send(sealed("CrLA", {0, 0})) == line("CLA", {0xFD, 0x45}));
    CHECK(host.driver.memoryWrites() == 3);
    host.driver.powerCycle(host.now);
    CHECK(host.send(sealed("CrMA", {0, 0})) == line("CMA", {0x27, 0x10}));
    CHECK(host.driver.current_mA(host.now) == 0.0);
}

TEST_CASE("lens driver: a warm lens drifts, focal power mode makes up for it, and limits are told in the status") {
    Host host;
    const auto lastStatus = [&] { return int(host.send(sealed("Sr"))[4]); };
    CHECK(lastStatus() == 4);  // no temperature limits yet
    host.send(sealed("Aw", {0x05, 0x7A}));
    const double cold = host.driver.power_D(host.now);
    host.now += 2000 * kSecond;
    CHECK(host.driver.temperature_C(host.now) ==
          doctest::Approx(30.0 + 25.0 * 12.5 * 0.0099975 * 0.99974).epsilon(1e-3));
    CHECK(host.driver.power_D(host.now) > cold + 0.05);

    host.driver.setAmbient(45.0, host.now);
    host.now += 2000 * kSecond;
    host.send(sealed("MwCA"));
    host.send(sealed("PwDA", {0x01, 0x90, 0, 0}));
    CHECK(host.driver.power_D(host.now) == doctest::Approx(2.0).epsilon(1e-6));
    const Bytes range = host.send(sealed("PwTA", {0x02, 0x80, 0x01, 0x40}));  // 40 and 20 degrees
    REQUIRE(range.size() == 11);
    CHECK(word(range, 3) > 2000);
    CHECK(word(range, 5) < -2000);
    CHECK(lastStatus() == 128);  // 45 degrees are outside
    host.send(sealed("PwDA", {0x7F, 0xFF, 0, 0}));
    CHECK(lastStatus() == 128 + 8);

    host.driver.setFaults({{.kind = Mishap::overTemperature, .amount = 60.0}});
    CHECK(word(host.send(sealed("TCA")), 3) * 0.0625 > 100.0);
    CHECK((lastStatus() & 32) == 32);
}

TEST_CASE("lens driver: faults strike, harmful commands are remembered") {
    Host host;
    host.driver.setFaults({{Mishap::nack, 0, 1}, {Mishap::silence, 1, 1}});
    CHECK(host.send(sealed("MMA")) == line("E", {1}));
    CHECK(host.send(sealed("MMA")).empty());
    CHECK(host.send(sealed("MMA")) == line("MMA", {1}));
    host.driver.setFaults({{Mishap::stall, 0, 1}});
    CHECK(host.send(sealed("MMA")).size() == line("MMA", {1}).size() - 1);
    host.send(sealed("MwSA"));
    host.driver.setFaults({{Mishap::wrongMode, 0, 1}});
    CHECK(host.send(sealed("MMA")) == line("MMA", {1}));
    host.driver.setFaults({{Mishap::unplug, 7}});
    CHECK_FALSE(host.driver.receive(sealed("MMA"), host.now).gone);
    CHECK(host.driver.receive(sealed("MMA"), host.now).gone);
    host.driver.setFaults({});
    CHECK(host.send(sealed("RESET")).empty());
    CHECK(host.driver.harmed());
    CHECK(host.send(sealed("MMA")).empty());
}

TEST_CASE("lens driver: random bytes, and every truncation of a message, neither crash nor hang it") {
    ilf::law("any bytes", [](const std::vector<Bytes>& heaps, bool tail) {
        Host host;
        for (const Bytes& heap : heaps)
            host.send(tail ? sealed(heap) : heap);
        RC_ASSERT(std::abs(host.driver.current_mA(host.now)) <= 292.84);
        host.now += kSecond;
        RC_ASSERT(host.driver.harmed() || host.send(text("Start")) == text("Ready\r\n"));
    });
    const std::vector<Bytes> messages = {text("Start"), sealed("Aw", {1, 2}), sealed("PwFA", {0, 0, 0xEA, 0x60}),
                                         sealed("IR", Bytes(8)), sealed("RESET")};
    for (const Bytes& message : messages)
        for (std::size_t length = 0; length < message.size(); ++length) {
            Host host;
            CHECK(host.send(Bytes(message.begin(), message.begin() + std::ptrdiff_t(length))).empty());
            CHECK(host.driver.current_mA(host.now) == 0.0);
            host.now += kSecond;
            CHECK(host.send(text("Start")) == text("Ready\r\n"));
        }
    ilf::law("a message with one bit wrong changes nothing", [](std::uint16_t code) {
        const Bytes good = sealed("Aw", {std::uint8_t(code >> 8), std::uint8_t(code)});
        for (std::size_t bit = 16; bit < 8 * good.size(); ++bit) {
            Bytes bad = good;
            bad[bit / 8] = std::uint8_t(bad[bit / 8] ^ 1U << (bit % 8));
            Host host;
            RC_ASSERT(host.send(bad) == line("E", {1}));
            RC_ASSERT(host.driver.current_mA(host.now) == 0.0);
        }
    });
}
