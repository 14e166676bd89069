#include <sys/wait.h>

#include <random>

#include "tests/process/output_core.h"

using namespace ilf;
using namespace ilf::test;
using devices::LightMode;
using devices::Status;
using devices::Why;

namespace {

milliseconds anyTime(std::mt19937& random, int most_ms) {
    return milliseconds(std::uniform_int_distribution<>(0, most_ms)(random));
}

/// Another process with a studio's end of the link: this executable again, running the case of that name.
pid_t startStudio(const std::filesystem::path& directory, const char* testCase) {
    setenv("ILF_TEST_DIRECTORY", directory.c_str(), 1);
    const std::string self = std::filesystem::read_symlink("/proc/self/exe");
    const std::string filter = std::string("--test-case=") + testCase;
    const pid_t child = fork();
    if (child == 0) {
        execl(self.c_str(), self.c_str(), filter.c_str(), "--no-skip", nullptr);
        _exit(127);
    }
    return child;
}

void killNow(pid_t child) {
    kill(child, SIGKILL);
    waitpid(child, nullptr, 0);
}

/// Sends dabs, newest wins, for `time`.
void paint(devices::CoreLink& link, milliseconds time, std::uint64_t& revision) {
    const auto until = Clock::now() + time;
    while (Clock::now() < until) {
        ++revision;
        if (!link.send(dabbed(program(1), static_cast<std::uint8_t>(revision)), revision, Why::live)) return;
        link.poll(milliseconds(2));
    }
}

}  // namespace

// Run in processes of their own by the cases below.
TEST_CASE("studio that takes and waits" * doctest::skip()) {
    devices::CoreLink link(std::getenv("ILF_TEST_DIRECTORY"));
    REQUIRE(OutputCore::until(link, seconds(5), [](const Status& s) { return s.connected; }));
    OutputCore::take(link, program(1), 11);
    while (true)
        link.poll(milliseconds(100));
}
TEST_CASE("studio that takes and paints" * doctest::skip()) {
    devices::CoreLink link(std::getenv("ILF_TEST_DIRECTORY"));
    REQUIRE(OutputCore::until(link, seconds(5), [](const Status& s) { return s.connected; }));
    OutputCore::take(link, program(1), 11);
    std::uint64_t revision = 11;
    paint(link, seconds(60), revision);
}

TEST_CASE("a studio killed while its program plays leaves the light as it is, and the next one sees it") {
    const OutputCore core;
    const pid_t studio = startStudio(core.directory(), "studio that takes and waits");
    const auto hash = contentHash(program(1));
    REQUIRE(core.devicesBecome(seconds(10), [&](const auto& s) { return s.hashShown == hash; }));
    killNow(studio);
    const auto end = Clock::now() + milliseconds(1500);
    while (Clock::now() < end) {
        REQUIRE(core.deviceState().hashShown == hash);
        std::this_thread::sleep_for(milliseconds(50));
    }
    auto link = core.connected();
    CHECK(link.status().light == LightMode::slotted);
    CHECK(link.status().revisionPlayed == 11);
    CHECK(link.status().contentHashPlayed == hash);
    CHECK(link.status().faults == 0);
}

TEST_CASE("studios killed at random moments of a stroke never change more than the stroke") {
    const OutputCore core;
    std::mt19937 random(20260101);
    for (int i = 0; i < kills(); ++i) {
        CAPTURE(i);
        const auto swaps = core.deviceState().swaps;
        const pid_t studio = startStudio(core.directory(), "studio that takes and paints");
        REQUIRE(core.devicesBecome(seconds(10), [&](const auto& s) { return s.swaps > swaps; }));
        std::this_thread::sleep_for(anyTime(random, 200));
        killNow(studio);
        // What had arrived is played; then nothing changes any more.
        std::this_thread::sleep_for(milliseconds(200));
        const auto before = core.deviceState();
        CHECK_MESSAGE(before.light == LightMode::slotted, words(before));
        std::this_thread::sleep_for(milliseconds(200));
        const auto after = core.deviceState();
        CHECK(after.hashShown == before.hashShown);
        CHECK(after.swaps == before.swaps);
        checkOrderKept(after);
    }
}

TEST_CASE("the player killed at random moments: within a second steady light and a resting lens, and no slots after") {
    const OutputCore core;
    auto link = core.connected();
    std::mt19937 random(20260102);
    std::uint64_t revision = 0;
    for (int i = 0; i < kills(); ++i) {
        CAPTURE(i);
        REQUIRE(OutputCore::until(link, seconds(5), [](const Status& s) { return s.connected && s.hold != 0; }));
        OutputCore::take(link, program(1, i % 2 == 0 ? 2.27_D : 4.27_D), ++revision);
        paint(link, anyTime(random, 120), revision);
        const int killed = link.status().pid;
        kill(killed, SIGKILL);
        const auto deadline = Clock::now() + seconds(1);
        CHECK(core.devicesBecome(seconds(1), safe));
        const auto left = std::chrono::duration_cast<milliseconds>(deadline - Clock::now());
        CHECK(OutputCore::until(link, left, [&](const Status& s) { return !s.connected || s.pid != killed; }));
        // The one that was started in its place holds safe light, whatever was on its way to the dead one.
        REQUIRE(OutputCore::until(link, seconds(5), [&](const Status& s) { return s.connected && s.pid != killed; }));
        CHECK(link.status().light == LightMode::steady);
        CHECK(link.status().hold != 0);
        std::this_thread::sleep_for(milliseconds(50));
        const auto state = core.deviceState();
        CHECK(safe(state));
        CHECK_MESSAGE(state.watchdogTrips == 0, words(state));
        checkOrderKept(state);
    }
}

TEST_CASE("the supervisor killed: the player makes safe light and ends; the next studio starts another core") {
    OutputCore core;
    std::mt19937 random(20260103);
    std::uint64_t revision = 0;
    for (int i = 0; i < (kills() + 4) / 5; ++i) {
        CAPTURE(i);
        auto link = core.connected();
        OutputCore::take(link, program(1), ++revision);
        paint(link, anyTime(random, 120), revision);
        kill(core.supervisor(), SIGKILL);
        CHECK(core.devicesBecome(seconds(1), safe));
        CHECK(OutputCore::until(link, seconds(5), [](const Status& s) { return !s.connected; }));
        core.start();
        CHECK(core.connected().status().light == LightMode::steady);
        CHECK(core.deviceState().watchdogTrips == 0);
    }
}

TEST_CASE("supervisor and player killed at once: the devices' own watchdog makes safe light within a second") {
    OutputCore core;
    auto link = core.connected();
    OutputCore::take(link, program(1), 1);
    const int player = core.player();
    kill(player, SIGSTOP);  // so that it cannot see its supervisor die
    kill(core.supervisor(), SIGKILL);
    kill(player, SIGKILL);
    CHECK(core.devicesBecome(seconds(1), safe));
    core.start();
    CHECK(core.connected().status().hold != 0);
}

TEST_CASE("a player that hangs: the devices' own watchdog makes safe light, and waking up changes nothing") {
    const OutputCore core;
    auto link = core.connected();
    OutputCore::take(link, program(1), 1);
    kill(core.player(), SIGSTOP);
    CHECK(core.devicesBecome(seconds(1), safe));
    CHECK(OutputCore::until(link, seconds(2), [](const Status& s) { return !s.connected; }));
    kill(core.player(), SIGCONT);
    REQUIRE(OutputCore::until(link, seconds(5), [](const Status& s) { return s.connected && s.faults == 1; }));
    CHECK(link.status().fault.find("went to steady light by itself") != std::string::npos);
    CHECK(safe(core.deviceState()));
}
