// The whole core over an emulated rig: real USB drivers, a real window, and light as the emulated projector had it.
#include <optional>

#include "devices/dlpc350/lightcrafter.h"
#include "devices/tape/usb_tape.h"
#include "tests/process/emulated_rig.h"

using namespace ilf;
using namespace ilf::test;
using devices::LightMode;
using devices::Status;

namespace {

bool ended(const OutputCore& core) {
    const auto deadline = Clock::now() + seconds(10);
    const auto any = [&] { return core.supervisor() + core.player() + core.devicesPid() + core.guard() != 0; };
    while (any() && Clock::now() < deadline)
        std::this_thread::sleep_for(milliseconds(20));
    return !any();
}

/// Tapes of board and box, each whole although its player may have been killed. The driver that meets a tape of the
/// board does the same again, at least where no cable was pulled while it was opened.
void checkTapes(const OutputCore& core) {
    int boards = 0, boxes = 0, again = 0;
    for (const auto& file : std::filesystem::directory_iterator(core.tapes())) {
        const auto tape = devices::loadTape(file.path());
        REQUIRE_MESSAGE(tape.has_value(), (tape ? "" : tape.error().what));
        const bool board = tape->of("product") == "6401";
        ++(board ? boards : boxes);
        if (!board) continue;
        auto link = devices::ReplayLink::of(*tape);
        REQUIRE(link);
        if (devices::dlpc350::LightCrafter::open(*std::move(link), devices::Clock::steady())) ++again;
    }
    CHECK(boards > 0);
    CHECK(boxes > 0);
    CHECK(again > 0);
}

}  // namespace

TEST_CASE(
    "emulated core: a program is slotted light; whoever is killed, the light is white, the lens rests, and stays") {
#if defined(__SANITIZE_THREAD__)
    MESSAGE("SKIPPED: the thread sanitizer cannot judge umockdev's and GLib's own threads");
    return;
#endif
    OutputCore core("datasheet", "emulated", false, true);
    auto link = core.connected();
    if (!ready(link)) return;
    CHECK(link.status().emulated);
    CHECK(link.status().light == LightMode::steady);
    int black = 0;
    CHECK(becomesSafe(core, seconds(5), 0.0_D, black));
    CHECK(black == 0);

    std::uint64_t revision = 0;
    taken(link, shown(1), revision);
    REQUIRE(OutputCore::until(link, seconds(5), [](const Status& s) { return s.timing && s.timing->locked; }));
    CHECK(link.status().light == LightMode::slotted);
    {
        auto client = core.devicesClient();
        std::optional<Seen> now;
        for (int i = 0; i < 100 && !(now && now->darkest == 0); ++i)
            now = seen(client);
        REQUIRE(now);
        CHECK(now->received.patterns);
        CHECK(now->received.exposures.size() == 6);
        CHECK(now->darkest == 0);
        CHECK_FALSE(now->received.harmed);
        CHECK(now->received.ledCurrentWrites == 0);
    }

    SUBCASE("the player killed") {
        const int killed = link.status().pid;
        kill(killed, SIGKILL);
        black = 0;
        CHECK(becomesSafe(core, seconds(8), kRest, black));
        CHECK(black == 0);
        REQUIRE(OutputCore::until(link, seconds(8), [&](const Status& s) { return s.connected && s.pid != killed; }));
        CHECK(link.status().hold != 0);
        CHECK(link.status().fault.find("ended unexpectedly") != std::string::npos);
        // Live updates light nothing; a take does.
        REQUIRE(link.send(shown(2), ++revision, devices::Why::live).has_value());
        REQUIRE(OutputCore::until(link, seconds(5), [](const Status& s) { return !s.lastRefusal.empty(); }));
        CHECK(link.status().light == LightMode::steady);
        REQUIRE(ready(link));
        taken(link, shown(2), revision);
    }
    SUBCASE("player and supervisor killed: the guard sees to it") {
        kill(core.supervisor(), SIGKILL);
        kill(link.status().pid, SIGKILL);
        black = 0;
        CHECK(becomesSafe(core, seconds(8), kRest, black));
        CHECK(black == 0);
        core.start();
        auto next = core.connected();
        CHECK(next.status().hold != 0);
        CHECK(next.status().light == LightMode::steady);
    }
    SUBCASE("the display lost, then player and supervisor killed: the board's own white stays, until there is video") {
        REQUIRE(core.devicesClient().mishap({"display", "unplug", 0, 0, 0.0}));
        CHECK(becomesSafe(core, seconds(8), kRest, black));
        kill(core.supervisor(), SIGKILL);
        kill(link.status().pid, SIGKILL);
        // What the guard starts finds no display, and leaves the board as it is.
        CHECK(leavesSafe(core, seconds(6), kRest) == "");
        CHECK(app::stageIsMarked(core.directory()));
        REQUIRE(core.devicesClient().mishap({"display", "plug", 0, 0, 0.0}));
        CHECK(unmarked(core, seconds(25)));
        CHECK(becomesSafe(core, seconds(5), kRest, black));
        core.start();
        auto next = core.connected();
        CHECK(next.status().light == LightMode::steady);
        REQUIRE(ready(next));
        taken(next, shown(2), ++revision);
    }
    SUBCASE("the guard killed: another one, and the show goes on") {
        const int killed = core.guard(), player = link.status().pid;
        REQUIRE(killed > 0);
        kill(killed, SIGKILL);
        const auto deadline = Clock::now() + seconds(5);
        while ((core.guard() == 0 || core.guard() == killed) && Clock::now() < deadline)
            std::this_thread::sleep_for(milliseconds(20));
        CHECK(core.guard() != 0);
        CHECK(core.guard() != killed);
        link.poll(milliseconds(300));
        CHECK(link.status().pid == player);
    }
    SUBCASE("the rig itself killed: a fault, and another rig is played on after a take") {
        kill(core.devicesPid(), SIGKILL);
        REQUIRE(OutputCore::until(link, seconds(10), [](const Status& s) { return s.faults > 0; }));
        const int before = link.status().pid;
        REQUIRE(OutputCore::until(link, seconds(30), [&](const Status& s) { return s.connected && s.pid != before; }));
        REQUIRE(ready(link));
        taken(link, shown(1), revision);
    }
    kill(core.supervisor(), SIGTERM);
    CHECK(ended(core));
    CHECK_FALSE(app::stageIsMarked(core.directory()));
    checkTapes(core);
}
