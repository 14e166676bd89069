#include <sys/wait.h>

#include <zmq.hpp>

#include <array>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <random>

#include "tests/process/output_core.h"

using namespace ilf;
using namespace ilf::test;
using devices::InjectFault;
using devices::LightMode;
using devices::Status;
using devices::Why;

namespace {

struct Ran {
    int exitCode = -1;
    std::string output;
};

/// Runs illuminatedfocus-core with these arguments to its end.
Ran ran(const std::string& arguments) {
    const std::string command = std::string("'") + ILF_CORE_PATH + "' " + arguments + " 2>&1";
    Ran result;
    FILE* pipe = popen(command.c_str(), "r");
    REQUIRE(pipe != nullptr);
    std::array<char, 4096> buffer{};
    for (std::size_t n = 0; (n = fread(buffer.data(), 1, buffer.size(), pipe)) > 0;)
        result.output.append(buffer.data(), n);
    const int status = pclose(pipe);
    if (WIFEXITED(status)) result.exitCode = WEXITSTATUS(status);
    return result;
}

std::string in(const OutputCore& core) { return "--runtime-dir '" + core.directory().string() + "' "; }

void inject(const OutputCore& core, InjectFault::Kind kind) {
    auto client = core.devicesClient();
    REQUIRE(devices::ask<devices::Done>(client, InjectFault{kind, 0}).has_value());
}

}  // namespace

TEST_CASE("the player asked to end by SIGTERM makes safe light first") {
    const OutputCore core;
    auto link = core.connected();
    OutputCore::take(link, program(1), 1);
    const int player = link.status().pid;
    kill(player, SIGTERM);
    CHECK(core.devicesBecome(seconds(1), safe));
    REQUIRE(OutputCore::until(link, seconds(5), [&](const Status& s) { return s.connected && s.pid != player; }));
    CHECK(link.status().hold != 0);
    checkOrderKept(core.deviceState());
}

TEST_CASE("SIGTERM to the supervisor: safe light, then all processes end") {
    const OutputCore core;
    auto link = core.connected();
    OutputCore::take(link, program(1), 1);
    kill(core.supervisor(), SIGTERM);
    CHECK(OutputCore::until(link, seconds(5), [](const Status& s) { return !s.connected; }));
    const auto deadline = Clock::now() + seconds(5);
    while ((core.supervisor() != 0 || core.player() != 0 || core.devicesPid() != 0) && Clock::now() < deadline)
        std::this_thread::sleep_for(milliseconds(20));
    CHECK(core.supervisor() == 0);
    CHECK(core.player() == 0);
    CHECK(core.devicesPid() == 0);
}

TEST_CASE("devices killed: a fault within a second; back again they are steady and nothing resumes") {
    const OutputCore core;
    auto link = core.connected();
    OutputCore::take(link, program(1), 1);
    kill(core.devicesPid(), SIGKILL);
    CHECK(OutputCore::until(link, seconds(1), [](const Status& s) { return s.faults == 1; }));
    CHECK_FALSE(link.status().projectorWell);
    CHECK(link.status().fault.find("check that their process runs") != std::string::npos);
    REQUIRE(OutputCore::until(link, seconds(10), [](const Status& s) { return s.connected && s.projectorWell; }));
    CHECK(link.status().light == LightMode::steady);
    CHECK(link.status().hold != 0);
    CHECK(safe(core.deviceState()));
    // A live update is no take.
    REQUIRE(link.send(program(2), 2, Why::live).has_value());
    REQUIRE(OutputCore::until(link, seconds(5), [](const Status& s) { return !s.lastRefusal.empty(); }));
    CHECK(safe(core.deviceState()));
    OutputCore::take(link, program(2), 3);
    CHECK(core.deviceState().hashShown == contentHash(program(2)));
    CHECK(link.status().fault.empty());
}

TEST_CASE("an order that the devices refuse is a fault, and the light is steady") {
    const OutputCore core;
    auto link = core.connected();
    OutputCore::take(link, program(1), 1);
    inject(core, InjectFault::Kind::refuse);
    REQUIRE(link.send(program(2), 2, Why::live).has_value());
    REQUIRE(OutputCore::until(link, seconds(5), [](const Status& s) { return s.faults == 1; }));
    CHECK(link.status().fault == "A fault was injected.");
    CHECK(core.devicesBecome(seconds(1), safe));
}

TEST_CASE("devices that fall silent are a fault, and are tried again until they answer") {
    const OutputCore core;
    auto link = core.connected();
    OutputCore::take(link, program(1), 1);
    inject(core, InjectFault::Kind::silence);
    CHECK(OutputCore::until(link, seconds(2), [](const Status& s) { return s.faults == 1; }));
    CHECK(link.status().fault.find("did not answer") != std::string::npos);
    inject(core, InjectFault::Kind::none);
    CHECK(core.devicesBecome(seconds(5), safe));
    CHECK(OutputCore::until(link, seconds(5), [](const Status& s) { return s.projectorWell; }));
}

TEST_CASE("safe light is one word, and holds") {
    const OutputCore core;
    auto link = core.connected();
    OutputCore::take(link, program(1), 1);
    REQUIRE(link.safeLight().has_value());
    REQUIRE(OutputCore::until(link, seconds(5), [](const Status& s) { return s.hold != 0; }));
    CHECK(link.status().light == LightMode::steady);
    CHECK(safe(core.deviceState()));
    CHECK(link.status().faults == 0);
    OutputCore::take(link, program(2), 2);
    CHECK(core.deviceState().light == LightMode::slotted);
}

TEST_CASE("a sweep dragged live, faster than sweeps may start, is no silence to the devices") {
    const OutputCore core;
    auto link = core.connected();
    OutputCore::take(link, program(1), 1);
    std::uint64_t revision = 1;
    const auto until = Clock::now() + milliseconds(2200);
    while (Clock::now() < until) {
        ++revision;
        const auto dragged = program(1, Dioptre::fromSi(2.0 + 0.001 * static_cast<double>(revision)));
        REQUIRE(link.send(dragged, revision, Why::live).has_value());
        link.poll(milliseconds(10));
    }
    CHECK(OutputCore::until(link, seconds(5), [&](const Status& s) { return s.revisionPlayed == revision; }));
    CHECK(link.status().faults == 0);
    const auto state = core.deviceState();
    CHECK_MESSAGE(state.watchdogTrips == 0, words(state));
    checkOrderKept(state);
}

TEST_CASE("studios that start at the same time start one core") {
    const OutputCore core;  // for its directory
    kill(core.supervisor(), SIGTERM);
    const auto deadline = Clock::now() + seconds(5);
    while (core.supervisor() != 0 && Clock::now() < deadline)
        std::this_thread::sleep_for(milliseconds(20));
    std::array<bool, 4> well{};
    {
        std::vector<std::jthread> studios;
        for (auto& ok : well)
            studios.emplace_back([&] { ok = devices::ensureCoreRunning(ILF_CORE_PATH, core.directory()).has_value(); });
    }
    for (const bool ok : well)
        CHECK(ok);
    const auto second = ran(in(core));
    CHECK(second.exitCode == 3);
    CHECK(second.output.find("runs in") != std::string::npos);
}

TEST_CASE("a core that is not there is refused in words") {
    const OutputCore core;
    const auto started = devices::ensureCoreRunning("/no/such/illuminatedfocus-core", core.directory() / "other");
    REQUIRE_FALSE(started.has_value());
    CHECK(started.error().what.find("is not there or cannot be run") != std::string::npos);
    devices::CoreLink link(core.directory() / "other");
    CHECK_FALSE(link.poll(milliseconds(50)).has_value());
    CHECK(link.send(program(1), 1, Why::take).error().what.find("not connected") != std::string::npos);
}

TEST_CASE("rubbish on the socket is refused and changes nothing") {
    const OutputCore core;
    auto link = core.connected();
    OutputCore::take(link, program(1), 1);
    zmq::context_t context(1);
    for (const auto& address : {devices::coreAddress(core.directory()), devices::devicesAddress(core.directory())}) {
        zmq::socket_t socket(context, zmq::socket_type::dealer);
        socket.set(zmq::sockopt::linger, 100);
        socket.connect(address);
        std::mt19937 random(7);
        for (int i = 0; i < 200; ++i) {
            std::string bytes(std::uniform_int_distribution<std::size_t>(0, 300)(random), '\0');
            for (char& c : bytes)
                c = static_cast<char>(random());
            socket.send(zmq::buffer(bytes), i % 3 == 0 ? zmq::send_flags::sndmore : zmq::send_flags::none);
        }
    }
    std::this_thread::sleep_for(milliseconds(200));
    CHECK(core.deviceState().hashShown == contentHash(program(1)));
    OutputCore::take(link, program(2), 2);
    CHECK(link.status().faults == 0);
}

TEST_CASE("the core's words: help, version, status as JSON, stop") {
    const OutputCore core;
    CHECK(ran("--help").exitCode == 0);
    CHECK(ran("--version").output.starts_with("illuminatedfocus-core "));
    CHECK(ran("--nonsense").exitCode == 2);
    CHECK(ran("--simulated-lens glass").exitCode == 2);
    auto link = core.connected();
    OutputCore::take(link, program(1), 7);
    const auto status = ran(in(core) + "--status");
    CHECK(status.exitCode == 0);
    const auto json = nlohmann::json::parse(status.output);
    CHECK(json["core"]["revision_played"] == 7);
    CHECK(json["core"]["simulated"] == true);
    CHECK(json["devices"]["light"] == "slotted");
    CHECK(json["devices"]["slot_hashes"].size() == 16);
    CHECK(json["devices"]["sweep_D"][1].get<double>() == doctest::Approx(2.27));
    CHECK(ran(in(core) + "--stop").exitCode == 0);
    CHECK(core.devicesPid() == 0);
    CHECK(ran(in(core) + "--stop").exitCode == 3);
    CHECK(ran(in(core) + "--status").exitCode == 3);
}

TEST_CASE("stopped with --leave-devices, the light that stays is steady") {
    OutputCore core;
    CHECK(ran(in(core) + "--stop").exitCode == 0);
    REQUIRE(devices::startDetached(
                ILF_CORE_PATH,
                {"--leave-devices", "--simulated-lens", "ideal", "--runtime-dir", core.directory().string()},
                core.directory() / "out.txt")
                .has_value());
    auto link = core.connected();
    OutputCore::take(link, program(1), 1);
    CHECK(ran(in(core) + "--stop").exitCode == 0);
    CHECK(safe(core.deviceState()));
}
