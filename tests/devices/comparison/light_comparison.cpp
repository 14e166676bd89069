#include "devices/comparison/light_comparison.h"

#include <utility>

#include "tests/support/law.h"

using namespace ilf;
using namespace ilf::devices;

namespace {

constexpr Size kSize{16, 8};

Image<std::uint8_t> even(std::uint8_t value, Size size = kSize) {
    return {size, 1, std::vector<std::uint8_t>(static_cast<std::size_t>(size.width * size.height), value)};
}

/// Slots of 1 ms with light 10, 20, 30 ...
std::vector<SlotLight> sweep(int slots, Second late = 0.0_s) {
    std::vector<SlotLight> made;
    for (int i = 0; i < slots; ++i)
        made.push_back({even(static_cast<std::uint8_t>(10 * (i + 1))), double(i) * 1.0_ms + late, 1.0_ms});
    return made;
}

}  // namespace

TEST_CASE("light comparison: a sweep as intended, however late, has no differing pixel") {
    const auto found = compared(sweep(4), sweep(4, 0.25_ms));
    CHECK(found.same());
    CHECK(found.offset.in(1.0_ms) == doctest::Approx(0.25));
    CHECK(found.jitter.in(1.0_ms) == doctest::Approx(0.0));
    CHECK(verdict(found) == "4 slots as intended, 0 differing pixels, starts +0.25 ms (+-0.00 ms)");
}

TEST_CASE("light comparison: one pixel is counted where it is, with how far it is off") {
    auto received = sweep(4);
    auto pixels = std::vector<std::uint8_t>(received[2].light.pixels().begin(), received[2].light.pixels().end());
    pixels[17] = 23;
    received[2].light = {kSize, 1, pixels};
    const auto found = compared(sweep(4), received);
    CHECK(found.differingPixels == 1);
    CHECK(found.slots[2].differingPixels == 1);
    CHECK(found.slots[2].largest == 7);
    CHECK(found.slots[2].mean == doctest::Approx(7.0 / 128));
    CHECK(verdict(found) == "1 differing pixel in 1 of 4 slots (2), by up to 7 of 255, starts +0.00 ms (+-0.00 ms)");
}

TEST_CASE("light comparison: a slot that is dropped is missing, and those after it are still themselves") {
    auto received = sweep(4);
    received.erase(received.begin() + 1);
    const auto found = compared(sweep(4), received);
    CHECK(found.missing == 1);
    CHECK(found.extra == 0);
    CHECK(found.slots[1].missing);
    CHECK(found.slots[1].differingPixels == 128);
    CHECK(found.differingPixels == 128);
    CHECK_FALSE(found.same());
    CHECK(verdict(found).find("1 missing") != std::string::npos);
}

TEST_CASE("light comparison: a dark slot that is dropped is missing although no pixel could tell") {
    auto intended = sweep(3), received = sweep(3);
    intended[1].light = even(0);
    received.erase(received.begin() + 1);
    CHECK_FALSE(compared(intended, received).same());
}

TEST_CASE("light comparison: light that belongs to no slot is too much") {
    auto received = sweep(4);
    received.push_back({even(255), 7.0_ms, 1.0_ms});
    received.push_back({even(255), 1.3_ms, 0.1_ms});  // nearest to slot 1, which has its own
    const auto found = compared(sweep(4), received);
    CHECK(found.differingPixels == 0);
    CHECK(found.extra == 2);
    CHECK_FALSE(found.same());
    CHECK(verdict(found).find("2 too many") != std::string::npos);
}

TEST_CASE("light comparison: pictures of another size differ everywhere, and nothing received is all missing") {
    auto received = sweep(2);
    received[0].light = even(10, {8, 8});
    CHECK(compared(sweep(2), received).slots[0].differingPixels == 128);
    const auto none = compared(sweep(2), {});
    CHECK(none.missing == 2);
    CHECK(verdict(none) == "256 differing pixels in 2 of 2 slots (0, 1), by up to 20 of 255, 2 missing");
}

TEST_CASE("light comparison: light of another colour differs wherever there is any") {
    auto intended = sweep(2), received = sweep(2);
    intended[1].light = received[1].light = even(0);
    received[0].colours = received[1].colours = 1;
    const auto found = compared(intended, received);
    CHECK(found.slots[0].differingPixels == 128);
    CHECK(found.slots[0].largest == 10);
    CHECK(found.slots[1].differingPixels == 0);
}

TEST_CASE("light comparison: laws") {
    law("two slots with different light that change places differ in all their pixels", [] {
        const int slots = *rc::gen::inRange(2, 12);
        const int a = *rc::gen::inRange(0, slots), b = *rc::gen::inRange(0, slots);
        auto received = sweep(slots);
        std::swap(received[std::size_t(a)].light, received[std::size_t(b)].light);
        const auto found = compared(sweep(slots), received);
        RC_ASSERT(found.differingPixels == (a == b ? 0 : 256));
        RC_ASSERT(found.missing == 0 && found.extra == 0);
    });
    law("the order in which light is handed over does not matter", [] {
        auto received = sweep(6);
        received.resize(std::size_t(*rc::gen::inRange(0, 7)));
        const auto forwards = compared(sweep(6), received);
        std::reverse(received.begin(), received.end());
        RC_ASSERT(compared(sweep(6), received) == forwards);
    });
}
