// A lens moved sample by sample, against what the same lens does when it is told whole waves.
#include "devices/emulated_rig/sampled_lens.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/support/law.h"

using namespace ilf;
using namespace ilf::devices;

namespace {

constexpr std::int64_t kSecond_ns = 1'000'000'000;

std::int64_t sampleNs(int index) { return std::llround(1e9 * index / 48000.0); }

}  // namespace

TEST_CASE("sampled lens: without current it rests where its table has it, and time alone moves nothing") {
    SampledLens lens(LensPreset::datasheet, 0);
    const Dioptre rest = lens.power();
    CHECK(rest.si() == doctest::Approx(0.51).epsilon(1e-6));  // the published table at 0 mA, 30 C
    lens.advance(3600 * kSecond_ns);
    CHECK(std::abs((lens.power() - rest).si()) < 1e-9);
    const auto powers = lens.powers(3599 * kSecond_ns, 3600 * kSecond_ns, 10);
    CHECK(powers.size() == 10);
    CHECK(powers.front() == lens.power());
}

TEST_CASE("sampled lens: a sine of samples gives the powers of the same sine played by the lens's own driver") {
    for (const LensPreset preset : {LensPreset::slow, LensPreset::datasheet, LensPreset::clean}) {
        CAPTURE(word(preset));
        constexpr double kAmperes = 0.12, kRate_Hz = 60.0;
        SampledLens sampled(preset, 0);
        LensParameters parameters = lensParameters(preset);
        parameters.dacRate_Hz = 48000.0;
        parameters.dacStep_V = 0.0;
        LensEmulator whole(parameters);
        // Real parts of c e^(2 pi i x): a cosine.
        whole.play({{0.0, kAmperes / parameters.amplifier_A_per_V}}, Hertz::fromSi(kRate_Hz));
        double worst = 0.0;
        for (int i = 0; i < 24000; ++i) {
            const double x = kRate_Hz * i / 48000.0;
            sampled.drive(sampleNs(i), Ampere::fromSi(kAmperes * std::cos(2.0 * std::numbers::pi * x)));
            if (i % 100 == 0 && i > 0) {
                whole.advance(Second::fromSi(100.0 / 48000.0));
                worst = std::max(worst, std::abs((sampled.power() - whole.power()).si()));
            }
        }
        CHECK(worst < 2e-3);  // the two round their steps' times differently
        const auto sweep = sampled.powers(sampleNs(23200), sampleNs(24000), 240);
        const auto [low, high] = std::ranges::minmax(sweep);
        CHECK(high - low > 3.0_D);
        CHECK(sampled.most(sampleNs(23200), sampleNs(24000)).si() == doctest::Approx(kAmperes).epsilon(1e-6));
    }
}

TEST_CASE("sampled lens: it comes to rest where a held current has it, however it got there") {
    law("settles at the static power of the last current", [] {
        const double current = *rc::gen::inRange(-250, 251) * 1e-3;
        SampledLens swung(LensPreset::datasheet, 0), still(LensPreset::datasheet, 0);
        const int samples = *rc::gen::inRange(0, 2000);
        for (int i = 0; i < samples; ++i)
            swung.drive(sampleNs(i), Ampere::fromSi(0.25 * std::sin(0.01 * i)));
        swung.drive(sampleNs(samples), Ampere::fromSi(current));
        still.drive(sampleNs(samples), Ampere::fromSi(current));
        swung.advance(kSecond_ns / 2);
        still.advance(kSecond_ns / 2);
        // What is left is the warmth of the way there.
        RC_ASSERT(std::abs((swung.power() - still.power()).si()) < 0.02);
        const auto lately = still.powers(kSecond_ns / 2 - 1000, kSecond_ns / 2, 3);
        RC_ASSERT(std::abs((lately.back() - still.power()).si()) < 1e-3);
    });
}

TEST_CASE("sampled lens: a warmer lens has another power, and says so") {
    SampledLens lens(LensPreset::datasheet, 0);
    const Dioptre cold = lens.power();
    lens.warmer(20.0);
    lens.advance(kSecond_ns);
    CHECK(lens.temperature_C() == doctest::Approx(50.0).epsilon(0.001));
    CHECK((lens.power() - cold).si() == doctest::Approx(0.68).epsilon(0.01));  // 0.034 D a degree at 0 mA
    lens.drive(2 * kSecond_ns, Ampere::fromSi(std::nan("")));
    CHECK(isFinite(lens.power()));
}
