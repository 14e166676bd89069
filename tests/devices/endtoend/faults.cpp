// Every message of a start goes wrong once, in every way: the driver says so, and leaves no slots behind.
#include <doctest/doctest.h>

#include "tests/devices/endtoend/bench.h"

using namespace ilf;
using namespace ilf::devices;
using namespace ilf::devices::dlpc350;
using namespace ilf::devices::test;
using emulators::Mishap;

namespace {

const PatternSequence kSlots = evenSequence(24, 1, 694.0_us);

struct After {
    bool started = false;
    std::string words;
    bool lit = false;  ///< slots run half a second later
    std::size_t messages = 0;
};

After startWith(const std::vector<emulators::DeviceFault>& faults) {
    Bench bench;
    bench.frames(20);
    auto driver = *LightCrafter::open(std::make_unique<DirectLink>(bench), bench.clock());
    bench.board.setFaults(faults);
    const auto started = driver->start(kSlots);
    After after;
    after.started = started.has_value();
    after.words = started ? "" : started.error().what;
    after.messages = bench.board.messages();
    bench.frames(30);
    after.lit = bench.board.running();
    CHECK_FALSE(bench.board.harmed());
    CHECK(bench.board.ledCurrentWrites() == 0);
    return after;
}

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

}  // namespace

TEST_CASE("faults: refused, silent or stalled at any message of a start, the driver says so and stops the slots") {
    const After well = startWith({});
    REQUIRE(well.started);
    REQUIRE(well.lit);
    REQUIRE(well.messages > 20);
    for (const Mishap kind : {Mishap::nack, Mishap::silence, Mishap::stall})
        for (std::size_t n = 0; n < well.messages; ++n) {
            CAPTURE(static_cast<int>(kind));
            CAPTURE(n);
            const After after = startWith({{kind, n, 1}});
            CHECK_FALSE(after.started);
            CHECK(contains(after.words, "The LightCrafter 4500 at 1-2"));
            CHECK_FALSE(contains(after.words, "could not be stopped"));
            CHECK_FALSE(after.lit);
        }
}

TEST_CASE("faults: unplugged at any message of a start, the driver says so, and that light is not known if it may be") {
    const std::size_t messages = startWith({}).messages;
    for (std::size_t n = 0; n < messages; ++n)
        for (const std::size_t within : {0U, 1U, 63U}) {
            CAPTURE(n);
            const After after = startWith({{Mishap::unplug, 64 * n + within}});
            CHECK_FALSE(after.started);
            CHECK(contains(after.words, "The LightCrafter 4500 at 1-2"));
            if (after.lit) CHECK(contains(after.words, "its light is not known"));
        }
}

TEST_CASE("faults: silent for good from any message on, the driver gives up and says what is not known") {
    const std::size_t messages = startWith({}).messages;
    for (std::size_t n = 0; n < messages; n += 3) {
        CAPTURE(n);
        const After after = startWith({{Mishap::silence, n}});
        CHECK_FALSE(after.started);
        CHECK(contains(after.words, "did not answer"));
        if (after.lit) CHECK(contains(after.words, "its light is not known"));
    }
}

TEST_CASE("faults: a board that leaves pattern mode during a start is not said to run, at the latest by the watch") {
    const std::size_t messages = startWith({}).messages;
    for (std::size_t n = 0; n < messages; ++n) {
        CAPTURE(n);
        Bench bench;
        bench.frames(20);
        auto driver = *LightCrafter::open(std::make_unique<DirectLink>(bench), bench.clock());
        bench.board.setFaults({{Mishap::wrongMode, n, 1}});
        const auto started = driver->start(kSlots);
        if (n + 2 < messages) CHECK(started.has_value() == bench.board.running());
        if (!started || bench.board.running()) continue;
        // It left after the driver's last look.
        const auto watched = driver->watch();
        REQUIRE(watched);
        CHECK_FALSE(watched->playing);
        CHECK(watched->flips == 1);
    }
}
