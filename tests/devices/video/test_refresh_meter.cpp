#include "devices/video/refresh_meter.h"

#include <cmath>

#include "tests/support/law.h"

namespace ilf::devices {
namespace {

std::chrono::nanoseconds ns(double seconds) { return std::chrono::nanoseconds(std::llround(seconds * 1e9)); }

/// The first swaps, directly one after the other; each told late by up to `jitter`.
RefreshMeter measured(double rate, Hertz nominal, double jitter_s, std::uint32_t seed, bool counted) {
    RefreshMeter meter(nominal);
    for (int i = 0; i < RefreshMeter::kFirstSwaps; ++i) {
        seed = seed * 1664525U + 1013904223U;
        const double late_s = jitter_s * (seed >> 8U) / 16777216.0;
        meter.saw(ns(100 + i / rate + late_s), counted ? std::optional<std::int64_t>(i + 7) : std::nullopt);
    }
    return meter;
}

TEST_CASE("59.94 is told from 60 Hz, although the system is late by 0.2 ms now and then") {
    law("of rates, delays and seeds", [](std::uint32_t seed, bool counted) {
        const double rate = *rc::gen::element(59.94, 60.0, 60.001, 119.88, 50.0);
        const auto meter = measured(rate, Hertz::fromSi(std::round(rate)), 0.2e-3, seed, counted);
        RC_ASSERT(meter.rate() > 0.0_Hz);
        RC_ASSERT(std::abs(meter.rate().si() / rate - 1) < 400e-6);
    });
}

TEST_CASE("times nobody can make sense of give no rate") {
    CHECK(measured(60, 60.0_Hz, 12e-3, 5, false).rate() == 0.0_Hz);
}

TEST_CASE("swaps that do not wait for the display are no measurement, and never become one") {
    auto meter = measured(200, 60.0_Hz, 0, 1, false);  // a swap takes 5 ms in software
    CHECK(!meter.waits());
    for (int i = 0; i < 100; ++i)
        meter.saw(ns(200 + i / 60.0), {});  // somebody shows a picture sixty times a second
    CHECK(meter.rate() == 0.0_Hz);
    CHECK(measured(60, 0.0_Hz, 0, 1, false).rate() == 0.0_Hz);  // the server names no rate
}

TEST_CASE("later pictures sharpen the rate, however seldom they come") {
    auto meter = measured(59.94, 60.0_Hz, 0.2e-3, 3, false);
    double at_s = 100 + RefreshMeter::kFirstSwaps / 59.94;
    for (int i = 1; i < 60; ++i) {
        at_s += std::round(59.94 * (i % 5 == 0 ? 600 : 1.5)) / 59.94;
        meter.saw(ns(at_s), {});
    }
    CHECK(std::abs(meter.rate().si() / 59.94 - 1) < 50e-6);
}

}  // namespace
}  // namespace ilf::devices
