#include "devices/dlpc350/messages.h"

#include "devices/dlpc350/input_source.h"
#include "devices/dlpc350/sequence.h"
#include "devices/dlpc350/settings.h"
#include "tests/support/fuzz.h"
#include "tests/support/law.h"

using namespace ilf;
using namespace ilf::devices::dlpc350;

namespace {

using Bytes = std::vector<std::uint8_t>;

/// The packet's first bytes; the rest must be zero.
bool startsWith(const Packet& packet, const Bytes& bytes) {
    Packet wanted{};
    std::copy(bytes.begin(), bytes.end(), wanted.begin());
    return packet == wanted;
}

template <class T>
bool staysInWords(const Bytes& bytes) {
    const auto value = parsed<T>(bytes);
    return value || !value.error().what.empty();
}

bool everyDecoderStands(const Bytes& bytes) {
    return staysInWords<Version>(bytes) && staysInWords<FirmwareTag>(bytes) && staysInWords<HardwareStatus>(bytes) &&
           staysInWords<SystemStatus>(bytes) && staysInWords<MainStatus>(bytes) && staysInWords<VideoSignal>(bytes) &&
           staysInWords<Validation>(bytes) && staysInWords<Display>(bytes) && staysInWords<PatternSource>(bytes) &&
           staysInWords<TriggerMode>(bytes) && staysInWords<PatternRun>(bytes) && staysInWords<ExposurePeriod>(bytes) &&
           staysInWords<LutControl>(bytes) && staysInWords<LedControl>(bytes) && staysInWords<TriggerOut1>(bytes) &&
           staysInWords<TriggerOut2>(bytes) && staysInWords<InputSource>(bytes) && staysInWords<TestPattern>(bytes) &&
           staysInWords<TestColours>(bytes);
}

/// Feeds packets of at most 64 bytes until the reply is whole, fails or nothing is left.
bool replyStands(const Bytes& bytes) {
    std::size_t at = 0;
    const auto next = [&] {
        const std::size_t part = std::min<std::size_t>(kPacketBytes, bytes.size() - at);
        const Bytes packet(bytes.begin() + static_cast<std::ptrdiff_t>(at),
                           bytes.begin() + static_cast<std::ptrdiff_t>(at + part));
        at += part;
        return packet;
    };
    auto reply = Reply::begun(next());
    if (!reply) return !reply.error().what.empty();
    while (!reply->whole() && at < bytes.size())
        if (const auto added = reply->add(next()); !added) return !added.error().what.empty();
    (void)reply->echoes(kCommandOf<Display>);
    return reply->data().size() <= kMostMessageBytes &&
           everyDecoderStands(Bytes(reply->data().begin(), reply->data().end()));
}

}  // namespace

TEST_CASE("dlpc350: the reference's worked packets") {
    CHECK(startsWith(readMessage(kCommandOf<Version>, 0x11), {0xC0, 0x11, 0x02, 0x00, 0x05, 0x02}));
    CHECK(startsWith(readMessage(kCommandOf<MainStatus>, 0x12), {0xC0, 0x12, 0x02, 0x00, 0x0C, 0x1A}));

    const auto one = [](Command command, const Bytes& payload, const Bytes& wanted) {
        const auto packets = writeMessage(command, 0x21, payload);
        CHECK(packets.size() == 1);
        CHECK(startsWith(packets.front(), wanted));
    };
    one(kCommandOf<Display>, payloadOf(Display::pattern), {0x40, 0x21, 0x03, 0x00, 0x1B, 0x1A, 0x01});
    one(kCommandOf<PatternRun>, payloadOf(PatternRun::stopped), {0x40, 0x21, 0x03, 0x00, 0x24, 0x1A, 0x00});
    one(kCommandOf<PatternRun>, payloadOf(PatternRun::running), {0x40, 0x21, 0x03, 0x00, 0x24, 0x1A, 0x02});
    one(kCommandOf<ExposurePeriod>, payloadOf(ExposurePeriod{694, 694}),
        {0x40, 0x21, 0x0A, 0x00, 0x29, 0x1A, 0xB6, 0x02, 0x00, 0x00, 0xB6, 0x02, 0x00, 0x00});
    one(kCommandOf<LutControl>, payloadOf(LutControl{24, true, 24, 1}),
        {0x40, 0x21, 0x06, 0x00, 0x31, 0x1A, 0x17, 0x01, 0x17, 0x00});
    one(kMailboxData, lutBytes({{Trigger::externalPositive, 0, 1, Led::white, false, false, true, false}}),
        {0x40, 0x21, 0x05, 0x00, 0x34, 0x1A, 0x01, 0x71, 0x04});
    one(kMailboxData, lutBytes({{Trigger::none, 8, 1, Led::white, false, false, false, false}}),
        {0x40, 0x21, 0x05, 0x00, 0x34, 0x1A, 0x23, 0x71, 0x00});
}

TEST_CASE("dlpc350: what does not fit into 58 bytes goes on in packets without header") {
    Bytes payload(72);
    for (std::size_t i = 0; i < payload.size(); ++i)
        payload[i] = static_cast<std::uint8_t>(100 + i);
    const auto packets = writeMessage(kMailboxData, 3, payload);
    REQUIRE(packets.size() == 2);
    CHECK(packets[0][2] == 74);
    CHECK(packets[0][6] == 100);
    CHECK(packets[0][63] == 157);
    CHECK(packets[1][0] == 158);
    CHECK(packets[1][13] == 171);
    CHECK(packets[1][14] == 0);
    CHECK(writeMessage(kMailboxData, 3, Bytes(58)).size() == 1);
    CHECK(writeMessage(kMailboxData, 3, Bytes(59)).size() == 2);
    CHECK(writeMessage(kMailboxData, 3, Bytes(58 + 64)).size() == 2);
    CHECK(writeMessage(kMailboxData, 3, Bytes(kMostPayloadBytes)).size() == 9);
}

TEST_CASE("dlpc350: LEDs can only be given to the sequencer") {
    CHECK(payloadOf(LedControl{false, true, true, true}) == Bytes{0x08});
}

TEST_CASE("dlpc350: replies over several packets, and refusals") {
    Bytes first(64), second(64);
    first[0] = 0xC0, first[1] = 9, first[2] = 70;
    first[4] = 1, first[63] = 60;
    second[0] = 61, second[9] = 70, second[10] = 99;
    auto reply = Reply::begun(first);
    REQUIRE(reply);
    CHECK(!reply->whole());
    CHECK(reply->sequence() == 9);
    REQUIRE(reply->add(second));
    CHECK(reply->whole());
    REQUIRE(reply->data().size() == 70);
    CHECK(reply->data()[60] == 61);
    CHECK(reply->data()[69] == 70);

    CHECK(Reply::begun(Bytes{0xE0, 1, 0, 0})->refused());
    CHECK(Reply::begun(Bytes{0xC0, 1, 0, 0})->refused());
    CHECK(Reply::begun(Bytes{0x60, 1, 2, 0, 0x1B, 0x1A})->refusedWrite());
    CHECK(!Reply::begun(Bytes{0x40, 1, 0, 0})->refusedWrite());
    CHECK(Reply::begun(Bytes{0x40, 1, 2, 0, 0x1B, 0x1A})->echoes(kCommandOf<Display>));
    CHECK(!Reply::begun(Bytes{0x40, 1, 2, 0, 0x24, 0x1A})->echoes(kCommandOf<Display>));
    CHECK(Reply::begun(Bytes{0xC0, 1, 0xFF, 0xFF}).error().what == "A reply says it has 65535 bytes; the most is 512.");
}

TEST_CASE("dlpc350: a reply cut short anywhere is an error") {
    Bytes whole(4 + 100, 7);
    whole[0] = 0xC0, whole[2] = 100, whole[3] = 0;
    const auto part = [&](std::size_t from, std::size_t to) {
        return Bytes(whole.begin() + static_cast<std::ptrdiff_t>(from),
                     whole.begin() + static_cast<std::ptrdiff_t>(to));
    };
    for (std::size_t cut = 0; cut < 64; ++cut)
        CHECK(!Reply::begun(part(0, cut)));
    auto reply = Reply::begun(part(0, 64));
    REQUIRE(reply);
    for (std::size_t cut = 64; cut < whole.size(); ++cut)
        CHECK(!reply->add(part(64, cut)));
    CHECK(reply->add(part(64, whole.size())));
    CHECK(reply->whole());
}

TEST_CASE("dlpc350: states and settings from bytes written by hand") {
    const Bytes version{0x07, 0x00, 0x04, 0x04, 0x01, 0x01, 0x02, 0x03, 0, 0, 0, 2, 0, 0, 0, 3};
    CHECK(parsed<Version>(version) == Version{{4, 4, 7}, {3, 2, 257}, {2, 0, 0}, {3, 0, 0}});
    CHECK(parsed<HardwareStatus>(Bytes{0x49}) == HardwareStatus{true, false, true, true, false});
    CHECK(parsed<MainStatus>(Bytes{0x06}) == MainStatus{false, true, true, false});
    CHECK(parsed<SystemStatus>(Bytes{0x01}) == SystemStatus{true});
    CHECK(parsed<Validation>(Bytes{0x08})->mayStart());
    CHECK(!parsed<Validation>(Bytes{0x88})->mayStart());
    CHECK(!parsed<Validation>(Bytes{0x01})->mayStart());
    CHECK(!parsed<Validation>(Bytes{0x02})->mayStart());
    CHECK(parsed<ExposurePeriod>(Bytes{0xB6, 2, 0, 0, 0x6A, 0x41, 0, 0}) == ExposurePeriod{694, 16746});
    CHECK(parsed<LutControl>(Bytes{0x17, 1, 0x17, 0}) == LutControl{24, true, 24, 1});
    CHECK(parsed<LedControl>(Bytes{0x05}) == LedControl{false, true, false, true});
    CHECK(parsed<TriggerMode>(Bytes{0x04}) == TriggerMode::variableVsync);
    CHECK(parsed<FirmwareTag>(Bytes{'a', 0x07, 'b', 0, 'c'})->text == "a?b");

    Bytes video(28);
    video[0] = 0x02, video[1] = 0x90, video[2] = 0x03, video[3] = 0x74, video[4] = 0x04, video[14] = 0x6A,
    video[15] = 0x17;
    const auto signal = parsed<VideoSignal>(video);
    REQUIRE(signal);
    CHECK(signal->locked);
    CHECK(inWords(*signal) == "912x1140 at 59.94 Hz");
    video[0] = 0x01;
    CHECK(!parsed<VideoSignal>(video)->locked);
    CHECK(!parsed<PatternSource>(Bytes{0x02}));
    CHECK(parsed<PatternSource>(Bytes{}).error().what == "The reply to \"pattern source\" has 0 of 1 bytes.");
}

TEST_CASE("dlpc350: input source, test pattern and its colours from bytes written by hand") {
    CHECK(parsed<InputSource>(Bytes{0x08}) == InputSource{Source::parallel, 1});
    CHECK(parsed<InputSource>(Bytes{0x29}) == InputSource{Source::testPattern, 5});
    CHECK(parsed<InputSource>(Bytes{0x03}) == InputSource{Source::fpdLink, 0});
    CHECK(parsed<InputSource>(Bytes{0x04}).error().what ==
          "The board's input source is 4, which this program does not know.");
    CHECK(payloadOf(InputSource{Source::testPattern, 1}) == Bytes{0x09});
    CHECK(payloadOf(InputSource{Source::flash, 7}) == Bytes{0x3A});
    CHECK(parsed<TestPattern>(Bytes{0x00}) == TestPattern::solid);
    CHECK(parsed<TestPattern>(Bytes{0x0A}) == TestPattern::stepBars);
    CHECK(!parsed<TestPattern>(Bytes{0x0B}));
    CHECK(payloadOf(TestPattern::checkerboard) == Bytes{0x07});
    const Bytes colours{0x01, 0x02, 0x03, 0x00, 0xFF, 0x03, 0, 0, 0x10, 0, 0, 0x01};
    CHECK(parsed<TestColours>(colours) == TestColours{{513, 3, 1023}, {0, 16, 256}});
    CHECK(payloadOf(TestColours{{513, 3, 1023}, {0, 16, 256}}) == colours);
    CHECK(payloadOf(kTestWhite) == Bytes{255, 3, 255, 3, 255, 3, 255, 3, 255, 3, 255, 3});
    CHECK(!parsed<TestColours>(Bytes(11)));
}

TEST_CASE("dlpc350: troubles are told in words") {
    CHECK(troubles(HardwareStatus{true, false, false, false, false}).empty());
    CHECK(troubles(*parsed<HardwareStatus>(Bytes{0xCC})).size() == 5);
    CHECK(troubles(*parsed<HardwareStatus>(Bytes{0x09})).front().find("swapped by force") != std::string::npos);
    CHECK(remarks(*parsed<Validation>(Bytes{0x1C})).size() == 3);
    CHECK(remarks(Version{{4, 1, 0}, {}, {}, {}}).size() == 1);
    CHECK(remarks(Version{{2, 9, 0}, {}, {}, {}}).front().find("older than 3.0") != std::string::npos);
    CHECK(remarks(Version{{4, 4, 0}, {}, {}, {}}).empty());
}

TEST_CASE("dlpc350: settings that are sent are read back as the same") {
    law("exposure, table length and triggers survive their bytes", [] {
        const ExposurePeriod time{*rc::gen::arbitrary<std::uint32_t>(), *rc::gen::arbitrary<std::uint32_t>()};
        const LutControl control{*rc::gen::inRange(1, 129), *rc::gen::arbitrary<bool>(), *rc::gen::inRange(1, 257),
                                 *rc::gen::inRange(1, 65)};
        const TriggerOut1 out1{*rc::gen::arbitrary<std::uint8_t>(), *rc::gen::arbitrary<std::uint8_t>(),
                               *rc::gen::arbitrary<std::uint8_t>()};
        RC_ASSERT(parsed<ExposurePeriod>(payloadOf(time)) == time);
        RC_ASSERT(parsed<LutControl>(payloadOf(control)) == control);
        RC_ASSERT(parsed<TriggerOut1>(payloadOf(out1)) == out1);
        const InputSource input{static_cast<Source>(*rc::gen::inRange(0, 4)),
                                static_cast<std::uint8_t>(*rc::gen::inRange(0, 8))};
        const auto value = rc::gen::map(rc::gen::inRange(0, 1024), [](int v) { return static_cast<std::uint16_t>(v); });
        const TestColours colours{{*value, *value, *value}, {*value, *value, *value}};
        RC_ASSERT(parsed<InputSource>(payloadOf(input)) == input);
        RC_ASSERT(parsed<TestColours>(payloadOf(colours)) == colours);
    });
}

TEST_CASE("dlpc350: no bytes make a decoder crash, hang or read past their end") {
    law("random replies", [](const Bytes& bytes) { return replyStands(bytes) && everyDecoderStands(bytes); });
    law("random replies behind a plausible header", [] {
        Bytes bytes = *rc::gen::container<Bytes>(static_cast<std::size_t>(*rc::gen::inRange(4, 700)),
                                                 rc::gen::arbitrary<std::uint8_t>());
        bytes[0] = 0xC0;
        bytes[3] = static_cast<std::uint8_t>(*rc::gen::inRange(0, 3));
        return replyStands(bytes);
    });
    for (Fuzz fuzz; fuzz.goesOn();) {
        Bytes bytes = fuzz.bytes(200);
        if (bytes.size() >= 4 && fuzz.number() % 2 == 0) bytes[0] = 0xC0, bytes[3] = 0;
        REQUIRE(replyStands(bytes));
        REQUIRE(everyDecoderStands(bytes));
        const auto lut = parsedLut(bytes, fuzz.below(64));
        REQUIRE((lut || !lut.error().what.empty()));
    }
    for (std::size_t length : {1u, 4u, 8u, 16u, 28u, 60u, 61u, 72u, 124u, 125u, 384u, 512u}) {
        Bytes whole(4 + length, 0x02);
        whole[0] = 0xC0, whole[2] = static_cast<std::uint8_t>(length & 0xFF),
        whole[3] = static_cast<std::uint8_t>(length >> 8);
        for (std::size_t cut = 0; cut <= whole.size(); ++cut)
            CHECK(replyStands(Bytes(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(cut))));
    }
}
