// Numbers with units: what can be typed, and that what is shown can be typed again.
#include <doctest/doctest.h>

#include <cmath>

#include "tests/support/law.h"
#include "ui/units.h"

using namespace ilf;
using namespace ilf::ui;

TEST_CASE("units: a distance is typed in metres, centimetres, millimetres or dioptres") {
    CHECK(*parsed("0.5", Unit::metre) == 0.5);
    CHECK(*parsed("50 cm", Unit::metre) == 0.5);
    CHECK(*parsed("70 cm", Unit::metre) == 0.7);
    CHECK(*parsed("500mm", Unit::metre) == doctest::Approx(0.5));
    CHECK(*parsed("2 dpt", Unit::metre) == 0.5);
    CHECK(*parsed("2 D", Unit::metre) == 0.5);
    CHECK(*parsed("1,5 m", Unit::metre) == 1.5);
    CHECK(*parsed("  +1.5m  ", Unit::metre) == 1.5);
}

TEST_CASE("units: a bare number means the unit of its field") {
    CHECK(*parsed("4", Unit::millimetre) == doctest::Approx(4e-3));
    CHECK(*parsed("2", Unit::dioptre) == 2.0);
    CHECK(*parsed("0.5 m", Unit::dioptre) == 2.0);
    CHECK(*parsed("0.46", Unit::millisecond) == doctest::Approx(0.46e-3));
    CHECK(*parsed("80", Unit::percent) == doctest::Approx(0.8));
    CHECK(*parsed("0.96 kHz", Unit::hertz) == doctest::Approx(960.0));
    CHECK(*parsed("60 deg", Unit::degree) == 60.0);
}

TEST_CASE("units: a refusal says what was typed and what could be") {
    CHECK(parsed("near", Unit::metre).error().what ==
          "\"near\" is not a number. Type a number such as 0.5, 50 cm, 500 mm or 2 dpt.");
    CHECK(parsed("3 apples", Unit::metre).error().what ==
          "\"apples\" is not a unit of this field. Type a number such as 0.5, 50 cm, 500 mm or 2 dpt.");
    CHECK_FALSE(parsed("", Unit::metre));
    CHECK_FALSE(parsed("nan", Unit::metre));
    CHECK_FALSE(parsed("inf", Unit::metre));
    CHECK_FALSE(parsed("0 dpt", Unit::metre));
    CHECK_FALSE(parsed("1e999", Unit::metre));
    CHECK_FALSE(parsed("1.5.2", Unit::metre));
    CHECK(parsedWithin("20 km", Unit::metre, 0.05, 1000.0).error().what ==
          "\"20 km\" is outside what this field takes: 50.0 mm to 1000.0 m.");
}

TEST_CASE("units: what a field shows can be typed again and means the same, to the digits shown") {
    for (const Unit unit : {Unit::metre, Unit::millimetre, Unit::dioptre, Unit::degree, Unit::hertz, Unit::millisecond,
                            Unit::year, Unit::pixel, Unit::percent, Unit::number}) {
        law("formatted, parsed and formatted again is the same text", [unit] {
            const double value = std::pow(10.0, *rc::gen::inRange(-4000, 2000) / 1000.0);
            const std::string text = formatted(value, unit);
            const auto back = parsed(text, unit);
            RC_ASSERT(back.has_value());
            RC_ASSERT(formatted(*back, unit) == text);
        });
    }
}

TEST_CASE("units: parsing any text gives a number or a sentence") {
    law("never crashes", [](const std::string& text) {
        const auto result = parsed(text, Unit::metre);
        return result.has_value() ? std::isfinite(*result) : !result.error().what.empty();
    });
}
