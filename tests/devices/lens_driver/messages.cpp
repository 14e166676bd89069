#include "devices/lens_driver/messages.h"

#include <doctest/doctest.h>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/fuzz.h"
#include "tests/support/law.h"

namespace ilf::devices::lens_driver {
namespace {

using Hex = std::vector<int>;

Bytes bytes(const Hex& hex) {
    Bytes all;
    for (const int byte : hex)
        all.push_back(static_cast<std::uint8_t>(byte));
    return all;
}

Bytes drawn() {
    const auto values = *rc::gen::container<std::vector<int>>(rc::gen::inRange(0, 256));
    return bytes(values);
}

const std::vector<Answer>& everyAnswer() {
    static const std::vector<Answer> all{{},
                                         readFirmwareType().answer,
                                         readVersion().answer,
                                         readLensSerial().answer,
                                         readMaxCurrent().answer,
                                         readCurrent().answer,
                                         readMode().answer,
                                         readFrequency().answer,
                                         readTemperature().answer,
                                         readStatus().answer,
                                         setMode(Mode::current).answer,
                                         setMode(Mode::focalPower).answer,
                                         setTemperatureLimits(20, 40).answer};
    return all;
}

void decodeAll(View data) {
    firmwareTypeFrom(data);
    versionFrom(data);
    lensSerialFrom(data);
    maxCurrentFrom(data);
    codeFrom(data);
    modeFrom(data);
    frequencyFrom(data);
    temperatureFrom(data);
    statusFrom(data);
    for (const char type : {'A', 'C', 'D', '\0'})
        powerRangeFrom(data, type);
}

}  // namespace

// Published as "1398", which is 0x0576; the published bytes, whose CRCs are right, say 0x057A = 1402.
TEST_CASE("lens driver messages: the published examples come out byte by byte") {
    CHECK(setCurrent(0).bytes == bytes({0x41, 0x77, 0x00, 0x00, 0xA4, 0x26}));
    CHECK(setCurrent(1402).bytes == bytes({0x41, 0x77, 0x05, 0x7A, 0x26, 0x95}));
    CHECK(setMode(Mode::current).bytes == bytes({0x4D, 0x77, 0x44, 0x41, 0x54, 0x46}));
    CHECK(setMode(Mode::sine).bytes == bytes({0x4D, 0x77, 0x53, 0x41, 0x5B, 0xB6}));
    CHECK(setMode(Mode::focalPower).bytes == bytes({0x4D, 0x77, 0x43, 0x41, 0x56, 0x76}));
    CHECK(setFrequency(60'000).bytes == bytes({0x50, 0x77, 0x46, 0x41, 0x00, 0x00, 0xEA, 0x60, 0x7F, 0xDA}));
    CHECK(setFrequency(100'000).bytes == bytes({0x50, 0x77, 0x46, 0x41, 0x00, 0x01, 0x86, 0xA0, 0x03, 0x4A}));
    CHECK(setUpperSwing(1402).bytes == bytes({0x50, 0x77, 0x55, 0x41, 0x05, 0x7A, 0x00, 0x00, 0x13, 0x24}));
    CHECK(setLowerSwing(-1402).bytes == bytes({0x50, 0x77, 0x4C, 0x41, 0xFA, 0x86, 0x00, 0x00, 0xE1, 0x09}));
    CHECK(setFocalPower(1000).bytes == bytes({0x50, 0x77, 0x44, 0x41, 0x03, 0xE8, 0x00, 0x00, 0xB1, 0x00}));
    CHECK(readTemperature().bytes == bytes({0x54, 0x43, 0x41, 0xB0, 0xD0}));
    CHECK(readStatus().bytes == bytes({0x53, 0x72, 0xBC, 0xD5}));
    CHECK(readVersion().bytes == bytes({0x56, 0x80, 0x3E}));
    CHECK(readMaxCurrent().bytes == bytes({0x43, 0x72, 0x4D, 0x41, 0x00, 0x00, 0x71, 0x80}));
}

TEST_CASE("lens driver messages: the mode query has the right CRC and not the official example's") {
    CHECK(readMode().bytes == bytes({0x4D, 0x4D, 0x41, 0x65, 0x77}));
}

TEST_CASE("lens driver messages: CRC-16/ARC has its published check value, and is 0 over message and CRC") {
    const std::string check = "123456789";
    CHECK(crc16(Bytes(check.begin(), check.end())) == 0xBB3D);
    CHECK(crc16(setCurrent(1398).bytes) == 0);
}

TEST_CASE("lens driver messages: currents beyond full scale are clamped in the bytes themselves") {
    CHECK(setCurrent(100'000).bytes == setCurrent(4095).bytes);
    CHECK(setCurrent(-100'000).bytes == setCurrent(-4095).bytes);
    CHECK(setUpperSwing(5000).bytes == setUpperSwing(4095).bytes);
    CHECK(setLowerSwing(-5000).bytes == setLowerSwing(-4095).bytes);
    CHECK(setCurrent(4095).bytes[2] == 0x0F);
    CHECK(setCurrent(4095).bytes[3] == 0xFF);
}

TEST_CASE("lens driver messages: an answer is found by its length, even with a line end in its data") {
    // TCA 0x0D0A: 208.6 degrees, which the decoder then refuses; the frame must not break there.
    Bytes answer = bytes({'T', 'C', 'A', 0x0D, 0x0A});
    const auto crc = crc16(answer);
    answer.push_back(static_cast<std::uint8_t>(crc & 0xFF));
    answer.push_back(static_cast<std::uint8_t>(crc >> 8));
    answer.push_back('\r');
    answer.push_back('\n');
    const auto frame = framed(answer, readTemperature().answer);
    CHECK(frame.kind == Frame::Kind::answer);
    CHECK(frame.used == 9);
    CHECK(frame.data == bytes({0x0D, 0x0A}));
}

TEST_CASE("lens driver messages: every truncation of an answer waits for more") {
    const Bytes error = bytes({0x45, 0x01, 0xF3, 0x50, 0x0D, 0x0A});
    for (std::size_t length = 0; length < error.size(); ++length)
        CHECK(framed(View(error).first(length), readMode().answer).kind == Frame::Kind::more);
    const auto frame = framed(error, readMode().answer);
    CHECK(frame.kind == Frame::Kind::error);
    CHECK(frame.error == 1);
    CHECK(frame.used == 6);
    CHECK(errorWords(1).find("USB cable") != std::string::npos);
    const Bytes old = bytes({'N', '\r', '\n'});
    CHECK(framed(View(old).first(2), readMode().answer).kind == Frame::Kind::more);
    CHECK(framed(old, readMode().answer).kind == Frame::Kind::unknown);
    for (const auto& expected : everyAnswer()) {
        if (expected.first == 0) continue;
        Bytes answer(static_cast<std::size_t>(expected.letters + expected.data),
                     static_cast<std::uint8_t>(expected.first));
        const auto crc = crc16(answer);
        for (const unsigned byte : {unsigned{crc} & 0xFFU, unsigned{crc} >> 8, 13U, 10U})
            answer.push_back(static_cast<std::uint8_t>(byte));
        for (std::size_t length = 0; length < answer.size(); ++length)
            CHECK(framed(View(answer).first(length), expected).kind == Frame::Kind::more);
        CHECK(framed(answer, expected).kind == Frame::Kind::answer);
        CHECK(framed(answer, expected).data.size() == static_cast<std::size_t>(expected.data));
    }
}

TEST_CASE("lens driver messages: both known lengths of the status answer are taken") {
    for (const Hex& letters : {Hex{'S'}, Hex{'S', 'r'}}) {
        Hex hex = letters;
        for (const int byte : {0, 0, 1, 0x24})
            hex.push_back(byte);
        Bytes answer = bytes(hex);
        const auto crc = crc16(answer);
        for (const unsigned byte : {unsigned{crc} & 0xFFU, unsigned{crc} >> 8, 13U, 10U})
            answer.push_back(static_cast<std::uint8_t>(byte));
        const auto frame = framed(answer, readStatus().answer);
        REQUIRE(frame.kind == Frame::Kind::answer);
        const auto status = statusFrom(frame.data);
        REQUIRE(status);
        CHECK(status->noTemperatureLimits);
        CHECK(status->outsideTemperature);
        CHECK(status->incompatible);
        CHECK_FALSE(status->hardware);
        CHECK(words(*status).size() == 3);
    }
}

TEST_CASE("lens driver messages: random bytes neither crash a decoder nor stop the framing") {
    law("framing always takes bytes off or asks for more", [] {
        const Bytes data = drawn();
        for (const auto& expected : everyAnswer()) {
            View left(data);
            while (!left.empty()) {
                const auto frame = framed(left, expected);
                RC_ASSERT(frame.used <= left.size());
                if (frame.kind == Frame::Kind::more) break;
                RC_ASSERT(frame.used > 0U);
                if (frame.kind == Frame::Kind::answer) decodeAll(frame.data);
                left = left.subspan(frame.used);
            }
        }
        decodeAll(data);
    });
    law("decoders read no more than they are given", [] {
        const auto length = *rc::gen::inRange<std::size_t>(0, 12);
        // Exactly as long as said, so that reading beyond it is seen.
        const Bytes data = *rc::gen::container<Bytes>(length, rc::gen::arbitrary<std::uint8_t>());
        decodeAll(data);
    });
}

TEST_CASE("lens driver messages: a hundred thousand random messages each end in a frame, noise or a wait for more") {
    std::size_t answers = 0;
    for (Fuzz fuzz; fuzz.goesOn();) {
        Bytes data = fuzz.bytes(24);
        const auto& expected = everyAnswer()[fuzz.below(everyAnswer().size())];
        // Most start as they should and end with a line, so that they get past the first look.
        if (!data.empty() && fuzz.below(4) != 0) data[0] = static_cast<std::uint8_t>(expected.first);
        const auto length = static_cast<std::size_t>(expected.letters + expected.data) + 4;
        if (data.size() >= length && fuzz.below(2) != 0) {
            const auto crc = crc16(View(data).first(length - 4));
            data[length - 4] = static_cast<std::uint8_t>(crc & 0xFF);
            data[length - 3] = static_cast<std::uint8_t>(crc >> 8);
            data[length - 2] = '\r';
            data[length - 1] = '\n';
        }
        const auto frame = framed(data, expected);
        REQUIRE(frame.used <= data.size());
        REQUIRE((frame.kind == Frame::Kind::more) == (frame.used == 0));
        if (frame.kind == Frame::Kind::answer) {
            ++answers;
            decodeAll(frame.data);
        }
        decodeAll(data);
    }
    CHECK(answers > 1000);
}

TEST_CASE("lens driver messages: values as the reference gives them") {
    CHECK(maxCurrentFrom(bytes({0x72, 0x64}))->si() == doctest::Approx(0.29284));
    CHECK(*temperatureFrom(bytes({0x01, 0xE0})) == doctest::Approx(30.0));
    CHECK(*temperatureFrom(bytes({0xFF, 0xF0})) == doctest::Approx(-1.0));
    CHECK(frequencyFrom(bytes({0x00, 0x00, 0xEA, 0x60}))->si() == doctest::Approx(60.0));
    CHECK(*codeFrom(bytes({0xFA, 0x86})) == -1402);
    CHECK(*modeFrom(bytes({5})) == Mode::focalPower);
    CHECK(modeFrom(bytes({0})).error().fault == Fault::badFile);
    CHECK(modeFrom(bytes({8})).error().fault == Fault::badFile);
    CHECK(*versionFrom(bytes({1, 2, 1, 3, 0, 9})) == Version{1, 2, 259, 9});
    CHECK(lensSerialFrom(bytes({'A', 'N', 'A', 'B', '1', '2', '3', '4'})).value() == "ANAB1234");
    CHECK(lensSerialFrom(Bytes(8, 0)).value().empty());
    CHECK_FALSE(temperatureFrom(bytes({0x7F, 0xFF})));
    CHECK_FALSE(maxCurrentFrom(bytes({0, 0})));
}

TEST_CASE("lens driver messages: focal powers are coded as their firmware type wants them") {
    CHECK(powerCode(0.0_D, 'A') == 1000);
    CHECK(powerCode(-5.0_D, 'A') == 0);
    CHECK(powerCode(2.5_D, 'A') == 1500);
    for (const char type : {'B', 'C', 'E', 'F'}) {
        CHECK(powerCode(0.0_D, type) == 0);
        CHECK(powerCode(2.5_D, type) == 500);
        CHECK(powerCode(-2.5_D, type) == -500);
    }
    CHECK_FALSE(powerCode(0.0_D, 'D'));
    CHECK_FALSE(powerOf(0, 'D'));
    CHECK_FALSE(powerCode(Dioptre::fromSi(std::nan("")), 'A'));
    CHECK_FALSE(powerCode(1000.0_D, 'F'));
    law("a power and its code agree to half a step", [] {
        const double power = *rc::gen::inRange(-15'000, 15'000) * 1e-3;
        for (const char type : {'A', 'B', 'C', 'E', 'F'}) {
            const auto code = powerCode(Dioptre::fromSi(power), type);
            RC_ASSERT(code.has_value());
            RC_ASSERT(std::abs(powerOf(*code, type)->si() - power) <= 0.0025 + 1e-9);
        }
    });
}

TEST_CASE("lens driver messages: currents and codes agree, and never leave full scale") {
    const Ampere most = Ampere::fromSi(0.29284);
    CHECK(codeOf(most, most) == 4095);
    CHECK(codeOf(-most, most) == -4095);
    CHECK(codeOf(Ampere::fromSi(9.0), most) == 4095);
    CHECK(codeOf(Ampere::fromSi(std::nan("")), most) == 0);
    CHECK(codeOf(Ampere::fromSi(0.1), most) == 1398);
    CHECK(currentOf(-4095, most) == -most);
}

}  // namespace ilf::devices::lens_driver
