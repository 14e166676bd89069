// Which display is the projector's, and above all which is not.
#include "devices/video/found_display.h"

#include "tests/support/law.h"

namespace ilf::devices {
namespace {

constexpr Size kRaster{912, 1140};
constexpr Size kDesk{1920, 1080};

FoundDisplay desk() {
    FoundDisplay d;
    d.identity = {"DP-1", "ACM", "Office 24", "1"};
    d.mode = kDesk;
    d.refresh = 60.0_Hz;
    d.primary = true;
    d.offers = {kDesk, {1024, 768}};
    return d;
}

FoundDisplay projector(const std::string& connector = "HDMI-1", const std::string& serial = "7") {
    FoundDisplay d;
    d.identity = {connector, "TXN", "DLPLCR4500", serial};
    d.mode = kRaster;
    d.refresh = 60.0_Hz;
    d.left = 1920;
    d.offers = {kRaster, {1280, 800}};
    return d;
}

DisplayWish named(DisplayIdentity identity) { return {std::move(identity), kRaster}; }
const DisplayWish kUnnamed{{}, kRaster};

void refused(const Result<ChosenDisplay>& chosen, Fault fault, const std::string& words) {
    REQUIRE(!chosen);
    CHECK(chosen.error().fault == fault);
    CHECK_MESSAGE(chosen.error().what.find(words) != std::string::npos, chosen.error().what);
}

TEST_CASE("the projector is found by who it is, on whatever connector") {
    for (const std::string connector : {"HDMI-1", "HDMI-2", "DP-3"}) {
        const auto chosen = chosenDisplay({desk(), projector(connector)}, named(projector().identity));
        REQUIRE(chosen);
        CHECK(chosen->index == 1);
        CHECK(!chosen->setMode);
    }
    refused(chosenDisplay({desk(), projector("HDMI-1", "8")}, named(projector().identity)), Fault::notFound,
            "not there");
    CHECK(chosenDisplay({desk(), projector()}, kUnnamed)->index == 1);
    CHECK(chosenDisplay({desk(), projector()}, named({"HDMI-1", "", "", ""}))->index == 1);
    refused(chosenDisplay({desk(), projector()}, named({"HDMI-2", "", "", ""})), Fault::notFound, "HDMI-2");
    refused(chosenDisplay({}, kUnnamed), Fault::notFound, "912x1140");
}

TEST_CASE("of several alike the connector decides, and without one nobody guesses") {
    FoundDisplay second = projector("HDMI-2");
    second.left = 2832;
    const std::vector<FoundDisplay> all{desk(), projector("HDMI-1"), second};
    CHECK(chosenDisplay(all, named(second.identity))->index == 2);
    refused(chosenDisplay(all, named({"", "TXN", "", ""})), Fault::notFound, "HDMI-1");
    refused(chosenDisplay(all, named({"DP-7", "TXN", "DLPLCR4500", ""})), Fault::notFound, "Several");
    refused(chosenDisplay(all, kUnnamed), Fault::notFound, "HDMI-2");
}

TEST_CASE("another mode is set where that cannot be the operator's screen, and where the display has it") {
    FoundDisplay small = projector();
    small.mode = {1280, 800};
    CHECK(chosenDisplay({desk(), small}, named(small.identity))->setMode);
    CHECK(chosenDisplay({desk(), small}, kUnnamed)->setMode);
    FoundDisplay nobody = desk();
    nobody.primary = false;
    refused(chosenDisplay({nobody, small}, kUnnamed), Fault::notFound, "name its display");
    FoundDisplay scaled = projector();
    scaled.plain = false;
    CHECK(chosenDisplay({desk(), scaled}, kUnnamed)->setMode);
    small.offers = {{1280, 800}};
    refused(chosenDisplay({desk(), small}, named(small.identity)), Fault::unsupported, "1280x800");
}

TEST_CASE("a display that is switched off stays off, unless it was only unplugged") {
    FoundDisplay off = projector();
    off.mode = {};
    refused(chosenDisplay({desk(), off}, named(off.identity)), Fault::notFound, "switched off");
    CHECK(chosenDisplay({desk(), off}, named(off.identity), true)->setMode);
}

TEST_CASE("a lone display of exactly the raster is the projector's own") {
    FoundDisplay alone = projector();
    alone.primary = true;
    CHECK(chosenDisplay({alone}, kUnnamed)->index == 0);
    alone.mode = {1280, 800};
    refused(chosenDisplay({alone}, named(alone.identity)), Fault::unsafe, "operator's screen");
    refused(chosenDisplay({alone}, kUnnamed), Fault::notFound, "912x1140");
}

TEST_CASE("a mirrored display shows the operator's screen") {
    FoundDisplay mirror = projector();
    mirror.left = 0;
    refused(chosenDisplay({desk(), mirror}, kUnnamed), Fault::unsafe, "mirroring");
    refused(chosenDisplay({desk(), mirror}, named(mirror.identity)), Fault::unsafe, "mirroring");
}

TEST_CASE("never the operator's screen, whatever is attached and whatever is wished") {
    law("of random desktops", [] {
        std::vector<FoundDisplay> all;
        const auto count = *rc::gen::inRange(1, 5);
        const auto primary = *rc::gen::inRange(-1, count);
        for (int i = 0; i < count; ++i) {
            FoundDisplay d = projector(*rc::gen::element<std::string>("A", "B", "C"), "");
            d.identity.model = *rc::gen::element<std::string>("M", "N");
            d.mode = *rc::gen::element(Size{}, kRaster, kDesk);
            d.left = *rc::gen::element(0, 900, 912, 1920, 4000);
            d.primary = i == primary;
            d.plain = *rc::gen::arbitrary<bool>();
            if (*rc::gen::arbitrary<bool>()) d.offers.clear();
            all.push_back(d);
        }
        DisplayWish wish = kUnnamed;
        if (*rc::gen::arbitrary<bool>()) wish.display = all[*rc::gen::inRange<std::size_t>(0, all.size())].identity;
        const auto chosen = chosenDisplay(all, wish, *rc::gen::arbitrary<bool>());
        if (!chosen) {
            RC_ASSERT(!chosen.error().what.empty());
            return;
        }
        const FoundDisplay& d = all[chosen->index];
        int others = 0;
        for (std::size_t i = 0; i < all.size(); ++i) {
            if (i == chosen->index || all[i].mode == Size{}) continue;
            ++others;
            const bool apart =
                d.mode == Size{} || d.left >= all[i].left + all[i].mode.width || all[i].left >= d.left + d.mode.width;
            RC_ASSERT(apart);
        }
        RC_ASSERT(others == 0 || !d.primary);
        RC_ASSERT(others > 0 || d.mode == kRaster || d.mode == Size{});
        RC_ASSERT(chosen->setMode == (d.mode != kRaster || !d.plain));
    });
}

}  // namespace
}  // namespace ilf::devices
