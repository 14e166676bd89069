#include "devices/usb1208/amplifier.h"

#include <doctest/doctest.h>

#include <cmath>

#include "tests/support/law.h"

namespace ilf::devices {
namespace {

constexpr Second kStep = Second::fromSi(1.0 / 48000.0);
Ampere mA(double value) { return Ampere::fromSi(value * 1e-3); }

}  // namespace

TEST_CASE("amplifier: volts at the DAC, volts at its input and milliamperes as the profile says") {
    const Amplifier paper;
    CHECK(voltsFor(paper, Ampere()).si() == 2.5);
    CHECK(voltsFor(paper, mA(250.0)).si() == doctest::Approx(5.0));
    CHECK(voltsFor(paper, mA(-250.0)).si() == doctest::Approx(0.0));
    CHECK(currentAt(paper, Volt::fromSi(3.5)).si() == doctest::Approx(0.1));
    // The paper's 0.07 V at the amplifier's input.
    CHECK(currentOf(paper, 0.07, DriveUnit::volt).si() == doctest::Approx(0.25));
    CHECK(currentOf(paper, 0.07, DriveUnit::ampere).si() == 0.07);
    CHECK(checked(paper, "left lens"));
}

TEST_CASE("amplifier: no current leaves its limit and no step its slope, whatever is asked") {
    law("limited", [] {
        Amplifier amplifier;
        amplifier.most = mA(*rc::gen::inRange(1, 251));
        amplifier.slew = AmperePerSecond::fromSi(*rc::gen::inRange(1, 5000));
        Ampere at;
        for (int i = 0; i < 50; ++i) {
            const int kind = *rc::gen::inRange(0, 12);
            const Ampere wanted = kind == 0   ? Ampere::fromSi(std::nan(""))
                                  : kind == 1 ? Ampere::fromSi(INFINITY)
                                              : mA(*rc::gen::inRange(-900, 900));
            const Ampere next = limited(amplifier, at, wanted, kStep);
            RC_ASSERT(abs(next) <= amplifier.most);
            RC_ASSERT(abs(next - at).si() <= amplifier.slew.si() * kStep.si() * (1.0 + 1e-9));
            at = next;
        }
    });
    CHECK(limited({}, mA(10.0), mA(11.0), kStep) == mA(11.0));
    CHECK(limited({}, Ampere(), mA(100.0), kStep).si() == doctest::Approx(1000.0 / 48000.0));
}

TEST_CASE("amplifier: profiles that cannot be are refused with what to correct") {
    const auto refusal = [](auto change) {
        Amplifier amplifier;
        change(amplifier);
        const auto result = checked(amplifier, "left lens");
        REQUIRE_FALSE(result);
        CHECK(result.error().fault == Fault::outOfRange);
        return result.error().what;
    };
    CHECK(refusal([](Amplifier& a) { a.most = mA(300.0); }) ==
          "The amplifier of the left lens needs more than the 0 to 5 V of the DAC for its greatest current. Correct it "
          "in "
          "the rig.");
    refusal([](Amplifier& a) { a.dac = VoltPerAmpere(); });
    refusal([](Amplifier& a) { a.input = VoltPerAmpere(); });
    refusal([](Amplifier& a) { a.most = Ampere(); });
    refusal([](Amplifier& a) { a.slew = AmperePerSecond(); });
    refusal([](Amplifier& a) { a.zero = Volt::fromSi(std::nan("")); });
}

}  // namespace ilf::devices
