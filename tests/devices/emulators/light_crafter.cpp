// The emulated projector against the worked packets, tables and orders of the public protocol (devices.md 1).
#include <doctest/doctest.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "devices/emulators/light_crafter.h"
#include "tests/support/law.h"

using namespace ilf::devices::emulators;

namespace {

constexpr std::int64_t kMs = 1'000'000;
/// 59.94 Hz.
constexpr std::int64_t kFrame = 16'683'350;

/// A host that writes and reads packets by hand, and a clock that jumps.
struct Host {
    EmulatedLightCrafter projector;
    std::int64_t now = 1'000 * kMs;

    explicit Host(LightCrafterOptions options = {}) : projector(options) {}

    static Bytes padded(Bytes bytes) {
        bytes.resize((bytes.size() + 63) / 64 * 64);
        return bytes;
    }
    UsbTransfer send(const Bytes& bytes) { return projector.out(0x01, padded(bytes), now); }
    std::optional<Bytes> receive() {
        Bytes reply(64);
        const UsbTransfer got = projector.in(0x81, reply, now);
        if (got.answer != UsbAnswer::done) return std::nullopt;
        reply.resize(got.bytes);
        return reply;
    }
    /// Command as it goes over the wire (CMD3, CMD2), then the payload; true when acknowledged.
    bool write(int cmd3, int cmd2, const Bytes& payload) {
        Bytes message = {0x40, ++sequence, 0, 0, std::uint8_t(cmd3), std::uint8_t(cmd2)};
        const std::size_t length = payload.size() + 2;
        message[2] = std::uint8_t(length);
        message[3] = std::uint8_t(length >> 8);
        message.insert(message.end(), payload.begin(), payload.end());
        send(message);
        const auto reply = receive();
        now += kMs;
        return reply && (*reply)[1] == sequence && ((*reply)[0] & 0x20) == 0;
    }
    Bytes read(int cmd3, int cmd2) {
        send({0xC0, ++sequence, 2, 0, std::uint8_t(cmd3), std::uint8_t(cmd2)});
        const auto reply = receive();
        now += kMs;
        if (!reply || (*reply)[1] != sequence || ((*reply)[0] & 0x20) != 0) return {};
        return Bytes(reply->begin() + 4, reply->begin() + 4 + (*reply)[2]);
    }
    /// Frames that come while the host does other things.
    void frames(const FramePtr& frame, int count) {
        for (int i = 0; i < count; ++i) {
            projector.verticalSync(frame, now);
            now += kFrame;
        }
    }
    std::uint8_t sequence = 0;
};

/// Three bytes of an entry (devices.md 1.4).
Bytes entry(int trigger, int pattern, int depth, int leds, int flags) {
    return {std::uint8_t(trigger | pattern << 2), std::uint8_t(depth | leds << 4), std::uint8_t(flags)};
}

/// `count` patterns of `depth` bits, white LED, one a slot, the first of them triggered by the frame and swapping.
Bytes streamingLut(int depth, int count) {
    Bytes lut;
    for (int i = 0; i < count; ++i) {
        const Bytes one = entry(i == 0 ? 1 : 3, i, depth, 7, i == 0 ? 4 : 0);
        lut.insert(lut.end(), one.begin(), one.end());
    }
    return lut;
}

/// The order of operations of devices.md 1.7. `lut` in one message at offset 0.
bool setUp(Host& host, const Bytes& lut, std::uint32_t exposure_us) {
    const auto count = std::uint8_t(lut.size() / 3);
    bool good = host.write(0x24, 0x1A, {0}) && host.write(0x1B, 0x1A, {1});
    host.now += 100 * kMs;
    good = good && host.read(0x1B, 0x1A) == Bytes{1};
    good = good && host.write(0x22, 0x1A, {0});
    good = good && host.write(0x31, 0x1A, {std::uint8_t(count - 1), 1, std::uint8_t(count - 1), 0});
    good = good && host.write(0x23, 0x1A, {0});
    Bytes timing;
    for (int twice = 0; twice < 2; ++twice)
        for (int i = 0; i < 4; ++i)
            timing.push_back(std::uint8_t(exposure_us >> (8 * i)));
    good = good && host.write(0x29, 0x1A, timing);
    good = good && host.write(0x33, 0x1A, {2}) && host.write(0x32, 0x1A, {0}) && host.write(0x34, 0x1A, lut);
    good = good && host.write(0x33, 0x1A, {0}) && host.write(0x1A, 0x1A, {0});
    good = good && host.read(0x1A, 0x1A) == Bytes{0x80};
    host.now += 100 * kMs;
    return good;
}

/// Set up, started twice, light of the set-up thrown away.
void play(Host& host, const Bytes& lut, std::uint32_t exposure_us) {
    host.projector.plugVideo({}, host.now);
    host.now += 300 * kMs;
    REQUIRE(setUp(host, lut, exposure_us));
    REQUIRE(host.write(0x24, 0x1A, {2}));
    host.now += 100 * kMs;
    REQUIRE(host.write(0x24, 0x1A, {2}));
    REQUIRE(host.projector.running());
    host.projector.takeLight(host.now);
}

FramePtr uniformFrame(std::uint8_t red, std::uint8_t green, std::uint8_t blue) {
    VideoFrame frame{kMirrorColumns, kMirrorRows, {}};
    frame.rgb.resize(std::size_t(kMirrorColumns) * kMirrorRows * 3);
    for (std::size_t i = 0; i < frame.rgb.size(); i += 3) {
        frame.rgb[i] = red;
        frame.rgb[i + 1] = green;
        frame.rgb[i + 2] = blue;
    }
    return std::make_shared<const VideoFrame>(std::move(frame));
}

/// Only this plane is set: 0-7 green, 8-15 red, 16-23 blue.
FramePtr planeFrame(int plane) {
    const auto bit = std::uint8_t(1 << (plane % 8));
    return uniformFrame(plane / 8 == 1 ? bit : 0, plane / 8 == 0 ? bit : 0, plane / 8 == 2 ? bit : 0);
}

}  // namespace

TEST_CASE("light crafter: the worked packets of the protocol are answered as they should be") {
    Host host;
    // read version
    host.send({0xC0, 0x11, 0x02, 0x00, 0x05, 0x02});
    const auto version = host.receive();
    REQUIRE(version);
    CHECK(Bytes(version->begin(), version->begin() + 8) == Bytes{0xC0, 0x11, 16, 0, 0, 0, 4, 4});
    // read main status: not running, gamma on
    host.send({0xC0, 0x12, 0x02, 0x00, 0x0C, 0x1A});
    CHECK((*host.receive())[4] == 0x08);
    // pattern mode on: acknowledged with the command repeated
    host.send({0x40, 0x13, 0x03, 0x00, 0x1B, 0x1A, 0x01});
    const auto acknowledged = host.receive();
    REQUIRE(acknowledged);
    CHECK(Bytes(acknowledged->begin(), acknowledged->begin() + 6) == Bytes{0x40, 0x13, 2, 0, 0x1B, 0x1A});
    // exposure = period = 694 us
    host.send({0x40, 0x14, 0x0A, 0x00, 0x29, 0x1A, 0xB6, 0x02, 0, 0, 0xB6, 0x02, 0, 0});
    CHECK((*host.receive())[0] == 0x40);
    CHECK(host.read(0x29, 0x1A) == Bytes{0xB6, 0x02, 0, 0, 0xB6, 0x02, 0, 0});
    // LUT control
    host.send({0x40, 0x15, 0x06, 0x00, 0x31, 0x1A, 0x17, 0x01, 0x17, 0x00});
    CHECK((*host.receive())[0] == 0x40);
    CHECK(host.read(0x31, 0x1A) == Bytes{0x17, 0x01, 0x17, 0x00});
    CHECK_FALSE(host.receive());
}

TEST_CASE("light crafter: what is unknown, of the wrong length or out of range is refused, not obeyed") {
    Host host;
    const auto refused = [&](const Bytes& message) {
        host.send(message);
        const auto reply = host.receive();
        return reply && ((*reply)[0] & 0x20) != 0 && (*reply)[1] == message[1];
    };
    CHECK(refused({0x40, 1, 3, 0, 0x77, 0x1A, 0}));         // no such command
    CHECK(refused({0xC0, 2, 2, 0, 0x34, 0x1A}));            // not while the mailbox is closed
    CHECK(refused({0x40, 3, 3, 0, 0x0C, 0x1A, 0}));         // cannot be written
    CHECK(refused({0x40, 4, 4, 0, 0x1B, 0x1A, 1, 0}));      // a byte too many
    CHECK(refused({0x40, 5, 2, 0, 0x1B, 0x1A}));            // a byte too few
    CHECK(refused({0x40, 6, 3, 0, 0x1B, 0x1A, 2}));         // no such mode
    CHECK(refused({0x40, 7, 1, 0, 0x1B, 0x1A}));            // shorter than a command
    CHECK(refused({0x40, 8, 0xFF, 0x7F, 0x1B, 0x1A}));      // longer than a message may be
    CHECK(refused({0x41, 9, 3, 0, 0x1B, 0x1A, 1}));         // another destination
    CHECK(refused({0x40, 10, 5, 0, 0x34, 0x1A, 1, 2, 3}));  // the mailbox is closed
    CHECK(refused({0x40, 11, 3, 0, 0x24, 0x1A, 2}));        // start in video mode
    CHECK(host.read(0x1B, 0x1A) == Bytes{0});
    // Without the wish for a reply there is none; a read without data has none either.
    host.send({0x00, 12, 3, 0, 0x77, 0x1A, 0});
    CHECK_FALSE(host.receive());
}

TEST_CASE("light crafter: a report of another length than 64 bytes is not a message") {
    Host host;
    const Bytes version = {0xC0, 1, 2, 0, 0x05, 0x02};
    CHECK(host.projector.out(0x01, version, host.now).answer == UsbAnswer::done);
    CHECK_FALSE(host.receive());
    // The 65 bytes of a report with its number in front: read as another message, and one byte lost.
    Bytes numbered = Host::padded(version);
    numbered.insert(numbered.begin(), 0);
    host.projector.out(0x01, numbered, host.now);
    CHECK_FALSE(host.receive());
    host.send(version);
    CHECK(host.receive());
}

TEST_CASE("light crafter: set up in the documented order, 24 slots of 694 us show the 24 planes") {
    Host host;
    play(host, streamingLut(1, 24), 694);
    CHECK(host.read(0x1A, 0x1A) == Bytes{0x08});  // "the normal result of the streaming LUT"
    const FramePtr frame = planeFrame(9);
    host.now = 10'000 * kMs;
    const std::int64_t first = host.now;
    host.frames(frame, 3);
    const std::vector<LightSlot> light = host.projector.takeLight(host.now);
    // Three triggers: the first shows what was there before, the others the frame that came in a period before.
    REQUIRE(light.size() == 72);
    for (int i = 0; i < 24; ++i) {
        const LightSlot& slot = light[std::size_t(24 + i)];
        CHECK(slot.start_ns == first + kFrame + i * 694'000);
        CHECK(slot.end_ns - slot.start_ns == 694'000);
        CHECK(slot.pattern == i);
        CHECK(slot.depth == 1);
        CHECK(slot.leds == 7);
        CHECK(slot.codeAt(17, 500) == (i == 9 ? 1 : 0));
        CHECK(light[std::size_t(i)].codeAt(17, 500) == 0);
    }
    CHECK((host.read(0x0A, 0x1A)[0] & 8) == 0);  // everything fits the frame
    CHECK((host.read(0x0C, 0x1A)[0] & 2) == 2);
}

TEST_CASE("light crafter: each plane lit alone appears in its pattern and its bit, at every depth") {
    // Pattern, and bit of its code, for plane 0 to 23; nothing where a depth leaves the plane out (devices.md 1.5).
    struct Place {
        int pattern = -1, bit = -1;
    };
    for (int depth = 1; depth <= 8; ++depth) {
        for (int plane = 0; plane < 24; ++plane) {
            Place expected;
            if (depth == 5) {
                // G5-1; R3-0 with G7 lowest; B1-0 above R7-5; B7-3
                if (plane >= 1 && plane <= 5) expected = {0, plane - 1};
                if (plane >= 7 && plane <= 11) expected = {1, plane - 7};
                if (plane >= 13 && plane <= 17) expected = {2, plane - 13};
                if (plane >= 19) expected = {3, plane - 19};
            } else if (depth == 7) {
                if (plane % 8 != 0) expected = {plane / 8, plane % 8 - 1};
            } else {
                expected = {plane / depth, plane % depth};
            }
            CAPTURE(depth);
            CAPTURE(plane);
            const FramePtr frame = planeFrame(plane);
            for (int pattern = 0; pattern < patternCount(depth); ++pattern) {
                LightSlot slot;
                slot.depth = depth;
                slot.pattern = pattern;
                slot.frame = frame;
                CHECK(slot.codeAt(0, 0) == (pattern == expected.pattern ? 1 << expected.bit : 0));
            }
        }
    }
    CHECK_FALSE(lowestPlane(8, 3));
    CHECK_FALSE(lowestPlane(9, 0));
    CHECK_FALSE(lowestPlane(1, 24));
}

TEST_CASE("light crafter: light is the code as a share of the largest, for every pixel") {
    VideoFrame frame{kMirrorColumns, kMirrorRows, {}};
    frame.rgb.resize(std::size_t(kMirrorColumns) * kMirrorRows * 3);
    for (std::size_t i = 0; i < frame.rgb.size(); ++i)
        frame.rgb[i] = std::uint8_t(i * 7 % 251);
    LightSlot slot;
    slot.frame = std::make_shared<const VideoFrame>(std::move(frame));
    slot.depth = 3;
    slot.pattern = 2;  // R0 G7 G6
    const Bytes codes = slot.codes(), light = slot.light();
    bool agree = true;
    for (std::size_t pixel = 0; pixel < codes.size(); ++pixel) {
        const int red = slot.frame->rgb[3 * pixel], green = slot.frame->rgb[3 * pixel + 1];
        const int expected = (red & 1) * 4 + (green >> 7 & 1) * 2 + (green >> 6 & 1);
        agree = agree && codes[pixel] == expected && light[pixel] == (510 * expected + 7) / 14;
    }
    CHECK(agree);
    slot.inverted = true;
    CHECK(slot.codeAt(3, 4) == 7 - codes[4 * kMirrorColumns + 3]);
    slot.leds = 0;
    CHECK(slot.codeAt(3, 4) == 0);
}

TEST_CASE("light crafter: the first start after a change of the LUT is ignored, one a moment later too") {
    Host host;
    host.projector.plugVideo({}, host.now);
    host.now += 300 * kMs;
    REQUIRE(setUp(host, streamingLut(1, 24), 694));
    CHECK(host.write(0x24, 0x1A, {2}));
    CHECK_FALSE(host.projector.running());
    host.now += 10 * kMs;
    CHECK(host.write(0x24, 0x1A, {2}));
    CHECK_FALSE(host.projector.running());
    host.now += 60 * kMs;
    CHECK(host.write(0x24, 0x1A, {2}));
    CHECK(host.projector.running());

    // Stopped and started without a change it starts at once.
    CHECK(host.write(0x24, 0x1A, {0}));
    CHECK(host.projector.running());  // until the frame is over
    CHECK_FALSE(host.write(0x29, 0x1A, {0, 1, 0, 0, 0, 1, 0, 0}));
    host.frames(uniformFrame(0, 0, 0), 1);
    CHECK_FALSE(host.projector.running());
    CHECK(host.write(0x24, 0x1A, {2}));
    CHECK(host.projector.running());

    LightCrafterOptions tame;
    tame.quirks.secondStart = false;
    Host other(tame);
    other.projector.plugVideo({}, other.now);
    REQUIRE(setUp(other, streamingLut(1, 24), 694));
    CHECK(other.write(0x24, 0x1A, {2}));
    CHECK(other.projector.running());
}

TEST_CASE("light crafter: an unchecked, wrong or changed LUT does not start") {
    Host host;
    host.projector.plugVideo({}, host.now);
    const auto validation = [&](const Bytes& lut, std::uint32_t exposure_us) {
        REQUIRE(setUp(host, lut, exposure_us));
        return int(host.read(0x1A, 0x1A)[0]);
    };
    CHECK(validation(streamingLut(1, 24), 694) == 0x08);
    CHECK(validation(streamingLut(1, 24), 200) == 0x09);  // shorter than 235 us
    CHECK_FALSE(host.write(0x24, 0x1A, {2}));
    CHECK(validation(streamingLut(8, 2), 8333) == 0x08);
    CHECK(validation(streamingLut(8, 3), 5555) == 0x09);     // 3 x 8 bits at 60 Hz is impossible
    CHECK(validation(entry(1, 12, 2, 7, 4), 1000) == 0x0A);  // 2 bits have 12 patterns
    CHECK_FALSE(host.write(0x24, 0x1A, {2}));
    CHECK(validation(entry(1, 24, 1, 7, 4), 694) == 0x08);       // black
    CHECK((validation(entry(1, 0, 1, 7, 6), 694) & 0x10) != 0);  // no room for black after it
    CHECK(host.write(0x24, 0x1A, {2}));
    host.now += 100 * kMs;
    Bytes timing = {0xE8, 3, 0, 0, 0xB8, 0x0B, 0, 0};  // 1000 of 3000 us: not in VSYNC mode
    CHECK(host.write(0x29, 0x1A, timing));
    CHECK_FALSE(host.write(0x24, 0x1A, {2}));  // changed since it was checked
    CHECK(host.write(0x1A, 0x1A, {0}));
    host.now += 100 * kMs;
    CHECK((host.read(0x1A, 0x1A)[0] & 1) == 1);
}

TEST_CASE("light crafter: exposures that do not fit the frame are cut by the next and told as a forced swap") {
    Host host;
    play(host, streamingLut(1, 24), 700);  // 16.8 ms of 16.68
    host.frames(uniformFrame(255, 255, 255), 3);
    const std::vector<LightSlot> light = host.projector.takeLight(host.now);
    REQUIRE(light.size() >= 48);
    CHECK(light[23].end_ns - light[23].start_ns == kFrame - 23 * 700'000);
    CHECK(light[24].pattern == 0);
    CHECK((host.read(0x0A, 0x1A)[0] & 8) == 8);
}

TEST_CASE("light crafter: an entry without the swap bit keeps showing the old picture") {
    Bytes lut = streamingLut(1, 24);
    lut[2] = 0;
    Host host;
    play(host, lut, 694);
    host.frames(uniformFrame(255, 255, 255), 4);
    for (const LightSlot& slot : host.projector.takeLight(host.now))
        CHECK(slot.codeAt(0, 0) == 0);

    LightCrafterOptions lenient;
    lenient.quirks.swapsWithoutBit = true;
    Host other(lenient);
    play(other, lut, 694);
    other.frames(uniformFrame(255, 255, 255), 4);
    CHECK(other.projector.takeLight(other.now).back().codeAt(0, 0) == 1);
}

TEST_CASE("light crafter: TRIG_OUT_2 rises once a sweep, with its delay and polarity") {
    Host host;
    REQUIRE(host.write(0x1E, 0x1A, {0, 0xBB + 10}));
    play(host, streamingLut(1, 24), 694);
    host.projector.takeTriggers(host.now);
    const std::int64_t first = host.now;
    host.frames(uniformFrame(0, 0, 0), 3);
    const auto edges = host.projector.takeTriggers(host.now);
    REQUIRE(edges.size() == 6);
    CHECK(edges[0] == TriggerEdge{first + 1071, true});
    CHECK_FALSE(edges[1].high);
    CHECK(edges[2].time_ns - edges[0].time_ns == kFrame);
}

TEST_CASE("light crafter: in video mode the frame of a period before is shown as grey; HDMI plugged flips to it") {
    Host host;
    play(host, streamingLut(1, 24), 694);
    host.frames(uniformFrame(255, 255, 255), 2);
    CHECK(host.projector.patternMode(host.now));
    CHECK(host.read(0x1C, 0x07)[0] == 1);  // "not locked" in pattern mode is expected
    host.projector.plugVideo({912, 1140, 60.0}, host.now);
    CHECK_FALSE(host.projector.patternMode(host.now));
    CHECK_FALSE(host.projector.running());
    CHECK(host.read(0x1B, 0x1A) == Bytes{0});
    CHECK(host.read(0x1C, 0x07)[0] == 1);  // not locked yet
    host.now += 300 * kMs;
    const Bytes status = host.read(0x1C, 0x07);
    REQUIRE(status.size() == 28);
    CHECK((status[0] & 3) == 2);
    CHECK(status[1] + 256 * status[2] == 912);
    CHECK(status[3] + 256 * status[4] == 1140);
    CHECK(status[14] + 256 * status[15] == 6000);
    CHECK(status[16] + 256 * status[17] == 1192);
    CHECK(status[18] + 256 * status[19] == 1170);

    host.projector.takeLight(host.now);
    host.frames(uniformFrame(255, 255, 255), 4);
    const auto light = host.projector.takeLight(host.now);
    REQUIRE(light.size() == 3);
    CHECK(light[2].video);
    CHECK(light[2].end_ns - light[2].start_ns == kFrame);
    CHECK(light[2].light()[1000] == 255);
    host.projector.unplugVideo(host.now);
    CHECK((host.read(0x1C, 0x07)[0] & 3) == 0);
}

TEST_CASE("light crafter: its own picture needs no video, is what pattern and colours say, and hides what comes in") {
    Host host;
    CHECK(host.read(0x00, 0x1A) == Bytes{0x08});
    const auto shows = [&host] {
        host.projector.takeLight(host.now);
        host.now += 50 * kMs;
        auto light = host.projector.takeLight(host.now);
        for (const LightSlot& slot : light)
            CHECK(slot.drawn);
        return light;
    };
    CHECK(shows().empty());
    REQUIRE(host.write(0x04, 0x12, {0xFF, 3, 0xFF, 3, 0xFF, 3, 0, 0, 0, 0, 0, 0}));
    CHECK(shows().empty());
    REQUIRE(host.write(0x00, 0x1A, {0x09}));
    CHECK(host.projector.draws(host.now));
    auto light = shows();
    REQUIRE(light.size() >= 2);
    CHECK(std::ranges::all_of(light[1].light(), [](std::uint8_t value) { return value == 255; }));
    CHECK(light[1].start_ns == light[0].end_ns);

    // Half the red: less light everywhere. Other patterns are not uniform: the background is black.
    REQUIRE(host.write(0x04, 0x12, {0xFF, 1, 0xFF, 3, 0xFF, 3, 0, 0, 0, 0, 0, 0}));
    light = shows();
    const int reddish = light.back().codeAt(0, 0);
    CHECK((reddish > 100 && reddish < 250));
    for (const int pattern : {1, 4, 7, 10}) {
        REQUIRE(host.write(0x03, 0x12, {std::uint8_t(pattern)}));
        const auto pixels = shows().back().light();
        CHECK(std::ranges::min(pixels) != std::ranges::max(pixels));
    }
    CHECK_FALSE(host.write(0x03, 0x12, {0x0B}));

    // Video is neither seen nor said to be locked meanwhile, and has to be locked on again.
    host.projector.plugVideo({}, host.now);
    CHECK(host.read(0x00, 0x1A) == Bytes{0x08});  // shown at once, as users found
    REQUIRE(host.write(0x00, 0x1A, {0x09}));
    host.now += 300 * kMs;
    host.frames(uniformFrame(255, 255, 255), 3);
    CHECK(host.read(0x1C, 0x07)[0] == 1);
    shows();
    REQUIRE(host.write(0x00, 0x1A, {0x08}));
    CHECK(host.read(0x1C, 0x07)[0] == 1);
    host.now += 300 * kMs;
    CHECK((host.read(0x1C, 0x07)[0] & 3) == 2);
    host.projector.takeLight(host.now);
    host.frames(uniformFrame(255, 255, 255), 4);
    light = host.projector.takeLight(host.now);
    REQUIRE_FALSE(light.empty());
    CHECK_FALSE(light.back().drawn);
    CHECK(light.back().light()[1000] == 255);

    // Patterns take what comes in: nothing, while another source is chosen; and they keep the source still.
    play(host, streamingLut(1, 24), 694);
    CHECK_FALSE(host.write(0x00, 0x1A, {0x09}));
    REQUIRE(host.write(0x24, 0x1A, {0}));
    host.now += 100 * kMs;
    REQUIRE(host.write(0x00, 0x1A, {0x09}));
    host.frames(uniformFrame(255, 255, 255), 4);
    CHECK(host.projector.takeLight(host.now).empty());
}

TEST_CASE("light crafter: toggled to video again and again it hangs until it is switched off and on") {
    Host host;
    host.projector.plugVideo({}, host.now);
    int toggles = 0;
    for (; toggles < 100; ++toggles) {
        if (!host.write(0x1B, 0x1A, {1})) break;
        host.now += 100 * kMs;
        if (!host.write(0x1B, 0x1A, {0})) break;
        host.now += 100 * kMs;
    }
    CHECK(toggles < 30);
    CHECK(host.projector.hung());
    CHECK(host.read(0x05, 0x02).empty());
    host.projector.powerCycle(host.now);
    CHECK(host.read(0x05, 0x02).size() == 16);
}

TEST_CASE("light crafter: settings are volatile, harmful commands are remembered, a reset leaves the bus") {
    Host host;
    CHECK(host.write(0x29, 0x1A, {1, 2, 3, 4, 5, 6, 7, 8}));
    CHECK(host.write(0x01, 0x0B, {0, 0, 0}));
    CHECK(host.projector.ledCurrentWrites() == 1);
    host.projector.powerCycle(host.now);
    CHECK(host.read(0x29, 0x1A) == Bytes(8));
    CHECK(host.read(0x22, 0x1A) == Bytes{3});
    CHECK(host.read(0x07, 0x1A) == Bytes{8});

    host.send({0x40, 1, 2, 0, 0x02, 0x08});
    CHECK_FALSE(host.receive());
    CHECK(host.send({0xC0, 2, 2, 0, 5, 2}).answer == UsbAnswer::gone);
    REQUIRE(host.projector.backOnBusAt());
    host.now = *host.projector.backOnBusAt();
    CHECK(host.read(0x05, 0x02).size() == 16);

    CHECK_FALSE(host.projector.harmed());
    host.send({0x40, 1, 3, 0, 0x01, 0x30, 1});
    CHECK(host.projector.harmed());
    CHECK(host.read(0x05, 0x02).empty());
}

TEST_CASE("light crafter: faults strike when they are told to, and as often") {
    Host host;
    host.projector.setFaults({{Mishap::nack, 1, 1}});
    CHECK(host.read(0x05, 0x02).size() == 16);
    CHECK(host.read(0x05, 0x02).empty());
    CHECK(host.read(0x05, 0x02).size() == 16);

    host.projector.setFaults({{Mishap::unplug, 70}});
    CHECK(host.read(0x05, 0x02).size() == 16);
    const UsbTransfer cut = host.send({0xC0, 1, 2, 0, 5, 2});
    CHECK(cut.answer == UsbAnswer::gone);
    CHECK(cut.bytes == 6);
    host.projector.setFaults({});

    play(host, streamingLut(1, 24), 694);
    host.frames(uniformFrame(0, 0, 0), 2);
    host.projector.takeLight(host.now);
    host.projector.setFaults({{Mishap::droppedTrigger, 1, 1}});
    host.frames(uniformFrame(0, 0, 0), 3);
    CHECK(host.projector.takeLight(host.now).size() == 48);

    host.projector.setFaults({{Mishap::stuckFrame, 0, 1}});
    host.frames(uniformFrame(255, 255, 255), 3);
    const auto stuck = host.projector.takeLight(host.now);
    REQUIRE(stuck.size() == 72);
    CHECK(stuck[24].codeAt(0, 0) == 1);
    host.projector.setFaults({{Mishap::stuckFrame}});
    host.frames(uniformFrame(0, 0, 0), 4);
    CHECK(host.projector.takeLight(host.now).back().codeAt(0, 0) == 1);

    host.projector.setFaults({{.kind = Mishap::clockDrift, .amount = 3000.0}});
    host.frames(uniformFrame(0, 0, 0), 3);
    CHECK((host.read(0x0A, 0x1A)[0] & 8) == 8);  // 24 x 694 us are now more than a frame
    host.projector.setFaults({{Mishap::wrongMode, 0, 1}});
    CHECK(host.read(0x1B, 0x1A) == Bytes{0});
}

TEST_CASE("light crafter: random bytes, and every truncation of a message, neither crash nor hang it") {
    ilf::law("random packets leave it able to answer", [](const std::vector<Bytes>& packets) {
        Host host;
        host.projector.plugVideo({}, host.now);
        for (const Bytes& packet : packets) {
            host.projector.out(0x01, packet, host.now);
            host.send(packet);
            host.now += 7 * kMs;
            host.projector.verticalSync(nullptr, host.now);
        }
        while (host.receive()) {
        }
        RC_ASSERT(host.projector.takeLight(host.now).size() <= 8192U);
        host.projector.powerCycle(host.now);
        // A message begun and never ended is ended by a short report.
        host.projector.out(0x01, Bytes{0}, host.now);
        RC_ASSERT(host.read(0x05, 0x02).size() == 16U);
    });
    ilf::law("random registers leave it able to answer", [](const std::vector<std::pair<std::uint8_t, Bytes>>& writes) {
        Host host;
        host.projector.plugVideo({}, host.now);
        host.write(0x1B, 0x1A, {1});
        host.now += 100 * kMs;
        for (const auto& [command, payload] : writes) {
            host.write(command, 0x1A, payload);
            host.projector.verticalSync(nullptr, host.now);
        }
        RC_ASSERT(host.projector.hung() || host.read(0x05, 0x02).size() == 16U);
    });

    Bytes message = {0x40, 7, 74, 0, 0x34, 0x1A};
    const Bytes lut = streamingLut(1, 24);
    message.insert(message.end(), lut.begin(), lut.end());
    message = Host::padded(message);
    for (std::size_t length = 0; length < message.size(); ++length) {
        Host host;
        host.projector.out(0x01, Bytes(message.begin(), message.begin() + std::ptrdiff_t(length)), host.now);
        CHECK_FALSE(host.receive());
        host.projector.unplugged(host.now);
        CHECK(host.read(0x05, 0x02).size() == 16);
    }
}
