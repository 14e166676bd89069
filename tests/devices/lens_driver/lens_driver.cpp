#include "devices/lens_driver/lens_driver.h"

#include <doctest/doctest.h>

#include <memory>
#include <string>

#include "tests/devices/lens_driver/fake_driver.h"
#include "tests/support/law.h"

namespace ilf::devices {
namespace {

using test::FakeDriver;
using test::FakeLine;

Ampere mA(double value) { return Ampere::fromSi(value * 1e-3); }

LensSetup setup(std::optional<Dioptre> rest = 0.5_D) {
    LensSetup all;
    all.name = "left lens";
    all.restPower = rest;
    all.restCurrent = mA(20.0);
    return all;
}

Result<std::unique_ptr<LensDriver>> opened(FakeDriver& device, const LensSetup& how = setup()) {
    return LensDriver::open(std::make_unique<FakeLine>(device), how, device.time.clock());
}

bool restsByPower(const FakeDriver& device) { return device.mode == 5 && device.power == 100; }
/// 20 mA of 292.84 in 4095 steps.
bool restsByCurrent(const FakeDriver& device) { return device.mode == 1 && std::abs(device.current - 280) <= 1; }
bool rests(const FakeDriver& device) { return restsByPower(device) || restsByCurrent(device); }

bool says(const Error& error, const std::string& words) { return error.what.find(words) != std::string::npos; }

}  // namespace

TEST_CASE("lens driver: opened, it has read what it drives and rests at the wearer's power") {
    FakeDriver device;
    const auto driver = opened(device);
    REQUIRE(driver);
    CHECK(device.starts == 1);
    CHECK((*driver)->facts().firmwareType == 'F');
    CHECK((*driver)->facts().lensSerial == "ANAB1234");
    CHECK((*driver)->facts().version == lens_driver::Version{1, 6, 12, 3});
    CHECK((*driver)->facts().most.si() == doctest::Approx(0.29284));
    CHECK((*driver)->facts().limits == CurrentLimits{mA(-250.0), mA(250.0)});
    REQUIRE((*driver)->facts().powers);
    CHECK((*driver)->facts().powers->high == 10.0_D);
    CHECK(restsByPower(device));
    CHECK(device.eepromWrites == 0);
}

TEST_CASE("lens driver: where focal powers cannot be had it rests by the calibrated current, and by 0 mA without one") {
    SUBCASE("firmware type D") {
        FakeDriver device;
        device.type = 'D';
        const auto driver = opened(device);
        REQUIRE(driver);
        CHECK(restsByCurrent(device));
        CHECK((*driver)->holdPower(1.0_D).error().fault == Fault::unsupported);
    }
    SUBCASE("a lens without memory") {
        FakeDriver device;
        device.serial = std::string(8, '\0');
        REQUIRE(opened(device));
        CHECK(restsByCurrent(device));
    }
    SUBCASE("a resting power out of reach") {
        FakeDriver device;
        device.powerHigh = 50;
        REQUIRE(opened(device));
        CHECK(restsByCurrent(device));
    }
    SUBCASE("old firmware, and no calibration") {
        FakeDriver device;
        device.oldFirmware = true;
        device.type = 'D';
        auto how = setup();
        how.restCurrent.reset();
        REQUIRE(opened(device, how));
        CHECK(device.mode == 1);
        CHECK(device.current == 0);
    }
}

TEST_CASE("lens driver: currents are clamped to the narrowest of rig, driver and its memory") {
    law("whatever is asked, the device gets no more than it may", [] {
        FakeDriver device;
        device.mostHundredths = *rc::gen::inRange(10'000, 29'285);
        device.upper = *rc::gen::inRange(0, 4096);
        device.lower = -*rc::gen::inRange(0, 4096);
        auto how = setup(std::nullopt);
        how.protection.most = mA(*rc::gen::inRange(10, 300));
        const auto driver = opened(device, how);
        RC_ASSERT(driver.has_value());
        const double asked = *rc::gen::inRange(-400, 401);
        const auto got = (*driver)->holdCurrent(mA(asked));
        RC_ASSERT(got.has_value());
        const double full = device.mostHundredths / 100.0, step = full / 4095.0;
        RC_ASSERT(device.milliamperes() <= how.protection.most.si() * 1e3 + step);
        RC_ASSERT(device.milliamperes() >= -how.protection.most.si() * 1e3 - step);
        RC_ASSERT(device.current <= device.upper && device.current >= device.lower);
        RC_ASSERT(std::abs(got->si() * 1e3 - device.milliamperes()) < step);
    });
    FakeDriver device;
    const auto driver = opened(device);
    REQUIRE(driver);
    CHECK((*driver)->holdCurrent(mA(100.0))->si() == doctest::Approx(0.1).epsilon(1e-3));
    CHECK(device.current == 1398);
    CHECK((*driver)->holdCurrent(mA(900.0))->si() == doctest::Approx(0.25).epsilon(1e-3));
    CHECK((*driver)->holdCurrent(Ampere::fromSi(std::nan(""))).error().fault == Fault::outOfRange);
}

TEST_CASE("lens driver: a resting power that takes more current than is allowed is left for the resting current") {
    FakeDriver device;
    device.codesPerPower = 30;  // 3000 of 4095 steps for 0.5 D: 215 mA
    auto how = setup();
    how.protection.most = mA(100.0);
    const auto driver = opened(device, how);
    REQUIRE(driver);
    CHECK(restsByCurrent(device));
    CHECK((*driver)->holdPower(0.5_D).error().fault == Fault::unsupported);
    CHECK((*driver)->heartbeat());
    REQUIRE((*driver)->rest());
    CHECK(restsByCurrent(device));
}

TEST_CASE("lens driver: a resting power that comes to take too much current, as lenses warm, is a fault and is left") {
    FakeDriver device;
    device.codesPerPower = 10;  // 71 mA
    auto how = setup();
    how.protection.most = mA(100.0);
    const auto driver = opened(device, how);
    REQUIRE(driver);
    REQUIRE(restsByPower(device));
    REQUIRE((*driver)->heartbeat());
    device.codesPerPower = 20;
    device.current = 2000;
    const auto beat = (*driver)->heartbeat();
    REQUIRE_FALSE(beat);
    CHECK(beat.error().fault == Fault::unsafe);
    CHECK(restsByCurrent(device));
}

TEST_CASE("lens driver: powers are held within reach, and refused outside without a fault") {
    FakeDriver device;
    const auto driver = opened(device);
    REQUIRE(driver);
    CHECK((*driver)->holdPower(2.0_D));
    CHECK(device.power == 400);
    CHECK(device.mode == 5);
    const auto refused = (*driver)->holdPower(11.0_D);
    CHECK(refused.error().fault == Fault::outOfRange);
    CHECK(refused.error().what == "The left lens reaches -10.00 D to 10.00 D and cannot hold 11.00 D.");
    CHECK((*driver)->holdPower(1.0_D));
    (*driver)->rest();
    CHECK(restsByPower(device));
}

TEST_CASE("lens driver: the bench's sine has its swing and frequency before it starts") {
    FakeDriver device;
    const auto driver = opened(device);
    REQUIRE(driver);
    CHECK((*driver)->sineForBench(60.0_Hz, mA(-100.0), mA(100.0)));
    CHECK(device.mode == 2);
    CHECK(device.milliHertz == 60'000);
    CHECK(device.swingHigh == 1398);
    CHECK(device.swingLow == -1398);
    CHECK((*driver)->sineForBench(0.1_Hz, mA(-1.0), mA(1.0)).error().fault == Fault::outOfRange);
    CHECK((*driver)->sineForBench(60.0_Hz, mA(2.0), mA(1.0)).error().fault == Fault::outOfRange);
    CHECK((*driver)->heartbeat()->mode == lens_driver::Mode::sine);
    (*driver)->rest();
    CHECK(restsByPower(device));
}

TEST_CASE("lens driver: a moving wave is refused for shows, with the reason") {
    CHECK(checkedForShow(stillWave(0.0_D, 1.0_D, 60.0_Hz)));
    const auto refused = checkedForShow(idealSine(0.0_D, 0.0_D, 2.0_D, 60.0_Hz, 0.0_s));
    CHECK(refused.error().fault == Fault::unsupported);
    CHECK(says(refused.error(), "cannot be locked to the projector"));
}

TEST_CASE("lens driver: what it is told by the device becomes a fault with the lens at rest") {
    FakeDriver device;
    const auto driver = opened(device);
    REQUIRE(driver);
    REQUIRE((*driver)->holdPower(3.0_D));
    SUBCASE("too hot") {
        device.temperature = 80 * 16;
        const auto state = (*driver)->heartbeat();
        CHECK(state.error().fault == Fault::unsafe);
        CHECK(says(state.error(), "80 degrees C"));
    }
    SUBCASE("another mode than asked for") {
        device.mode = 6;
        CHECK(says((*driver)->heartbeat().error(), "\"analog input\" instead of \"focal power\""));
    }
    SUBCASE("another current than asked for") {
        REQUIRE((*driver)->holdCurrent(mA(50.0)));
        device.current = 900;
        CHECK(says((*driver)->heartbeat().error(), "64 mA flow instead of 50 mA"));
    }
    SUBCASE("more current than allowed, by its own regulation") {
        device.current = 4000;
        CHECK((*driver)->heartbeat().error().fault == Fault::unsafe);
    }
    SUBCASE("another frequency than asked for") {
        REQUIRE((*driver)->sineForBench(60.0_Hz, mA(-50.0), mA(50.0)));
        device.milliHertz = 61'000;
        CHECK(says((*driver)->heartbeat().error(), "61000 mHz instead of 60000 mHz"));
    }
    SUBCASE("an unsolicited error, which was about an earlier command") {
        device.say("E", {1});
        const auto state = (*driver)->heartbeat();
        CHECK(says(state.error(), "do what it was told before: the message arrived damaged"));
    }
    SUBCASE("a hardware fault in its status") {
        device.status = 1;
        CHECK(says((*driver)->heartbeat().error(), "hardware fault"));
    }
    SUBCASE("a lens that does not go with it") {
        device.status = 0x100;
        CHECK(says((*driver)->heartbeat().error(), "does not go with this driver"));
    }
    CHECK(rests(device));
    const auto later = (*driver)->holdPower(1.0_D);
    CHECK(says(later.error(), "Connect its driver again"));
    CHECK(rests(device));
}

TEST_CASE("lens driver: a warm lens is told, not stopped") {
    FakeDriver device;
    const auto driver = opened(device);
    REQUIRE(driver);
    device.temperature = 50 * 16;
    device.status = 0x40;
    const auto state = (*driver)->heartbeat();
    REQUIRE(state);
    CHECK(state->temperature_C == 50.0);
    REQUIRE(state->warnings.size() == 2);
    CHECK(state->warnings[0] == "the left lens is warm: 50 degrees C");
    CHECK(state->warnings[1] == "the focal power is outside the guaranteed range");
}

TEST_CASE("lens driver: silence, damage and strangers are errors in words") {
    SUBCASE("nothing answers") {
        FakeDriver device;
        const auto driver = opened(device);
        REQUIRE(driver);
        device.silent = true;
        const auto state = (*driver)->heartbeat();
        CHECK(says(state.error(), "did not answer when asked to read the mode"));
    }
    SUBCASE("every answer is damaged") {
        FakeDriver device;
        device.damages = true;
        CHECK_FALSE(opened(device));
    }
    SUBCASE("something else is on the port") {
        class Stranger final : public SerialLink {
        public:
            explicit Stranger(test::VirtualTime& time) : time_(time) {}
            const std::string& name() const override { return name_; }
            Result<void> send(std::span<const std::uint8_t>, Milliseconds) override {
                ++sent;
                return {};
            }
            Result<Bytes> receive(std::size_t, Milliseconds limit) override {
                time_.at += limit;
                return Bytes{'?'};
            }
            int sent = 0;

        private:
            test::VirtualTime& time_;
            std::string name_ = "/dev/ttyS0";
        };
        test::VirtualTime time;
        auto link = std::make_unique<Stranger>(time);
        const auto driver = LensDriver::open(std::move(link), setup(), time.clock());
        CHECK(says(driver.error(), "/dev/ttyS0 does not answer like a lens driver 4"));
    }
    SUBCASE("limits that leave no current") {
        FakeDriver device;
        device.upper = -2000;
        device.lower = 2000;
        const auto driver = opened(device);
        CHECK(driver.error().fault == Fault::unsafe);
        CHECK(device.current == 0);
    }
}

TEST_CASE("lens driver: rest is reached within 100 ms, in steps, and when the driver is destroyed") {
    FakeDriver device;
    device.type = 'D';
    auto driver = opened(device);
    REQUIRE(driver);
    REQUIRE((*driver)->holdCurrent(mA(-200.0)));
    device.currents.clear();
    const auto before = device.time.at;
    driver->reset();
    CHECK(restsByCurrent(device));
    CHECK(device.time.at - before <= std::chrono::milliseconds(100));
    REQUIRE(device.currents.size() == 8);
    int last = -2797;
    for (const auto& [when, code] : device.currents) {
        CHECK(code - last <= 390);
        CHECK(code >= last);
        last = code;
    }
}

TEST_CASE("lens driver: whichever call fails, there is an error and the lens is told to rest") {
    bool isOpen = false;
    const auto scenario = [&](FakeDriver& device) -> Result<void> {
        isOpen = false;
        auto driver = opened(device);
        if (!driver) return tl::unexpected(driver.error());
        isOpen = true;
        auto& lens = **driver;
        return lens.holdPower(2.0_D)
            .and_then([&] { return lens.holdCurrent(mA(120.0)); })
            .and_then([&](Ampere) { return lens.sineForBench(60.0_Hz, mA(-90.0), mA(90.0)); })
            .and_then([&] { return lens.heartbeat(); })
            .and_then([&](const LensDriverState&) { return lens.holdPower(-2.0_D); });
    };
    for (const bool forGood : {false, true}) {
        bool passed = false, passedReady = false;
        int failing = 1;
        for (; !passed; ++failing) {
            CAPTURE(failing);
            CAPTURE(forGood);
            FakeDriver device;
            device.failsAt = failing;
            device.goneForGood = forGood;
            const auto before = device.time.at;
            const auto result = scenario(device);
            passed = device.calls < failing;
            REQUIRE(device.time.at - before < std::chrono::seconds(2));
            // It ended at rest, even if a call on the way to rest failed; gone for good, it cannot be told any more.
            if (result && (passed || !forGood)) CHECK(rests(device));
            if (result) continue;
            CHECK_FALSE(result.error().what.empty());
            if (forGood) continue;
            // Before its "Ready" it is not known to be a lens driver, and is told nothing more than "Start", which
            // sets the current to 0; before its limits are known, 0 mA is all that can be told.
            if (device.currents.empty()) {
                CHECK((device.starts == 0 || device.current == 0));
            } else {
                CHECK((rests(device) || (!isOpen && device.mode == 1 && device.current == 0)));
                passedReady = true;
            }
        }
        CHECK(failing > 100);
        CHECK((forGood || passedReady));
    }
}

}  // namespace ilf::devices
