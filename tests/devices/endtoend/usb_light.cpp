// Intended against received light: the unmodified driver through libusb, an emulated board on an emulated bus, and its
// light as it reads the frame and the table with tables of its own. Needs libumockdev-preload.so.0 in LD_PRELOAD, as
// ctest sets it, and says so where it is missing.
#include <doctest/doctest.h>

#include <algorithm>
#include <atomic>
#include <thread>

#include "devices/dlpc350/frame_test_pictures.h"
#include "devices/emulators/usb_host.h"
#include "devices/usb/usb_bus.h"
#include "tests/devices/endtoend/bench.h"

using namespace ilf;
using namespace ilf::devices;
using namespace ilf::devices::dlpc350;
using namespace ilf::devices::test;
using emulators::Mishap;
using emulators::UsbHost;

namespace {

/// What the board is told as now: the bench's time, which stands still while messages travel.
std::atomic<std::int64_t> busTime_ns{0};

/// One bus for the whole executable, as umockdev has it. None where it is not preloaded.
UsbHost* host() {
    static const Result<std::unique_ptr<UsbHost>> started = UsbHost::started([] { return busTime_ns.load(); });
    if (started) return started->get();
    MESSAGE("SKIPPED: ", started.error().what);
    return nullptr;
}

/// A bench whose board hangs on the bus, with the driver's clock telling the bus what time it is.
struct OnBus {
    Bench bench{busTime_ns.load(),
                [](const std::function<void()>& work) { host()->locked([&](std::int64_t) { work(); }); }};
    std::unique_ptr<UsbBus> bus = *UsbBus::open();
    std::unique_ptr<LightCrafter> driver;

    OnBus() {
        frames(20);
        REQUIRE(host()->plug("1-2", bench.board));
        open();
    }
    ~OnBus() {
        driver.reset();
        bus.reset();
        host()->unplug("1-2");
    }
    OnBus(const OnBus&) = delete;
    OnBus& operator=(const OnBus&) = delete;

    void open() {
        driver.reset();
        // The system takes a moment to name a device that was plugged in.
        for (int tries = 0; tries < 200 && !driver; ++tries) {
            if (auto link = bus->link("1-2", LightCrafter::kInterface))
                driver = *LightCrafter::open(*std::move(link), clock());
            else
                std::this_thread::sleep_for(std::chrono::milliseconds(10));
        }
        REQUIRE(driver);
    }
    Clock clock() {
        Clock virtualTime = bench.clock();
        return {virtualTime.now, [this, virtualTime](std::chrono::nanoseconds time) {
                    virtualTime.wait(time);
                    busTime_ns = bench.now_ns();
                }};
    }
    void frames(int count) {
        bench.frames(count);
        busTime_ns = bench.now_ns();
    }
    std::vector<SlotLight> newestSweep() {
        auto sweep = bench.newestSweep();
        busTime_ns = bench.now_ns();
        return sweep;
    }
    bool running() {
        bool runs = false;
        bench.locked([&] { runs = bench.board.running(); });
        return runs;
    }
};

}  // namespace

TEST_CASE("light through libusb: at every depth that is shown, exactly the light the plan states") {
    if (host() == nullptr) return;
    OnBus on;
    constexpr std::array<std::pair<int, int>, 5> kSlotsAndBits{{{2, 8}, {6, 4}, {8, 3}, {12, 2}, {24, 1}}};
    for (const auto& [slots, bits] : kSlotsAndBits) {
        CAPTURE(bits);
        const Program program = sweepOf(slots, 50);
        const auto frame = packed(program, bits);
        REQUIRE(frame);
        on.bench.present(frame->picture);
        const auto started = on.driver->start(frame->sequence);
        if (!started) FAIL(started.error().what);
        on.frames(3);
        const auto found = compared(intendedSweep(program, bits), on.newestSweep());
        CHECK(found.differingPixels == 0);
        CHECK(found.same());
        CHECK(found.offset < 0.02_ms);
        if (!found.same()) MESSAGE(verdict(found));
        if (bits == 8) CHECK(intendedLight(program, bits)[0] == program.images[0]);  // 8 bits lose nothing
    }
    CHECK(on.bench.board.ledCurrentWrites() == 0);
    CHECK_FALSE(on.bench.board.harmed());
}

TEST_CASE("light through libusb: a new program's first light comes within a sweep and a frame, and never in part") {
    if (host() == nullptr) return;
    OnBus on;
    const Program before = sweepOf(8, 60), after = sweepOf(8, 61);
    const auto former = packed(before, 3);
    on.bench.present(former->picture);
    REQUIRE(on.driver->start(former->sequence));
    const auto next = repacked(*former, before, after);
    REQUIRE(next);
    REQUIRE(next->sequence == former->sequence);
    const auto wantedBefore = intendedSweep(before, 3), wantedAfter = intendedSweep(after, 3);

    for (const std::int64_t within_ns : {std::int64_t(0), Bench::kFrame_ns / 2, Bench::kFrame_ns - 1}) {
        on.bench.present(former->picture);
        on.frames(4);
        CHECK(compared(wantedBefore, on.newestSweep()).same());
        on.bench.advance(within_ns);
        (void)on.bench.takeLight();
        const std::int64_t presented_ns = on.bench.now_ns();
        on.bench.present(next->picture);
        on.bench.advance(4 * Bench::kFrame_ns);
        busTime_ns = on.bench.now_ns();

        std::optional<std::int64_t> first_ns;
        for (const auto& slot : on.bench.takeLight()) {
            const auto index = static_cast<std::size_t>(slot.pattern);
            const SlotLight light = taken(slot, 0);
            const bool isNew = light.light == wantedAfter[index].light,
                       isOld = light.light == wantedBefore[index].light;
            CHECK((isNew || isOld));
            if (isNew && !isOld && !first_ns) {
                first_ns = slot.start_ns;
                CHECK(index == 0);  // from a sweep's first slot on
            }
            if (first_ns) CHECK(isNew);
        }
        REQUIRE(first_ns);
        CHECK(*first_ns - presented_ns <= 2 * Bench::kFrame_ns);  // a sweep is as long as a frame
    }
}

TEST_CASE(
    "light through libusb: the plane-identification picture shows each plane in its slot, and alone by its number") {
    if (host() == nullptr) return;
    OnBus on;
    const PackedFrame picture = identificationFrame();
    on.bench.present(picture.picture);
    REQUIRE(on.driver->start(picture.sequence));
    on.frames(3);
    const auto litOutside = [](const SlotLight& slot, int plane) {
        const auto cell = identificationCell(plane);
        int inside = 0, outside = 0;
        for (int y = 0; y < slot.light.height(); ++y)
            for (int x = 0; x < slot.light.width(); ++x)
                if (slot.light.at(x, y) != 0)
                    (x >= cell.x0 && x < cell.x1 && y >= cell.y0 && y < cell.y1 ? inside : outside) += 1;
        return inside == 0 ? -1 : outside;
    };
    const auto sweep = on.newestSweep();
    REQUIRE(sweep.size() == 24);
    for (int plane = 0; plane < 24; ++plane)
        CHECK(litOutside(sweep[std::size_t(plane)], plane) == 0);

    REQUIRE(on.driver->start(onlyPlane(13)));
    on.frames(3);
    const auto one = on.newestSweep();
    REQUIRE(one.size() == 1);
    CHECK(litOutside(one.front(), 13) == 0);
}

TEST_CASE("light through libusb: white is white as video and in every slot") {
    if (host() == nullptr) return;
    OnBus on;
    on.bench.present(whitePicture());
    REQUIRE(on.driver->start(evenSequence(4, 5, 2500.0_us)));
    on.frames(3);
    const auto allWhite = [](const std::vector<SlotLight>& sweep) {
        return !sweep.empty() && std::ranges::all_of(sweep, [](const SlotLight& slot) {
            return slot.colours == 7 &&
                   std::ranges::all_of(slot.light.pixels(), [](std::uint8_t value) { return value == 255; });
        });
    };
    CHECK(allWhite(on.newestSweep()));
    const auto video = on.driver->showVideo();
    if (!video) FAIL(video.error().what);
    on.frames(30);
    CHECK(allWhite(on.newestSweep()));
}

TEST_CASE("light through libusb: a refusal, a stall and a pulled cable end a start in words and without slots") {
    if (host() == nullptr) return;
    for (const Mishap kind : {Mishap::nack, Mishap::stall, Mishap::unplug}) {
        CAPTURE(static_cast<int>(kind));
        OnBus on;
        const std::uint64_t message = 9;  // in the middle of the settings
        on.bench.locked(
            [&] { on.bench.board.setFaults({{kind, kind == Mishap::unplug ? 64 * message + 17 : message, 1}}); });
        const auto started = on.driver->start(evenSequence(24, 1, 694.0_us));
        REQUIRE_FALSE(started);
        CHECK(started.error().what.find("The LightCrafter 4500 at 1-2") != std::string::npos);
        on.frames(5);
        CHECK_FALSE(on.running());
        if (kind == Mishap::unplug) {
            CHECK(started.error().what.find("its light is not known") != std::string::npos);
            continue;
        }
        on.bench.locked([&] { on.bench.board.setFaults({}); });
        CHECK(on.driver->start(evenSequence(24, 1, 694.0_us)));
        CHECK(on.running());
    }
}
