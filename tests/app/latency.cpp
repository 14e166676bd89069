#include "app/studio/latency.h"

#include <doctest/doctest.h>

using ilf::app::Latency;

TEST_CASE("latency: is from the stroke to the sweep that first shows it") {
    Latency latency;
    CHECK_FALSE(latency.last_ms());
    latency.sent(1, 1'000'000);
    latency.sent(2, 5'000'000);
    latency.played(1, 18'000'000);
    CHECK(*latency.last_ms() == doctest::Approx(17.0));
    latency.played(1, 40'000'000);  // still playing the same one
    CHECK(*latency.last_ms() == doctest::Approx(17.0));
    latency.played(2, 35'000'000);
    CHECK(*latency.last_ms() == doctest::Approx(30.0));
}

TEST_CASE("latency: a program that was dropped for a newer one does not count") {
    Latency latency;
    latency.sent(1, 1'000'000);
    latency.sent(2, 2'000'000);
    latency.played(2, 12'000'000);
    CHECK(*latency.last_ms() == doctest::Approx(10.0));
}
