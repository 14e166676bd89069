#include "devices/video/edid.h"

#include <array>
#include <vector>

#include "tests/devices/video/edid.h"
#include "tests/support/law.h"

namespace ilf::devices {
namespace {

using test::edid;

TEST_CASE("an EDID tells maker, model and serial number") {
    CHECK(identityFromEdid(edid("DLPLCR4500", "A-0017", 5)) == DisplayIdentity{"", "TXN", "DLPLCR4500", "A-0017"});
    // A text of all 13 characters has no end.
    CHECK(identityFromEdid(edid("ABCDEFGHIJKLM", "", 0)).model == "ABCDEFGHIJKLM");
}

TEST_CASE("where an EDID has no text, its numbers stand in") {
    CHECK(identityFromEdid(edid("", "", 4711)) == DisplayIdentity{"", "TXN", "0x4500", "4711"});
    CHECK(identityFromEdid(edid("", "", 0)).serial.empty());
}

TEST_CASE("what is no whole EDID tells nothing") {
    const auto whole = edid("DLPLCR4500", "A-0017", 5);
    for (std::size_t length = 0; length < 128; ++length)
        CHECK(identityFromEdid(std::span(whole).first(length)) == DisplayIdentity{});
    law("any one byte changed is noticed", [&](std::uint8_t change) {
        auto bytes = whole;
        const auto at = *rc::gen::inRange<std::size_t>(0, 128);
        bytes[at] = static_cast<std::uint8_t>(bytes[at] ^ change);
        return change == 0 || identityFromEdid(bytes) == DisplayIdentity{};
    });
    law("any bytes are read without harm, and say nothing that cannot be printed", [](std::vector<std::uint8_t> bytes) {
        bytes.resize(128);
        const std::array<std::uint8_t, 8> header{0, 255, 255, 255, 255, 255, 255, 0};
        std::copy(header.begin(), header.end(), bytes.begin());
        unsigned sum = 0;
        for (std::size_t i = 0; i < 127; ++i)
            sum += bytes[i];
        bytes[127] = static_cast<std::uint8_t>(256U - sum % 256U);
        const auto identity = identityFromEdid(bytes);
        RC_ASSERT(!identity.model.empty());
        for (const char c : identity.maker + identity.model + identity.serial)
            RC_ASSERT(c >= 0x20 && c < 0x7f);
    });
}

}  // namespace
}  // namespace ilf::devices
