// Where in its sweep an output stands, and what volts mean in dioptres: laws.
#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "devices/measure/echo_place.h"
#include "devices/measure/power_scale.h"
#include "tests/support/law.h"

using namespace ilf;
using namespace ilf::devices;

TEST_CASE("law: a wave heard wherever in its sweep is placed to a hundredth of a sample") {
    law("echo", [] {
        const int frames = *rc::gen::inRange(100, 1601), heardAt = frames % 2 == 0 ? frames / 2 : frames;
        const auto share = [] { return *rc::gen::inRange(-1000, 1001) / 1000.0; };
        Harmonics told{{share(), {0.5 + 0.4 * share(), 0.3 * share()}, {0.2 * share(), 0.2 * share()}}};
        const double later = 0.49 * share(), first = share(), gain = 1.0 + 0.15 * share();
        std::vector<double> heard;
        for (int i = 0; i < heardAt; ++i) {
            const double x = first + static_cast<double>(i) / heardAt + later - 0.5 / frames;
            heard.push_back(0.3 + gain * told.at(x));
        }
        const auto place = echoPlace(heard, first, told, frames);
        RC_ASSERT(place.has_value());
        const double off = place->later - later;
        RC_ASSERT(std::abs(off - std::round(off)) * frames < 0.01);
        RC_ASSERT(std::abs(place->gain - gain) < 1e-6);
    });
}

TEST_CASE("another wave, half of it and none are not taken for the echo; a still drive asks for none") {
    const Harmonics told{{0.0, {0.0, -1.0}}};
    const auto heard = [](double amplitude, double periods) {
        std::vector<double> volts;
        for (int i = 0; i < 400; ++i)
            volts.push_back(amplitude * std::sin(2.0 * std::numbers::pi * periods * i / 400.0));
        return volts;
    };
    CHECK(echoPlace(heard(1.0, 1.0), 0.0, told, 800.0));
    CHECK_FALSE(echoPlace(heard(0.5, 1.0), 0.0, told, 800.0));
    CHECK_FALSE(echoPlace(heard(1.0, 2.0), 0.0, told, 800.0));
    CHECK_FALSE(echoPlace(heard(0.0, 1.0), 0.0, told, 800.0));
    const auto still = echoPlace(heard(0.0, 1.0), 0.0, Harmonics{{0.4}}, 800.0);
    REQUIRE(still);
    CHECK(still->gain == 0.0);
}

TEST_CASE("law: light that goes with the inverse of the beam's area is read back in dioptres") {
    law("power scale", [] {
        const auto share = [] { return *rc::gen::inRange(0, 1001) / 1000.0; };
        const double behind_m = 0.004 + 0.05 * share(), dark_V = 0.1 * share(), bright_V = 0.5 + 3.0 * share();
        const auto volts = [&](double power_D) {
            const double radius = 1.0 - behind_m * power_D;
            return dark_V + bright_V / (radius * radius);
        };
        std::vector<VoltsAtPower> known;
        const int count = *rc::gen::inRange(2, 9);
        for (int i = 0; i < count; ++i)
            known.push_back({volts(-4.0 + 12.0 * i / (count - 1)), -4.0 + 12.0 * i / (count - 1)});
        const auto scale = powerScale(known, dark_V);
        RC_ASSERT(scale.has_value());
        RC_ASSERT(scale->largestMiss_D < 1e-6);
        for (double power_D = -4.0; power_D <= 8.0; power_D += 0.37)
            RC_ASSERT(std::abs(scale->powerAt(volts(power_D)) - power_D) < 1e-6);
        RC_ASSERT(std::isnan(scale->powerAt(dark_V)));
    });
}

TEST_CASE("known powers that light contradicts make no scale") {
    const VoltsAtPower one[] = {{1.0, 0.0}};
    CHECK_FALSE(powerScale(one, 0.0));
    const VoltsAtPower dark[] = {{0.1, 0.0}, {0.2, 1.0}};
    CHECK_FALSE(powerScale(dark, 0.15));
    const VoltsAtPower bent[] = {{1.0, 0.0}, {2.0, 1.0}, {1.5, 2.0}};
    CHECK_FALSE(powerScale(bent, 0.0));
    const VoltsAtPower twice[] = {{1.0, 0.0}, {2.0, 1.0}, {3.0, 1.0}};
    CHECK_FALSE(powerScale(twice, 0.0));
}
