// The output window on a display of its own (Xvfb): exact pixels, the guard below, a server that dies.
#include "tests/devices/video/x_server.h"  // first: Xlib's macros

#undef None
#undef Bool
#undef Status
#undef Success
#undef Always

#include <doctest/doctest.h>

#include <chrono>
#include <thread>

#include "devices/emulators/usb_host.h"
#include "devices/video/display_output.h"
#include "devices/video/white_guard.h"

namespace ilf::devices {
namespace {

using namespace std::chrono_literals;
using test::noise;
using test::OtherProcess;
using test::seen;
using test::XServer;

constexpr Size kRaster{912, 1140};
constexpr const char* kScreen = "912x1140x24";

std::shared_ptr<VideoOutput> output(Size raster = kRaster) { return *displayOutput({{}, raster}); }

/// Until it holds, for five seconds at most.
bool soon(const auto& holds) {
    for (int i = 0; i < 100; ++i) {
        if (holds()) return true;
        std::this_thread::sleep_for(50ms);
    }
    return false;
}

/// Top-level windows that are mapped.
int windows() {
    Display* display = XOpenDisplay(nullptr);
    if (display == nullptr) return 0;
    Window root = 0, parent = 0;
    Window* children = nullptr;
    unsigned count = 0;
    int mapped = 0;
    XQueryTree(display, DefaultRootWindow(display), &root, &parent, &children, &count);
    for (unsigned i = 0; i < count; ++i) {
        XWindowAttributes is{};
        mapped += XGetWindowAttributes(display, children[i], &is) != 0 && is.map_state == IsViewable ? 1 : 0;
    }
    if (children != nullptr) XFree(children);
    XCloseDisplay(display);
    return mapped;
}

#define NEEDS(server)                                                                                                  \
    if (!(server).runs()) {                                                                                            \
        MESSAGE("SKIPPED: Xvfb is not installed, does not start here, or threads are being checked");                  \
        return;                                                                                                        \
    }

TEST_CASE("pixels reach the display as they are, frame after frame") {
    const auto server = XServer::xvfb(kScreen);
    NEEDS(server)
    const auto out = output();
    const auto mode = out->mode();
    REQUIRE_MESSAGE(mode.has_value(), mode.error().what);
    CHECK(mode->size == kRaster);
    CHECK(mode->refresh == 0.0_Hz);  // Xvfb waits for nothing, and nothing else is claimed
    CHECK(seen(0, 0, kRaster) == uniformFrame(kRaster, 255));
    CHECK(out->display().connector == "screen");
    std::chrono::nanoseconds before = std::chrono::steady_clock::now().time_since_epoch();
    for (std::uint32_t seed = 1; seed <= 5; ++seed) {
        const VideoFrame frame = noise(kRaster, seed);
        const auto shown = out->show(frame);
        REQUIRE_MESSAGE(shown.has_value(), shown.error().what);
        CHECK(shown->frame == seed - 1);
        CHECK(shown->at > before);
        before = shown->at;
        CHECK(seen(0, 0, kRaster) == frame);
    }
    CHECK(out->show(noise({911, 1140}, 1)).error().fault == Fault::outOfRange);
    CHECK(seen(0, 0, kRaster) == noise(kRaster, 5));
}

TEST_CASE("another raster than the display's is refused in words") {
    const auto server = XServer::xvfb("1024x768x24");
    NEEDS(server)
    const auto out = output();
    const auto mode = out->mode();
    REQUIRE(!mode);
    CHECK(mode.error().fault == Fault::device);
    CHECK(mode.error().what.find("912x1140") != std::string::npos);
    CHECK(seen(0, 0, {1024, 768}) == uniformFrame({1024, 768}, 0));
    DisplayWish named{{"screen", "", "", ""}, kRaster};
    const auto refused = (*displayOutput(named))->mode();
    REQUIRE(!refused);
    CHECK(refused.error().what.find("operator's screen") != std::string::npos);
    CHECK(displayOutput({{}, {0, 10}}).error().fault == Fault::outOfRange);
}

TEST_CASE("no display server is an error that names what is missing") {
    unsetenv("DISPLAY");
    const auto none = output()->mode();
    REQUIRE(!none);
    CHECK(none.error().what.find("DISPLAY") != std::string::npos);
    CHECK(displays().error().fault == Fault::notFound);
    setenv("DISPLAY", ":9999", 1);
    CHECK(output()->mode().error().what.find(":9999") != std::string::npos);
    unsetenv("DISPLAY");
}

TEST_CASE("what covers the window is below it again at the next call") {
    const auto server = XServer::xvfb(kScreen);
    NEEDS(server)
    const auto out = output();
    const VideoFrame frame = noise(kRaster, 3);
    REQUIRE(out->show(frame).has_value());
    Display* other = XOpenDisplay(nullptr);
    XSetWindowAttributes attributes{};
    attributes.override_redirect = True;
    attributes.background_pixel = 0x123456;
    const Window window = XCreateWindow(other, DefaultRootWindow(other), 100, 100, 300, 300, 0, 24, InputOutput,
                                        nullptr, CWOverrideRedirect | CWBackPixel, &attributes);
    XMapRaised(other, window);
    XSync(other, False);
    CHECK(seen(150, 150, {1, 1}).at(0, 0, 0) == 0x12);
    CHECK(soon([&] { return out->mode() && seen(150, 150, {1, 1}).at(0, 0, 0) != 0x12; }));
    REQUIRE(out->show(frame).has_value());
    CHECK(seen(0, 0, kRaster) == frame);
    XCloseDisplay(other);
}

TEST_CASE("a guard process" * doctest::skip()) {
    CHECK(keepWhite({{}, kRaster}, OtherProcess::kToldFd, [](const std::string&) {}).has_value());
}

TEST_CASE("a player process" * doctest::skip()) {
    const auto out = output();
    const auto shown = out->show(noise(kRaster, 9));
    CHECK_MESSAGE(shown.has_value(), shown.error().what);
    OtherProcess::say(shown ? 'y' : 'n');
    while (true)
        pause();  // until it is killed
}

TEST_CASE("the guard lies below the output in either order, and what it shows is white when the player is killed") {
    const auto server = XServer::xvfb(kScreen);
    NEEDS(server)
    for (const bool guardFirst : {true, false}) {
        CAPTURE(guardFirst);
        std::optional<OtherProcess> guard;
        const auto white = [] { return seen(0, 0, kRaster) == uniformFrame(kRaster, 255); };
        if (guardFirst) {
            guard.emplace("a guard process");
            CHECK(soon(white));
        }
        OtherProcess player("a player process");
        CHECK(player.said() == 'y');
        if (!guardFirst) {
            guard.emplace("a guard process");
            CHECK(soon([] { return windows() >= 2; }));
        }
        CHECK(seen(0, 0, kRaster) == noise(kRaster, 9));
        player.killed();
        CHECK(soon(white));
        CHECK(guard->stopped() == 0);
        CHECK(soon([] { return seen(0, 0, kRaster) == uniformFrame(kRaster, 0); }));
    }
}

TEST_CASE("a server that is killed is an error and not the end; a new one is used, again and again") {
    const auto out = output();
    // A number that no other test's server takes in between: those that choose count from 0.
    const std::string number = std::to_string(1000 + getpid() % 50000);
    std::optional<XServer> server;
    server.emplace(std::vector<std::string>{"Xvfb", "-screen", "0", kScreen}, number);
    NEEDS(*server)
    OtherProcess guard("a guard process");
    for (std::uint32_t round = 0; round < 4; ++round) {
        const VideoFrame frame = noise(kRaster, round);
        REQUIRE(soon([&] { return out->show(frame).has_value(); }));
        CHECK(seen(0, 0, kRaster) == frame);
        server->kill();
        // Found by whichever call comes first.
        const auto gone =
            round % 2 == 0 ? out->show(frame).map([](const auto&) {}) : out->mode().map([](const auto&) {});
        REQUIRE(!gone);
        CHECK(gone.error().fault == Fault::device);
        CHECK(!out->mode());
        server.reset();
        server.emplace(std::vector<std::string>{"Xvfb", "-screen", "0", kScreen}, number);
        REQUIRE(server->runs());
    }
    // The guard has followed as well.
    CHECK(soon([] { return seen(0, 0, kRaster) == uniformFrame(kRaster, 255); }));
    CHECK(guard.stopped() == 0);
}

TEST_CASE("on an emulated USB bus" * doctest::skip()) {
    // Run by the next test in a process of its own.
    const auto host = emulators::UsbHost::started();
    REQUIRE_MESSAGE(host.has_value(), host.error().what);
    const auto out = output();
    const VideoFrame frame = noise(kRaster, 11);
    const auto shown = out->show(frame);
    REQUIRE_MESSAGE(shown.has_value(), shown.error().what);
    CHECK(seen(0, 0, kRaster) == frame);
    OtherProcess::say('y');
}

TEST_CASE("a process that sees an emulated USB bus, and no graphics card, shows its pictures all the same") {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    MESSAGE("SKIPPED: sanitizers want to be preloaded before umockdev");
#else
    const auto server = XServer::xvfb(kScreen);
    NEEDS(server)
    OtherProcess other("on an emulated USB bus", emulators::kUsbPreload);
    CHECK(other.said() == 'y');
    CHECK(other.stopped() == 0);
#endif
}

}  // namespace
}  // namespace ilf::devices
