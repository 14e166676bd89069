#include <doctest/doctest.h>

#include "devices/dlpc350/frame_quantised.h"
#include "devices/plugin/slot_pictures.h"
#include "tests/devices/plugin/loopback_rig.h"
#include "tests/support/law.h"

namespace ilf::devices {
namespace {

using namespace std::chrono_literals;
using test::Loopback;

Image<std::uint8_t> noise(Size size, std::uint32_t seed) {
    std::vector<std::uint8_t> pixels(static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height));
    std::uint32_t state = seed * 2654435761U + 1U;
    for (auto& pixel : pixels) {
        state = state * 1664525U + 1013904223U;
        pixel = static_cast<std::uint8_t>(state >> 24U);
    }
    return {size, 1, std::move(pixels)};
}

Result<void> uploaded(PluginProjector& projector, const std::vector<Image<std::uint8_t>>& pictures) {
    for (std::size_t slot = 0; slot < pictures.size(); ++slot)
        if (auto sent = projector.upload(static_cast<int>(slot), pictures[slot]); !sent) return sent;
    return {};
}

/// An open projector that plays white in 16 slots at 960 Hz.
std::unique_ptr<PluginProjector> playing(const Loopback& loopback, PluginTrigger trigger = PluginTrigger::ownClock) {
    auto projector = loopback.open("size=8x4");
    REQUIRE(projector);
    PluginConfiguration how;
    how.trigger = trigger;
    REQUIRE((*projector)->configure(how));
    REQUIRE(uploaded(**projector, whiteSlots({8, 4}, 16, 8)));
    REQUIRE((*projector)->swap(1));
    REQUIRE((*projector)->start());
    return *std::move(projector);
}

}  // namespace

TEST_CASE("loopback plugin: all pixels of all slots arrive, at 1024x768 and 8 bits, whole programs at a time") {
    const Loopback loopback;
    auto projector = loopback.open();
    REQUIRE(projector);
    const Size raster = (*projector)->description().raster;
    CHECK(raster == Size{1024, 768});
    REQUIRE((*projector)->configure({}));
    std::vector<Image<std::uint8_t>> first, second;
    for (std::uint32_t slot = 0; slot < 16; ++slot) {
        first.push_back(noise(raster, slot));
        second.push_back(noise(raster, slot + 100));
    }
    const auto shows = [&](const std::vector<Image<std::uint8_t>>& pictures) {
        for (std::uint32_t slot = 0; slot < 16; ++slot)
            if (!(loopback.lightOf(slot, raster) == pictures[slot])) return false;
        return true;
    };
    CHECK(shows(whiteSlots(raster, 16, 8)));
    REQUIRE(uploaded(**projector, first));
    REQUIRE((*projector)->swap(7));
    REQUIRE((*projector)->start());
    CHECK(shows(first));
    REQUIRE(uploaded(**projector, second));
    CHECK(shows(first));
    loopback.pass(5ms);
    REQUIRE((*projector)->swap(8));
    CHECK(shows(second));
    CHECK((*projector)->status()->program == 8);
    CHECK((loopback.clock().now() - 16'666'667ns < 1us));  // at the sweep's start, not before
    const auto empty = (*projector)->swap(9);
    REQUIRE_FALSE(empty);
    CHECK(empty.error().what.find("A slot has no picture.") != std::string::npos);
    REQUIRE((*projector)->stop());
    CHECK(shows(whiteSlots(raster, 16, 8)));
}

TEST_CASE("loopback plugin: rows may be longer than the picture is wide") {
    const Loopback loopback;
    const auto projector = playing(loopback);
    const auto plugin = Loopback::plugin();
    // Straight across the boundary: the host itself never pads.
    REQUIRE(projector->steadyWhite());
    ilf_projector* raw = nullptr;
    ilf_message message{};
    CHECK(plugin.calls().open("", "", &raw, &message) == ILF_BUSY);
    CHECK(raw == nullptr);
    REQUIRE(projector->configure({}));
    auto padded = noise({13, 4}, 3);
    auto* open = loopback.projector();
    for (std::uint32_t slot = 0; slot < 16; ++slot) {
        const ilf_frame frame{sizeof frame, slot, 8, 4, 13, 0, padded.row(0)};
        REQUIRE(plugin.calls().upload(open, &frame, &message) == ILF_OK);
    }
    REQUIRE(projector->swap(2));
    REQUIRE(projector->start());
    const auto light = loopback.lightOf(5, {8, 4});
    for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 8; ++x)
            CHECK(light.at(x, y) == padded.at(x, y));
}

TEST_CASE("loopback plugin: frames are counted by the clock, and what was not shown is dropped") {
    const Loopback loopback;
    const auto projector = playing(loopback);
    loopback.pass(10s);
    auto status = projector->status();
    REQUIRE(status);
    CHECK(status->sent == 9600);
    CHECK(status->shown == 9600);
    CHECK(status->slotRate == 960.0_Hz);
    CHECK(status->state == PluginStatus::State::playing);
    loopback.faults("drop=100,underrun=60,lose_trigger=300");
    loopback.pass(10s);
    status = projector->status();
    CHECK(status->sent == 19200);
    CHECK(status->dropped == 96 + 10);
    CHECK(status->underruns == 10);
    CHECK(status->triggersLost == 2);
    REQUIRE(projector->steadyWhite());
    loopback.pass(10s);
    CHECK(projector->status()->sent == 19200);
    CHECK(projector->status()->state == PluginStatus::State::white);
}

TEST_CASE("loopback plugin: by the machine's clock it plays as fast as it should") {
    const Loopback loopback(true);
    const auto projector = playing(loopback);
    const auto begun = std::chrono::steady_clock::now();
    REQUIRE(uploaded(*projector, whiteSlots({8, 4}, 16, 8)));
    REQUIRE(projector->swap(2));  // waits for the next sweep
    const auto status = projector->status();
    REQUIRE(status);
    CHECK(status->program == 2);
    CHECK(status->sent >= 16);
    const double passed_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
    // Started a little before `begun`: that little is less than a second on any machine.
    CHECK(static_cast<double>(status->sent) <= 960.0 * (passed_s + 1.0));
}

TEST_CASE("loopback plugin: without triggers from outside it goes to white by itself, and says so") {
    const Loopback loopback;
    const auto projector = playing(loopback, PluginTrigger::eachSweep);
    loopback.pass(1s);
    CHECK(projector->status()->troubles.empty());
    loopback.faults("lose_trigger=1");
    loopback.pass(1s);
    const auto status = projector->status();
    REQUIRE(status);
    CHECK(status->state == PluginStatus::State::white);
    CHECK(status->troubles == std::vector<std::string>{"The projector gets no triggers; check the trigger cable, then "
                                                       "TAKE."});
}

TEST_CASE("loopback plugin: options it does not understand are refused, and white is left behind") {
    const Loopback loopback;
    for (const char* wrong : {"size=0x4", "size=8", "drop=0", "drop", "refuse=swap", "whatever=1", "gone=-1"}) {
        const auto projector = loopback.open(wrong);
        CAPTURE(wrong);
        REQUIRE_FALSE(projector);
        CHECK(projector.error().what.find("The options are not understood") != std::string::npos);
        CHECK_FALSE(loopback.opened());
    }
    {
        const auto projector = playing(loopback);
        CHECK(loopback.opened());
        CHECK(loopback.slots() == 16);
    }
    CHECK_FALSE(loopback.opened());
    CHECK(loopback.slots() == 0);
    const auto refusing = loopback.open("refuse=status:2,slow=status:20");
    REQUIRE(refusing);
    CHECK((*refusing)->status());
    CHECK_FALSE((*refusing)->status());
    CHECK((*refusing)->status());
    CHECK(loopback.clock().now() == 60ms);
    loopback.faults("gone=1");
    const auto gone = (*refusing)->steadyWhite();
    REQUIRE_FALSE(gone);
    CHECK(gone.error().fault == Fault::notFound);
}

TEST_CASE("slot pictures: 8 bits are the images' own, fewer are what the plan states, in the upper bits") {
    law("slots", [] {
        const auto bits = *rc::gen::inRange(1, 9);
        const auto program = test::program(*rc::gen::inRange(0U, 1000U));
        const auto slots = slotPictures(program, bits);
        RC_ASSERT(slots.size() == program.imageOfSlot.size());
        const int full = dlpc350::fullCode(bits);
        for (std::size_t slot = 0; slot < slots.size(); ++slot) {
            const int index = program.imageOfSlot[slot];
            const LightImage stated = index == Program::kDark
                                          ? LightImage(program.projector)
                                          : dlpc350::quantised(program.images[static_cast<std::size_t>(index)], bits);
            for (int y = 0; y < program.projector.height; y += 3)
                for (int x = 0; x < program.projector.width; ++x) {
                    const int value = slots[slot].at(x, y);
                    RC_ASSERT(value % (1 << (8 - bits)) == 0);
                    const int code = value >> (8 - bits);
                    RC_ASSERT((255 * 2 * code + full) / (2 * full) == stated.at(x, y));
                }
        }
    });
    CHECK(whiteSlots({8, 4}, 3, 1).size() == 3);
    CHECK(whiteSlots({8, 4}, 3, 1).front().at(0, 0) == 128);
    CHECK(whiteSlots({8, 4}, 3, 8).front().at(7, 3) == 255);
}

}  // namespace ilf::devices
