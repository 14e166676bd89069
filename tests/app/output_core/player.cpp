#include "app/output_core/player.h"

#include <doctest/doctest.h>

#include <atomic>
#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <thread>

#include "devices/simulated/virtual_stage.h"
#include "tests/devices/programs.h"

namespace ilf::app {
namespace {

using devices::LightMode;
using devices::Status;
using devices::Why;

/// A player on a virtual stage, and what it said. The stage is looked at only while the player is gone.
class Scene {
public:
    explicit Scene(std::function<bool(const devices::Body&)> failsAt = nullptr) {
        auto stage = std::make_unique<devices::VirtualStage>();
        stage->port.failsAt = std::move(failsAt);
        player.emplace(std::move(stage), [] {});
    }
    /// Waits until the status is as wanted; false after five seconds.
    bool until(const std::function<bool(const Status&)>& wanted) {
        const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(5);
        while (std::chrono::steady_clock::now() < deadline) {
            if (auto status = player->newStatus()) newest = *status;
            if (newest.pid != 0 && wanted(newest)) return true;
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
        return false;
    }
    void send(std::uint32_t seed, std::uint64_t revision, Why why) {
        const auto program = test::program(seed);
        player->play({program, revision, contentHash(program), why, newest.hold, 1});
    }

    std::optional<Player> player;
    Status newest;
};

bool held(const Status& s) { return s.hold != 0; }

}  // namespace

TEST_CASE("player: begins in safe light, which only a take ends") {
    Scene scene;
    REQUIRE(scene.until(held));
    CHECK(scene.newest.light == LightMode::steady);
    scene.send(1, 1, Why::live);
    REQUIRE(scene.until([](const Status& s) { return !s.lastRefusal.empty(); }));
    CHECK(scene.newest.light == LightMode::steady);
    CHECK(scene.newest.droppedUpdates == 1);
    scene.send(1, 2, Why::take);
    REQUIRE(scene.until([](const Status& s) { return s.revisionPlayed == 2; }));
    CHECK(scene.newest.light == LightMode::slotted);
    CHECK(scene.newest.contentHashPlayed == contentHash(test::program(1)));
    CHECK(scene.newest.lastRefusal.empty());
    scene.send(2, 3, Why::live);
    CHECK(scene.until([](const Status& s) { return s.revisionPlayed == 3; }));
}

TEST_CASE("player: safe light holds against everything that was sent before it was known") {
    Scene scene;
    REQUIRE(scene.until(held));
    scene.send(1, 1, Why::take);
    REQUIRE(scene.until([](const Status& s) { return s.revisionPlayed == 1; }));
    scene.player->safeLight();
    scene.send(2, 2, Why::live);
    scene.send(2, 3, Why::take);  // names the hold known before: none
    REQUIRE(scene.until([](const Status& s) { return held(s) && !s.lastRefusal.empty(); }));
    CHECK(scene.newest.light == LightMode::steady);
    CHECK(scene.newest.revisionPlayed == 0);
    scene.send(2, 4, Why::take);
    CHECK(scene.until([](const Status& s) { return s.revisionPlayed == 4 && s.light == LightMode::slotted; }));
}

TEST_CASE("player: a fault makes safe light, is told until a take, and nothing resumes by itself") {
    std::atomic<bool> broken = false;
    Scene scene([&](const devices::Body& order) {
        return broken && !std::holds_alternative<devices::SteadyLight>(order) &&
               !std::holds_alternative<devices::LensToRest>(order);
    });
    REQUIRE(scene.until(held));
    scene.send(1, 1, Why::take);
    REQUIRE(scene.until([](const Status& s) { return s.revisionPlayed == 1; }));
    broken = true;
    REQUIRE(scene.until([](const Status& s) { return s.faults == 1 && held(s); }));
    CHECK(scene.newest.fault == "The order was lost: read");
    CHECK_FALSE(scene.newest.projectorWell);
    broken = false;
    REQUIRE(scene.until([](const Status& s) { return s.projectorWell; }));
    CHECK(scene.newest.light == LightMode::steady);
    CHECK(scene.newest.lens == devices::LensMode::rest);
    CHECK_FALSE(scene.newest.fault.empty());
    scene.send(1, 2, Why::live);
    REQUIRE(scene.until([](const Status& s) { return !s.lastRefusal.empty(); }));
    CHECK(scene.newest.light == LightMode::steady);
    scene.send(1, 3, Why::take);
    REQUIRE(scene.until([](const Status& s) { return s.revisionPlayed == 3; }));
    CHECK(scene.newest.fault.empty());
    CHECK(scene.newest.faults == 1);
}

TEST_CASE("player: a lost device is one fault, however long it stays away") {
    std::atomic<bool> away = false;
    Scene scene([&](const devices::Body&) { return away.load(); });
    REQUIRE(scene.until([](const Status& s) { return held(s) && s.projectorWell; }));
    scene.send(1, 1, Why::take);
    REQUIRE(scene.until([](const Status& s) { return s.revisionPlayed == 1; }));
    away = true;
    REQUIRE(scene.until([](const Status& s) { return s.faults == 1; }));
    std::this_thread::sleep_for(std::chrono::milliseconds(350));
    CHECK(scene.until([](const Status& s) { return s.faults == 1; }));
    away = false;
    // The light that outlived the lost link is made safe as soon as somebody listens.
    CHECK(scene.until([](const Status& s) { return s.projectorWell && s.light == LightMode::steady; }));
    CHECK(scene.newest.faults == 1);
}

TEST_CASE("player: an unsafe program is refused and what plays goes on") {
    Scene scene;
    REQUIRE(scene.until(held));
    scene.send(1, 1, Why::take);
    REQUIRE(scene.until([](const Status& s) { return s.revisionPlayed == 1; }));
    auto dark = test::program(1);
    dark.imageOfSlot.assign(16, Program::kDark);
    scene.player->play({dark, 2, contentHash(dark), Why::take, 0, 1});
    REQUIRE(scene.until([](const Status& s) { return !s.lastRefusal.empty(); }));
    CHECK(scene.newest.light == LightMode::slotted);
    CHECK(scene.newest.revisionPlayed == 1);
    CHECK(scene.newest.faults == 0);
}

TEST_CASE("player: of many updates at once the newest is played and the others are counted") {
    Scene scene;
    REQUIRE(scene.until(held));
    scene.send(0, 1, Why::take);
    REQUIRE(scene.until([](const Status& s) { return s.revisionPlayed == 1; }));
    for (std::uint32_t i = 2; i <= 200; ++i)
        scene.send(i % 7, i, Why::live);
    REQUIRE(scene.until([](const Status& s) { return s.revisionPlayed == 200; }));
    CHECK(scene.newest.swaps + scene.newest.droppedUpdates == 200);
}

TEST_CASE("player: sweeps dragged live start at most once a second, and the newest of them is played") {
    // Each start passes through steady light; more of them would make the room flicker at 3-30 Hz.
    Scene scene;
    REQUIRE(scene.until(held));
    scene.send(1, 1, Why::take);
    REQUIRE(scene.until([](const Status& s) { return s.revisionPlayed == 1; }));
    const auto begun = std::chrono::steady_clock::now();
    std::uint64_t revision = 1, starts = 0, played = 1;
    while (std::chrono::steady_clock::now() - begun < std::chrono::milliseconds(2500)) {
        const auto program = test::program(1, Dioptre::fromSi(2.0 + 0.001 * static_cast<double>(++revision)));
        scene.player->play({program, revision, contentHash(program), Why::live, 0, 1});
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
        if (auto status = scene.player->newStatus()) scene.newest = *status;
        if (scene.newest.revisionPlayed != played) ++starts;
        played = scene.newest.revisionPlayed;
    }
    CHECK(starts >= 1);
    CHECK(starts <= 3);
    REQUIRE(scene.until([&](const Status& s) { return s.revisionPlayed == revision; }));
    CHECK(scene.newest.faults == 0);
}

TEST_CASE("player: says why the one before it ended, and waits for a take") {
    auto stage = std::make_unique<devices::VirtualStage>();
    Player player(std::move(stage), [] {}, "The player before ended.");
    std::optional<Status> status;
    for (int i = 0; i < 500 && !status; ++i) {
        status = player.newStatus();
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    REQUIRE(status);
    CHECK(status->fault == "The player before ended.");
    CHECK(status->faults == 1);
    CHECK(status->hold != 0);
    CHECK(status->light == LightMode::steady);
}

namespace {

/// Real devices that take their time, as a projector that is silent does.
class SlowStage : public devices::VirtualStage {
public:
    explicit SlowStage(std::atomic<bool>& wait) : wait_(wait) {}
    Result<void> swap() override {
        waited();
        return VirtualStage::swap();
    }
    void safeLight() noexcept override {
        waited();
        VirtualStage::safeLight();
    }
    devices::StageReport report() const override {
        auto report = VirtualStage::report();
        report.emulated = true;
        report.timing = devices::StageTiming{true, 20.0_us, 5.0_us, 12.0, 3};
        report.lensTemperature_C = 31.5;
        report.devices = {{"projector", devices::DeviceHealth::well, "board", "six slots"}};
        return report;
    }

private:
    void waited() const {
        while (wait_)
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    std::atomic<bool>& wait_;
};

}  // namespace

TEST_CASE("player: passes on what the stage measured and what the machine does not allow") {
    std::atomic<bool> wait = false;
    Scene scene;
    scene.player.emplace(std::make_unique<SlowStage>(wait), [] {}, "", std::vector<std::string>{"No real time."});
    REQUIRE(scene.until([](const Status& s) { return s.projectorWell; }));
    CHECK(scene.newest.emulated);
    CHECK(scene.newest.timing->missedTriggers == 3);
    CHECK(scene.newest.lensTemperature_C == 31.5);
    CHECK(scene.newest.devices.at(0).line == "six slots");
    CHECK(scene.newest.limits == std::vector<std::string>{"No real time."});
}

TEST_CASE("player: a stage that takes its time keeps nobody from asking, and its end is waited for") {
    std::atomic<bool> wait = true;
    Player player(std::make_unique<SlowStage>(wait), [] {});
    // Said before the first safe light is reached.
    std::optional<Status> first;
    for (int i = 0; i < 2000 && !first; ++i) {
        first = player.newStatus();
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    REQUIRE(first);
    CHECK(first->hold != 0);
    const auto busy = player.busyFor();
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    CHECK(player.busyFor() >= busy + std::chrono::milliseconds(15));
    player.end();
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    CHECK_FALSE(player.ended());
    wait = false;
    for (int i = 0; i < 5000 && !player.ended(); ++i)
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    CHECK(player.ended());
    const auto last = player.newStatus();
    REQUIRE(last);
    CHECK(last->light == LightMode::steady);
}

}  // namespace ilf::app
