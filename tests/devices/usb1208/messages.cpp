#include "devices/usb1208/messages.h"

#include <doctest/doctest.h>

#include <cmath>
#include <cstring>
#include <string>

#include "tests/support/fuzz.h"
#include "tests/support/law.h"

namespace ilf::devices::usb1208 {

TEST_CASE("USB-1208FS-Plus messages: the requests are those of the reference, byte by byte") {
    CHECK(setOutput(1, 0x0800) == VendorRequest{0x18, 0x0800, 1});
    CHECK(setOutput(0, 4095) == VendorRequest{0x18, 0x0FFF, 0});
    CHECK(outputScan() == Bytes{0x00, 0x00, 0x00, 0x00, 0xE1, 0x04, 0x00, 0x00, 0x03});
    CHECK(inputScan(0x01) == Bytes{0, 0, 0, 0, 0, 0, 0, 0, 0xE1, 0x04, 0, 0, 0x01, 0x00});
    CHECK(inputRanges() == Bytes(8, 0));
    CHECK(kStartOutput.request == 0x1A);
    CHECK(kStopOutput.request == 0x1B);
    CHECK(kClearOutput.request == 0x1C);
    CHECK(kReadStatus.request == 0x44);
    for (const auto& request : {setOutput(0, 0), kStartOutput, kStopOutput, kClearOutput, kReadOutputs, kReadStatus,
                                kStartInput, kStopInput, kConfigureInput, kClearInput, kReadInputCalibration})
        CHECK((request.words.starts_with("told ") || request.words.starts_with("asked ")));
}

TEST_CASE("USB-1208FS-Plus messages: at 48 kS/s a sweep of 60 Hz has exactly 800 samples") {
    CHECK(kSampleRateHz == 48000.0);
    CHECK(*samplesPerSweep(60.0_Hz) == 800);
    CHECK(*samplesPerSweep(50.0_Hz) == 960);
    CHECK(*samplesPerSweep(120.0_Hz) == 400);
}

TEST_CASE("USB-1208FS-Plus messages: rates between whole samples are refused with the one to set") {
    const auto refused = samplesPerSweep(59.94_Hz);
    CHECK(refused.error().fault == Fault::unsupported);
    CHECK(refused.error().what ==
          "The DAC plays a whole number of samples in each sweep and cannot play 59.940 Hz. Set projector and rig to "
          "60.000 Hz.");
    CHECK(samplesPerSweep(0.0_Hz).error().fault == Fault::outOfRange);
    CHECK(samplesPerSweep(Hertz::fromSi(std::nan(""))).error().fault == Fault::outOfRange);
    CHECK(samplesPerSweep(Hertz::fromSi(1e9)).error().fault == Fault::outOfRange);
}

TEST_CASE("USB-1208FS-Plus messages: status bits mean what the vendor's library says") {
    CHECK(*statusFrom(Bytes{0x00, 0x00}) == Status{});
    CHECK(*statusFrom(Bytes{0x02, 0x00}) == Status{true, false, false, false});
    CHECK(*statusFrom(Bytes{0x04, 0x00}) == Status{false, true, false, false});
    CHECK(*statusFrom(Bytes{0x08, 0x00}) == Status{false, false, true, false});
    CHECK(*statusFrom(Bytes{0x18, 0x00}) == Status{false, false, true, true});
    CHECK(statusFrom(Bytes{0x18}).error().fault == Fault::badFile);
    CHECK(statusFrom(Bytes{}).error().fault == Fault::badFile);
    CHECK(outputsFrom(Bytes{0x00, 0x08, 0xFF, 0x0F})->at(1) == 4095);
    CHECK_FALSE(outputsFrom(Bytes{0x00, 0x08, 0xFF}));
}

TEST_CASE("USB-1208FS-Plus messages: 0 to 5 V in 12 bits, clamped") {
    CHECK(outputCode(Volt::fromSi(0.0)) == 0);
    CHECK(outputCode(Volt::fromSi(2.5)) == 2048);
    CHECK(outputCode(Volt::fromSi(5.0)) == 4095);
    CHECK(outputCode(Volt::fromSi(-3.0)) == 0);
    CHECK(outputCode(Volt::fromSi(99.0)) == 4095);
    CHECK(outputCode(Volt::fromSi(std::nan(""))) == 0);
    Bytes two(2);
    putSample(two, 0x0ABC);
    CHECK(two == Bytes{0xBC, 0x0A});
    CHECK(sampleAt(two) == 0x0ABC);
    law("a voltage and its code agree to half a step", [] {
        const double volts = *rc::gen::inRange(0, 4998) * 1e-3;
        RC_ASSERT(std::abs(outputVolts(outputCode(Volt::fromSi(volts))).si() - volts) <= 2.5 / 4096 + 1e-12);
    });
}

TEST_CASE("USB-1208FS-Plus messages: an input's calibration is used if a factory can have written it") {
    Bytes memory(64);
    for (std::size_t i = 0; i < 8; ++i) {
        const float slope = 1.01F, offset = -3.0F;
        std::memcpy(memory.data() + 8 * i, &slope, 4);
        std::memcpy(memory.data() + 8 * i + 4, &offset, 4);
    }
    const auto all = inputCalibrationsFrom(memory);
    CHECK(all.factory);
    CHECK(inputVolts(2048, all.channels[3]).si() == doctest::Approx((2048 * 1.01 - 3.0 - 2048.0) * 10.0 / 2048.0));
    CHECK(inputVolts(2048, {}).si() == 0.0);
    CHECK(inputVolts(0, {}).si() == -10.0);

    for (const Bytes& bad : {Bytes(64, 0x00), Bytes(64, 0xFF), Bytes(63, 0x3F), Bytes()}) {
        const auto nominal = inputCalibrationsFrom(bad);
        CHECK_FALSE(nominal.factory);
        CHECK(nominal.channels[0] == InputCalibration{});
    }
}

TEST_CASE("USB-1208FS-Plus messages: random bytes crash no decoder") {
    law("any bytes", [] {
        const auto length = *rc::gen::inRange<std::size_t>(0, 70);
        const Bytes data = *rc::gen::container<Bytes>(length, rc::gen::arbitrary<std::uint8_t>());
        statusFrom(data);
        outputsFrom(data);
        for (const auto& one : inputCalibrationsFrom(data).channels)
            RC_ASSERT(std::isfinite(one.slope + one.offset));
    });
    for (Fuzz fuzz; fuzz.goesOn();) {
        const Bytes data = fuzz.bytes(70);
        statusFrom(data);
        outputsFrom(data);
        for (const auto& one : inputCalibrationsFrom(data).channels)
            REQUIRE(std::isfinite(one.slope + one.offset));
    }
}

}  // namespace ilf::devices::usb1208
