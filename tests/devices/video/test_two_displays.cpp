// Two displays of a graphics card that is not there (Xorg's dummy driver): the operator's and the projector's.
#include "tests/devices/video/x_server.h"  // first: Xlib's macros

#include <X11/Xatom.h>
#include <X11/extensions/Xrandr.h>

#undef None
#undef Bool
#undef Status
#undef Success
#undef Always

#include <doctest/doctest.h>

#include <chrono>
#include <thread>

#include "devices/video/display_output.h"
#include "devices/video/x_displays.h"
#include "tests/devices/video/edid.h"

namespace ilf::devices {
namespace {

using namespace std::chrono_literals;
using test::noise;
using test::seen;
using test::TwoDisplays;

constexpr Size kRaster{912, 1140};
constexpr Size kDesk{1024, 768};
const VideoFrame kUntouched = uniformFrame(kDesk, 0);

bool soon(const auto& holds) {
    for (int i = 0; i < 100; ++i) {
        if (holds()) return true;
        std::this_thread::sleep_for(50ms);
    }
    return false;
}

std::shared_ptr<VideoOutput> output(const std::string& connector = "") {
    return *displayOutput({{connector, "", "", ""}, kRaster});
}

/// Whether the display's gamma ramp is a straight line.
bool straight(const std::string& connector) {
    const auto x = *XConnection::open();
    const auto all = *xDisplays(*x);
    for (const XDisplay& display : all) {
        if (display.found.identity.connector != connector) continue;
        XRRCrtcGamma* ramp = XRRGetCrtcGamma(x->get(), display.crtc);
        bool is = ramp != nullptr && ramp->size > 1;
        for (int i = 0; is && i < ramp->size; ++i)
            for (const unsigned short value : {ramp->red[i], ramp->green[i], ramp->blue[i]})
                is &= std::abs(65535L * i / (ramp->size - 1) - value) <= 256;
        if (ramp != nullptr) XRRFreeGamma(ramp);
        return is;
    }
    return false;
}

RROutput outputOf(const XConnection& x, const std::string& connector) {
    XRRScreenResources* resources = XRRGetScreenResourcesCurrent(x.get(), x.root());
    RROutput found = 0;
    for (int i = 0; i < resources->noutput; ++i) {
        XRROutputInfo* info = XRRGetOutputInfo(x.get(), resources, resources->outputs[i]);
        if (connector == info->name) found = resources->outputs[i];
        XRRFreeOutputInfo(info);
    }
    XRRFreeScreenResources(resources);
    return found;
}

/// Gives the display on a connector an EDID of its own; nothing: takes it away.
void tell(const std::string& connector, const std::vector<std::uint8_t>& edid) {
    const auto x = *XConnection::open();
    const Atom property = XInternAtom(x->get(), RR_PROPERTY_RANDR_EDID, False);
    XRRChangeOutputProperty(x->get(), outputOf(*x, connector), property, XA_INTEGER, 8, PropModeReplace, edid.data(),
                            static_cast<int>(edid.size()));
    REQUIRE(x->accepted());
}

#define NEEDS(card)                                                                                                    \
    if (!(card).runs()) {                                                                                              \
        MESSAGE("SKIPPED: Xorg with its dummy driver, xrandr, and root are needed for two displays, and no checker "   \
                "of threads");                                                                                         \
        return;                                                                                                        \
    }

TEST_CASE("both displays are told apart, and pictures go to the projector's alone") {
    const TwoDisplays card;
    NEEDS(card)
    card.plug("DUMMY1");
    card.switchOn("DUMMY1");
    const auto all = displays();
    REQUIRE(all.has_value());
    REQUIRE(all->size() == 2);
    CHECK((*all)[0].identity.connector == "DUMMY0");
    CHECK((*all)[0].primary);
    CHECK((*all)[1].mode == kRaster);
    CHECK((*all)[1].left == kDesk.width);
    CHECK((*all)[1].refresh.si() == doctest::Approx(60.0).epsilon(1e-4));

    const auto out = output();
    const VideoFrame frame = noise(kRaster, 2);
    const auto shown = out->show(frame);
    REQUIRE_MESSAGE(shown.has_value(), shown.error().what);
    CHECK(out->display().connector == "DUMMY1");
    CHECK(seen(kDesk.width, 0, kRaster) == frame);
    CHECK(seen(0, 0, kDesk) == kUntouched);
    CHECK(out->mode()->refresh == 0.0_Hz);  // the card that is not there has no vertical sync to wait for
}

TEST_CASE("the operator's screen is refused by any name") {
    const TwoDisplays card;
    NEEDS(card)
    CHECK(!output()->mode());
    REQUIRE(card.xrandr("--addmode DUMMY0 projector"));  // the operator's could show the raster, too
    CHECK(!output()->mode());
    const auto alone = output("DUMMY0")->mode();
    REQUIRE(!alone);
    CHECK(alone.error().what.find("only display") != std::string::npos);
    card.plug("DUMMY1");
    card.switchOn("DUMMY1");
    const auto primary = output("DUMMY0")->mode();
    REQUIRE(!primary);
    CHECK(primary.error().what.find("primary") != std::string::npos);
    card.switchOn("DUMMY1", "--same-as DUMMY0");
    const auto mirrored = output("DUMMY1")->mode();
    REQUIRE(!mirrored);
    CHECK(mirrored.error().what.find("mirror") != std::string::npos);
    CHECK(seen(0, 0, kDesk) == kUntouched);
}

TEST_CASE("a display in another mode, scaled or with a night light is set right") {
    const TwoDisplays card;
    NEEDS(card)
    card.plug("DUMMY1");
    card.plug("DUMMY1", "800x600");
    REQUIRE(card.xrandr("--output DUMMY1 --mode 800x600 --left-of DUMMY0 --gamma 1:0.7:0.5"));
    CHECK(!straight("DUMMY1"));
    const auto out = output("DUMMY1");
    const VideoFrame frame = noise(kRaster, 4);
    const auto shown = out->show(frame);
    REQUIRE_MESSAGE(shown.has_value(), shown.error().what);
    const auto all = displays();
    REQUIRE(all->size() == 2);
    CHECK((*all)[1].mode == kRaster);
    CHECK((*all)[1].plain);
    CHECK(seen((*all)[1].left, (*all)[1].top, kRaster) == frame);
    CHECK(straight("DUMMY1"));
    // 800 was the operator's left edge: the larger mode lies where it covers nothing of that.
    CHECK((*all)[1].left >= (*all)[0].left + kDesk.width);
    CHECK(seen((*all)[0].left, (*all)[0].top, kDesk) == kUntouched);
}

TEST_CASE("switched off it is an error on which nothing is shown, and back it is used again, wherever it lies then") {
    const TwoDisplays card;
    NEEDS(card)
    card.plug("DUMMY1");
    card.plug("DUMMY2");
    card.switchOn("DUMMY1");
    const auto out = output();
    const VideoFrame frame = noise(kRaster, 6);
    for (int round = 0; round < 3; ++round) {
        CAPTURE(round);
        REQUIRE(soon([&] { return out->show(frame).has_value(); }));
        const FoundDisplay where = displays()->at(1);
        CHECK(seen(where.left, where.top, kRaster) == frame);
        card.switchOff("DUMMY1");
        const auto gone = out->mode();
        REQUIRE(!gone);
        CHECK(gone.error().fault == Fault::device);
        CHECK(!out->show(frame));
        CHECK(seen(0, 0, kDesk) == kUntouched);
        // Another one of the same raster in its place is not the same.
        card.switchOn("DUMMY2");
        std::this_thread::sleep_for(600ms);  // it is looked for again
        CHECK(!out->mode());
        CHECK(displays()->at(1).mode == Size{});  // and not switched on behind the operator's back
        CHECK(seen(kDesk.width, 0, kRaster) == uniformFrame(kRaster, 0));
        card.switchOn("DUMMY1", round == 0 ? "--right-of DUMMY2" : "--below DUMMY0");
        if (round == 0) continue;
        card.switchOff("DUMMY2");
    }
    CHECK(soon([&] { return out->show(frame).has_value(); }));
}

TEST_CASE("of two alike the one of the right serial number is taken, and followed from connector to connector") {
    const TwoDisplays card;
    NEEDS(card)
    for (const std::string connector : {"DUMMY1", "DUMMY2"})
        card.plug(connector);
    card.switchOn("DUMMY1");
    card.switchOn("DUMMY2", "--right-of DUMMY1");
    tell("DUMMY1", test::edid("DLPLCR4500", "A-1", 0));
    tell("DUMMY2", test::edid("DLPLCR4500", "A-2", 0));
    CHECK(displays()->at(2).identity == DisplayIdentity{"DUMMY2", "TXN", "DLPLCR4500", "A-2"});

    const auto out = *displayOutput({{"", "TXN", "", "A-2"}, kRaster});
    const VideoFrame frame = noise(kRaster, 12);
    const auto shown = out->show(frame);
    REQUIRE_MESSAGE(shown.has_value(), shown.error().what);
    CHECK(out->display().connector == "DUMMY2");
    CHECK(seen(kDesk.width + kRaster.width, 0, kRaster) == frame);
    CHECK(seen(kDesk.width, 0, kRaster) == uniformFrame(kRaster, 0));

    // Its cable goes from one connector to the other, and the other display's the other way round.
    for (const std::string connector : {"DUMMY1", "DUMMY2"})
        card.switchOff(connector);
    CHECK(!out->mode());
    tell("DUMMY1", test::edid("DLPLCR4500", "A-2", 0));
    tell("DUMMY2", test::edid("DLPLCR4500", "A-1", 0));
    card.switchOn("DUMMY2");
    std::this_thread::sleep_for(600ms);
    CHECK(!out->mode());
    card.switchOn("DUMMY1", "--right-of DUMMY2");
    REQUIRE(soon([&] { return out->show(frame).has_value(); }));
    CHECK(out->display() == DisplayIdentity{"DUMMY1", "TXN", "DLPLCR4500", "A-2"});
    CHECK(seen(kDesk.width + kRaster.width, 0, kRaster) == frame);
    CHECK(seen(kDesk.width, 0, kRaster) == uniformFrame(kRaster, 0));
}

TEST_CASE("a driver that offers full-range RGB and no dithering is told so, and nothing it does not offer") {
    const TwoDisplays card;
    NEEDS(card)
    card.plug("DUMMY1");
    card.switchOn("DUMMY1");
    const auto x = *XConnection::open();
    const RROutput output1 = outputOf(*x, "DUMMY1");
    const auto atom = [&](const char* name) { return XInternAtom(x->get(), name, False); };
    const auto offer = [&](const char* name, std::vector<long> values) {
        XRRConfigureOutputProperty(x->get(), output1, atom(name), False, False, static_cast<int>(values.size()),
                                   values.data());
        const Atom first = static_cast<Atom>(values.front());
        XRRChangeOutputProperty(x->get(), output1, atom(name), XA_ATOM, 32, PropModeReplace,
                                reinterpret_cast<const unsigned char*>(&first), 1);
    };
    const auto is = [&](const char* name) {
        Atom type = 0;
        int format = 0;
        unsigned long items = 0, left = 0;
        unsigned char* bytes = nullptr;
        XRRGetOutputProperty(x->get(), output1, atom(name), 0, 1, False, False, XA_ATOM, &type, &format, &items, &left,
                             &bytes);
        char* value =
            bytes != nullptr && items == 1 ? XGetAtomName(x->get(), *reinterpret_cast<Atom*>(bytes)) : nullptr;
        const std::string name_ = value != nullptr ? value : "";
        if (value != nullptr) XFree(value);
        if (bytes != nullptr) XFree(bytes);
        return name_;
    };
    const auto value = [&](const char* name) { return static_cast<long>(atom(name)); };
    offer("Broadcast RGB", {value("Automatic"), value("Full"), value("Limited 16:235")});
    offer("dithering mode", {value("auto"), value("off")});
    offer("underscan", {value("auto"), value("on")});
    REQUIRE(x->accepted());
    REQUIRE(is("Broadcast RGB") == "Automatic");
    const auto out = output();
    REQUIRE(out->mode().has_value());
    CHECK(is("Broadcast RGB") == "Full");
    CHECK(is("dithering mode") == "off");
    CHECK(is("underscan") == "auto");

    // A night light that sets in later is noticed within a second.
    REQUIRE(card.xrandr("--output DUMMY1 --gamma 1:0.7:0.5"));
    CHECK(soon([&] { return out->mode() && straight("DUMMY1"); }));
}

TEST_CASE("a display moved under the window is an error, and found again where it is") {
    const TwoDisplays card;
    NEEDS(card)
    card.plug("DUMMY1");
    card.switchOn("DUMMY1");
    const auto out = output();
    const VideoFrame frame = noise(kRaster, 7);
    REQUIRE(out->show(frame).has_value());
    card.switchOn("DUMMY1", "--pos 2000x100");
    const auto moved = out->show(frame);
    REQUIRE(!moved);
    CHECK(moved.error().what.find("moved") != std::string::npos);
    REQUIRE(out->show(frame).has_value());
    CHECK(seen(2000, 100, kRaster) == frame);
}

TEST_CASE("a display that came back switched off is switched on beside the others") {
    const TwoDisplays card;
    NEEDS(card)
    card.plug("DUMMY1");
    const auto x = *XConnection::open();
    const auto off = *xDisplays(*x);
    REQUIRE(off.size() == 2);
    REQUIRE(off[1].found.mode == Size{});
    const auto done = setRaster(*x, off, off[1], kRaster);
    REQUIRE_MESSAGE(done.has_value(), done.error().what);
    const auto on = displays()->at(1);
    CHECK(on.mode == kRaster);
    CHECK(on.left == kDesk.width);
    CHECK(on.plain);
    CHECK(output()->show(noise(kRaster, 1)).has_value());
}

TEST_CASE("two displays that both could be the projector's are not guessed between") {
    const TwoDisplays card;
    NEEDS(card)
    for (const std::string output : {"DUMMY1", "DUMMY2"})
        card.plug(output);
    card.switchOn("DUMMY1");
    card.switchOn("DUMMY2", "--right-of DUMMY1");
    const auto both = output()->mode();
    REQUIRE(!both);
    CHECK(both.error().what.find("DUMMY1, DUMMY2") != std::string::npos);
    const auto out = output("DUMMY2");
    const auto shown = out->show(noise(kRaster, 8));
    REQUIRE_MESSAGE(shown.has_value(), shown.error().what);
    CHECK(seen(kDesk.width + kRaster.width, 0, kRaster) == noise(kRaster, 8));
    CHECK(seen(kDesk.width, 0, kRaster) == uniformFrame(kRaster, 0));
}

}  // namespace
}  // namespace ilf::devices
