// The whole core over an emulated rig: real USB drivers, a real window, and light as the emulated projector had it.
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "tests/process/output_core.h"

using namespace ilf;
using namespace ilf::test;
using devices::LightMode;
using devices::Status;

namespace {

/// Of a wearer whose lenses rest elsewhere than at 0 D.
constexpr Dioptre kRest = 1.0_D;

/// Six slots of four bits, seen through a lens that swings by 3 D.
Program shown(std::uint32_t seed) {
    Program p = program(seed, 2.0_D, {912, 1140});
    p.waveform.rest = kRest;
    p.waveform.unit = DriveUnit::ampere;
    p.waveform.drive.c = {0.005, 0.012};
    p.slotRate = 360.0_Hz;
    p.projectorDelay = 0.0_ms;
    p.imageOfSlot = {0, 0, Program::kDark, 1, 1, Program::kDark};
    return p;
}

/// What the rig received last, and the darkest and brightest pixel of all its exposures.
struct Seen {
    devices::Received received;
    int darkest = 255, brightest = 0;
    bool white() const { return !received.exposures.empty() && darkest == 255; }
    bool atRest(Dioptre rest) const {
        const auto near = [&](Dioptre power) { return abs(power - rest) < 0.25_D; };
        return std::all_of(received.left.begin(), received.left.end(), near) &&
               std::all_of(received.right.begin(), received.right.end(), near);
    }
};

std::optional<Seen> seen(devices::DeviceClient& client) {
    auto received = devices::ask<devices::Received>(client, devices::ReadReceived{});
    if (!received) return std::nullopt;
    Seen now{*std::move(received), 255, 0};
    for (std::size_t i = 0; i < now.received.exposures.size(); ++i) {
        const auto light = devices::ask<devices::ExposedLight>(client, devices::ReadExposure{static_cast<int>(i)});
        if (!light || light->light.empty()) return std::nullopt;
        const auto [low, high] = std::minmax_element(light->light.begin(), light->light.end());
        now.darkest = std::min<int>(now.darkest, *low);
        now.brightest = std::max<int>(now.brightest, *high);
    }
    return now;
}

/// Within `time` the light is white and the lens at `rest`. Counts sweeps that were all black on the way.
bool becomesSafe(const OutputCore& core, milliseconds time, Dioptre rest, int& black) {
    auto client = core.devicesClient();
    const auto deadline = Clock::now() + time;
    while (Clock::now() < deadline) {
        const auto now = seen(client);
        if (now && !now->received.exposures.empty() && now->brightest == 0) ++black;
        if (now && now->white() && now->atRest(rest)) return true;
        std::this_thread::sleep_for(milliseconds(20));
    }
    return false;
}

/// None where an emulated rig cannot run.
bool ready(devices::CoreLink& link) {
    const auto allWell = [](const Status& s) {
        return s.devices.size() == 3 && std::all_of(s.devices.begin(), s.devices.end(), [](const auto& one) {
                   return one.health == devices::DeviceHealth::well;
               });
    };
    const auto lacking = [](const Status& s) {
        return s.devices.size() == 1 && s.devices[0].line.find("Xvfb") != std::string::npos;
    };
    REQUIRE(OutputCore::until(link, seconds(20), [&](const Status& s) { return allWell(s) || lacking(s); }));
    if (allWell(link.status())) return true;
    MESSAGE("SKIPPED: ", link.status().devices[0].line);
    return false;
}

/// TAKE. On a machine that is busy with other things a rig in real time may miss its time, which is a fault and safe
/// light; then again.
void taken(devices::CoreLink& link, const Program& program, std::uint64_t& revision) {
    for (int tries = 0; tries < 5; ++tries) {
        const auto faults = link.status().faults;
        const auto sent = link.send(program, ++revision, devices::Why::take);
        REQUIRE_MESSAGE(sent.has_value(), (sent ? "" : sent.error().what));
        REQUIRE(OutputCore::until(link, seconds(20),
                                  [&](const Status& s) { return s.revisionPlayed == revision || s.faults != faults; }));
        if (link.status().revisionPlayed == revision) return;
        MESSAGE("taken again: ", link.status().fault);
        REQUIRE(ready(link));
    }
    FAIL("no take was played");
}

bool ended(const OutputCore& core) {
    const auto deadline = Clock::now() + seconds(10);
    const auto any = [&] { return core.supervisor() + core.player() + core.devicesPid() + core.guard() != 0; };
    while (any() && Clock::now() < deadline)
        std::this_thread::sleep_for(milliseconds(20));
    return !any();
}

}  // namespace

TEST_CASE(
    "emulated core: a program is slotted light; whoever is killed, the light is white, the lens rests, and stays") {
#if defined(__SANITIZE_THREAD__)
    MESSAGE("SKIPPED: the thread sanitizer cannot judge umockdev's and GLib's own threads");
    return;
#endif
    OutputCore core("datasheet", "emulated");
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
}
