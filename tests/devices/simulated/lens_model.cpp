#include "devices/simulated/lens_model.h"

#include "tests/support/law.h"

namespace ilf::devices {
namespace {

Waveform anyWave() {
    const auto low = Dioptre::fromSi(*rc::gen::inRange(-100, 100) / 20.0);
    const auto high = low + Dioptre::fromSi(*rc::gen::inRange(0, 100) / 20.0);
    return idealSine(0.0_D, low, high, 60.0_Hz, Second::fromSi(*rc::gen::inRange(0, 16) / 1000.0));
}

}  // namespace

TEST_CASE("lens: the error bound holds, and falls to the budget when it says so") {
    law("|power - wave| <= errorAt, errorAt(settled) <= budget", [] {
        auto lens = LensModel().told(anyWave(), 0).told(anyWave(), *rc::gen::inRange(0, 50) * 1'000'000);
        const std::int64_t start = lens.startedNs();
        for (int i = 0; i < 100; ++i) {
            const std::int64_t now = start + i * 700'000;
            const auto told = lens.wave().powerAt(Second::fromSi(double(now - start) * 1e-9));
            RC_ASSERT(abs(lens.powerAt(now) - told) <= lens.errorAt(now) + 1e-9_D);
        }
        RC_ASSERT(lens.errorAt(lens.settledNs(0.05_D)) <= 0.05_D);
    });
}

TEST_CASE("lens: a step of 2 D is within 5 percent after the data sheet's 25 ms") {
    const auto lens = LensModel().told(stillWave(0.0_D, 2.0_D, 60.0_Hz), 0);
    CHECK(lens.powerAt(0).si() == doctest::Approx(0.0));
    CHECK(lens.powerAt(25'000'000).si() == doctest::Approx(1.9).epsilon(0.005));
    CHECK(lens.settledNs(0.1_D) == doctest::Approx(24'864'000).epsilon(0.001));
}

TEST_CASE("lens: sweeps start every period after the order") {
    const auto lens = LensModel().told(idealSine(0.0_D, 0.0_D, 2.0_D, 50.0_Hz, 0.0_s), 1'000);
    CHECK(lens.nextSweepStartNs(0) == 1'000);
    CHECK(lens.nextSweepStartNs(1'000) == 1'000);
    CHECK(lens.nextSweepStartNs(1'001) == 20'001'000);
    CHECK(lens.nextSweepStartNs(20'001'000) == 20'001'000);
}

}  // namespace ilf::devices
