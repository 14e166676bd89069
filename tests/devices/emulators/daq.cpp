// The emulated converter against the public protocol (devices.md 3.3): requests, FIFO, clock, status bits, currents.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "devices/emulators/daq.h"
#include "tests/support/law.h"

using namespace ilf::devices::emulators;

namespace {

constexpr std::int64_t kMs = 1'000'000;

struct Host {
    EmulatedDaq daq;
    std::int64_t now = 5'000 * kMs;

    bool request(int request, int value, int index, Bytes data = {}) {
        const ControlSetup setup{0x40, std::uint8_t(request), std::uint16_t(value), std::uint16_t(index),
                                 std::uint16_t(data.size())};
        return daq.control(setup, data, now).answer == UsbAnswer::done;
    }
    Bytes ask(int request, int value, int index, std::size_t length) {
        Bytes data(length);
        const ControlSetup setup{0xC0, std::uint8_t(request), std::uint16_t(value), std::uint16_t(index),
                                 std::uint16_t(length)};
        const UsbTransfer got = daq.control(setup, data, now);
        data.resize(got.answer == UsbAnswer::done ? got.bytes : 0);
        return data;
    }
    int status() {
        const Bytes word = ask(0x44, 0, 0, 2);
        return word.size() == 2 ? word[0] + 256 * word[1] : -1;
    }
    /// {u32 count, u32 pacer, u8 channels}
    bool startOutput(std::uint32_t count, std::uint32_t pacer, int channels) {
        Bytes data;
        for (const std::uint32_t number : {count, pacer})
            for (unsigned i = 0; i < 4; ++i)
                data.push_back(std::uint8_t(number >> (8 * i)));
        data.push_back(std::uint8_t(channels));
        return request(0x1A, 0, 0, data);
    }
};

Bytes frames(int count, int first = 0) {
    Bytes bytes;
    for (int i = first; i < first + count; ++i)
        for (const int code : {i % 4096, 4095 - i % 4096}) {
            bytes.push_back(std::uint8_t(code));
            bytes.push_back(std::uint8_t(code >> 8));
        }
    return bytes;
}

}  // namespace

TEST_CASE("daq: at 48 kS/s a sweep of 60 Hz is 800 samples, and the FIFO holds 42.7 ms") {
    Host host;
    CHECK(host.daq.out(0x02, frames(2048), host.now).answer == UsbAnswer::done);
    CHECK(host.daq.out(0x02, frames(1), host.now).answer == UsbAnswer::busy);
    CHECK(host.startOutput(0, 1249, 3));
    CHECK(host.status() == 0x0008);
    const std::int64_t start = host.now;
    host.now += 42 * kMs;
    CHECK(host.status() == 0x0008);
    host.now += 1 * kMs;
    CHECK(host.status() == 0x0018);  // starved, still running
    const std::vector<OutputSample> out = host.daq.takeOutput(host.now);
    REQUIRE(out.size() == 2048);
    CHECK(out[0].time_ns == start);
    CHECK(out[800].time_ns - out[0].time_ns == 16'666'667);
    CHECK(out[2047].codes == std::array<std::uint16_t, 2>{2047, 2048});
}

TEST_CASE("daq: it holds the last sample while starved and goes on with the next on its own beat") {
    Host host;
    host.daq.out(0x02, frames(10), host.now);
    const std::int64_t start = host.now;
    CHECK(host.startOutput(0, 1249, 3));
    host.now += 100 * kMs;
    CHECK(host.daq.outputs(host.now).codes[0] == 9);
    CHECK(host.daq.out(0x02, frames(5, 100), host.now).answer == UsbAnswer::done);
    host.now += 1 * kMs;
    const auto out = host.daq.takeOutput(host.now);
    REQUIRE(out.size() == 15);
    CHECK(out[10].codes[0] == 100);
    CHECK(out[10].time_ns > start + 100 * kMs);
    const double beats = double(out[10].time_ns - start) / (1250.0 * 1e9 / 60e6);
    CHECK(std::abs(beats - std::round(beats)) < 1e-3);
    CHECK(host.status() == 0x0018);
    // A new scan forgets that.
    CHECK(host.request(0x1B, 0, 0));
    CHECK(host.request(0x1C, 0, 0));
    host.daq.out(0x02, frames(10), host.now);
    CHECK(host.startOutput(10, 1249, 3));
    host.now += 10 * kMs;
    CHECK(host.status() == 0);  // ten samples and done
}

TEST_CASE("daq: currents are what the amplifier makes of the codes; at rest its relay is open") {
    Host host;
    CHECK(host.daq.current_mA(host.daq.outputs(host.now), 0) == 0.0);
    CHECK(host.request(0x18, 2048, 0));
    CHECK(host.request(0x18, 4095, 1));
    const OutputSample both = host.daq.outputs(host.now);
    CHECK(EmulatedDaq::volts(2048) == 2.5);
    CHECK(host.daq.current_mA(both, 0) == doctest::Approx(0.0));
    CHECK(host.daq.current_mA(both, 1) == doctest::Approx(249.878).epsilon(1e-5));
    host.daq.unplugged(host.now);
    CHECK(host.daq.current_mA(host.daq.outputs(host.now), 1) == 0.0);
    CHECK(host.daq.takeOutput(host.now).size() == 3);
}

TEST_CASE("daq: what is unknown or misshapen is refused") {
    Host host;
    CHECK_FALSE(host.request(0x99, 0, 0));
    CHECK_FALSE(host.request(0x18, 0, 2));
    CHECK_FALSE(host.request(0x1A, 0, 0, Bytes(8)));
    CHECK_FALSE(host.startOutput(0, 1249, 0));
    CHECK_FALSE(host.startOutput(0, 1249, 4));
    CHECK_FALSE(host.startOutput(0, 599, 3));  // 100 kS/s
    CHECK(host.startOutput(0, 1199, 1));       // 50 kS/s, the most
    CHECK_FALSE(host.startOutput(0, 1199, 1));
    CHECK_FALSE(host.request(0x18, 0, 0));  // not while a scan plays
    CHECK(host.ask(0x99, 0, 0, 2).empty());
    CHECK(host.daq.out(0x03, frames(1), host.now).answer == UsbAnswer::stall);
    CHECK(host.ask(0x30, 0, 0, 768).size() == 768);
    CHECK(host.ask(0x30, 768, 0, 8).empty());
    CHECK(host.request(0x41, 3, 0));
    CHECK(host.daq.blinks() == 1);
    CHECK(host.request(0x42, 0, 0));
    CHECK(host.daq.out(0x02, frames(1), host.now).answer == UsbAnswer::gone);
    host.now = *host.daq.backOnBusAt();
    CHECK(host.status() == 0);
}

TEST_CASE("daq: the analog input samples its channels in turn and stops where nobody fetches") {
    Host host;
    host.daq.setInput([](int channel, std::int64_t time_ns) { return channel == 0 ? 5.0 : double(time_ns % 10); });
    // {count, retrigger, pacer, channels, options}: 200 samples of channels 0 and 2, 40 kS/s together
    Bytes start = {200, 0, 0, 0, 0, 0, 0, 0, std::uint8_t(1499 & 255), 1499 >> 8, 0, 0, 0x05, 0};
    CHECK(host.request(0x14, 0, 0, Bytes(8)));
    CHECK_FALSE(host.request(0x11, 0, 0, Bytes(13)));
    CHECK(host.request(0x11, 0, 0, start));
    CHECK(host.status() == 0x0002);
    Bytes got(400);
    host.now += 2 * kMs;
    UsbTransfer first = host.daq.in(0x81, got, host.now);
    CHECK(first.answer == UsbAnswer::busy);
    CHECK(first.bytes % 64 == 0);  // whole packets while it runs
    host.now += 10 * kMs;
    const UsbTransfer rest = host.daq.in(0x81, std::span(got).subspan(first.bytes), host.now);
    CHECK(rest.answer == UsbAnswer::done);
    CHECK(first.bytes + rest.bytes == 400);
    CHECK(host.status() == 0);
    CHECK(got[0] + 256 * got[1] == 3072);  // 5 V of +-10 V
    CHECK(got[4] + 256 * got[5] == 3072);
    const Bytes once = host.ask(0x10, 0, 0, 2);
    REQUIRE(once.size() == 2);
    CHECK(once[0] + 256 * once[1] == 3072);

    start[0] = 0;  // for ever, and nobody fetches: 16 kB are 205 ms
    CHECK(host.request(0x11, 0, 0, start));
    host.now += 300 * kMs;
    CHECK(host.status() == 0x0004);
}

TEST_CASE("daq: faults strike: drift, a lost FIFO, a stall, a cable pulled at a byte") {
    Host host;
    host.daq.setFaults({{.kind = Mishap::clockDrift, .amount = 100.0}});
    host.daq.out(0x02, frames(1000), host.now);
    CHECK(host.startOutput(1000, 1249, 3));
    host.now += 30 * kMs;
    auto out = host.daq.takeOutput(host.now);
    CHECK(out[800].time_ns - out[0].time_ns == 16'668'333);

    Host starved;
    starved.daq.setFaults({{Mishap::underrun, 1, 1}});
    starved.daq.out(0x02, frames(100), starved.now);
    CHECK(starved.startOutput(0, 1249, 3));
    CHECK(starved.status() == 0x0008);
    starved.daq.out(0x02, frames(10), starved.now);
    CHECK(starved.status() == 0x0018);

    Host stalled;
    stalled.daq.setFaults({{Mishap::stall, 0, 1}});
    CHECK(stalled.daq.out(0x02, frames(1), stalled.now).answer == UsbAnswer::stall);
    CHECK(stalled.daq.out(0x02, frames(1), stalled.now).answer == UsbAnswer::stall);
    stalled.daq.clearHalt(0x02, stalled.now);
    CHECK(stalled.daq.out(0x02, frames(1), stalled.now).answer == UsbAnswer::done);

    Host pulled;
    pulled.daq.setFaults({{Mishap::unplug, 30}});
    const UsbTransfer cut = pulled.daq.out(0x02, frames(100), pulled.now);
    CHECK(cut.answer == UsbAnswer::gone);
    CHECK(cut.bytes == 30);
}

TEST_CASE("daq: random requests and data neither crash nor hang it, and no code has more than 12 bits") {
    struct Step {
        std::uint8_t what, request;
        std::uint16_t value, index;
        Bytes data;
    };
    const auto steps = rc::gen::container<std::vector<Step>>(rc::gen::construct<Step>(
        rc::gen::arbitrary<std::uint8_t>(),
        rc::gen::oneOf(rc::gen::arbitrary<std::uint8_t>(),
                       rc::gen::elementOf(std::vector<std::uint8_t>{0x11, 0x14, 0x18, 0x1A, 0x1B, 0x1C, 0x44})),
        rc::gen::arbitrary<std::uint16_t>(), rc::gen::inRange<std::uint16_t>(0, 3), rc::gen::arbitrary<Bytes>()));
    ilf::law("any requests", [&] {
        Host host;
        for (Step& step : *steps) {
            host.now += step.what * kMs / 8;
            if (step.request == 0x1A || step.request == 0x11) step.data.resize(step.request == 0x1A ? 9 : 14);
            if (step.what % 3 == 0) host.request(step.request, step.value, step.index, step.data);
            if (step.what % 3 == 1) host.ask(step.request, step.value, step.index, step.data.size());
            if (step.what % 3 == 2) host.daq.out(0x02, step.data, host.now);
            host.daq.in(0x81, step.data, host.now);
        }
        for (const OutputSample& sample : host.daq.takeOutput(host.now))
            RC_ASSERT(sample.codes[0] < 4096 && sample.codes[1] < 4096);
    });
    ilf::law("frames of any codes come out at their times, in order, none lost",
             [](const std::vector<std::uint16_t>& codes) {
                 Host host;
                 Bytes bytes;
                 for (const std::uint16_t code : codes) {
                     bytes.push_back(std::uint8_t(code));
                     bytes.push_back(std::uint8_t(code >> 8));
                 }
                 host.daq.out(0x02, bytes, host.now);
                 if (codes.empty()) return;
                 RC_ASSERT(host.startOutput(std::uint32_t(codes.size()), 1249, 2));
                 host.now += 100 * kMs;
                 const auto out = host.daq.takeOutput(host.now);
                 RC_ASSERT(out.size() == codes.size());
                 for (std::size_t i = 0; i < out.size(); ++i) {
                     RC_ASSERT(out[i].codes[1] == (codes[i] & 4095));
                     RC_ASSERT(std::abs(double(out[i].time_ns - out[0].time_ns) - double(i) * 1e9 / 48e3) <= 1.0);
                 }
             });
}
