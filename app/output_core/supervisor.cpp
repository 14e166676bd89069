#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <optional>
#include <string>

#include "app/output_core/devices_keeper.h"
#include "app/output_core/events.h"
#include "app/output_core/guard_keeper.h"
#include "app/output_core/log.h"
#include "app/output_core/priority.h"
#include "app/output_core/roles.h"
#include "app/output_core/service_manager.h"
#include "app/output_core/signals.h"
#include "app/output_core/start_role.h"
#include "app/output_core/wait.h"
#include "devices/link/core_link.h"
#include "devices/link/runtime_directory.h"

namespace ilf::app {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

// A player that lived this long did not crash because it was started.
constexpr std::chrono::seconds kGoodLife{5};
// One that crashes again and again must not keep the machine busy, but an operator waits for no more than this.
constexpr milliseconds kFirstDelay{20}, kLongestDelay{320};
// An orderly stop: safe light takes a few calls, each with its time limit. Real devices may be in the middle of a
// start, which is not broken off: settling, patterns and locking take seconds.
constexpr milliseconds kStopTime{3000}, kDeviceStopTime{15000};
// What makes the stage safe in a player's place tries for this long.
constexpr milliseconds kSafeTime{12000};
// Whoever asks for a stop waits for all of it.
constexpr milliseconds kWholeStop{40000};

const char* const kPlayerEnded =
    "The output core's player ended unexpectedly; the light is steady and the lens rests. TAKE plays again.";
const char* const kRigAnew =
    "The emulated rig ended and was started again; the light is steady and the lens rests. TAKE plays again.";

class Supervisor {
public:
    Supervisor(const CoreSetup& setup, const Signals& signals, ServiceManager& manager)
        : setup_(setup), signals_(signals), manager_(manager), link_(setup.runtimeDirectory), devices_(setup_),
          guard_(setup_) {}

    /// Devices, what makes them safe, white below the player's window, player.
    void start() {
        devices_.start();
        // A player may be left whose supervisor was killed a moment ago; it ends by itself, in safe light.
        const auto lock = devices::playerLock(setup_.runtimeDirectory);
        if (!within(stopTime(), [&] { return !devices::FileLock::holder(lock); }))
            if (const auto pid = devices::FileLock::holder(lock); pid && *pid > 0) {
                note(event::kPlayerStuck, "process " + std::to_string(*pid));
                kill(*pid, SIGKILL);
            }
        devices_.makeSafe();
        guard_.watch(devices_.environment());
        startPlayer();
    }

    /// Until a signal asks for the end.
    void watch() {
        while (true) {
            for (const int signal : signals_.arrived(untilNextStart()))
                if (signal != SIGCHLD) return;
            int status = 0;
            if (player_ && waitpid(*player_, &status, WNOHANG) == *player_) playerDied(status);
            if (!player_ && Clock::now() >= nextStart_) startPlayer();
            if (devices_.watch()) rigChanged();
            guard_.watch(devices_.environment());
            tellManager();
        }
    }

    /// Player (in safe light), guard, devices: light goes last.
    void stop(bool leaveDevices) {
        manager_.stopping();
        if (player_) {
            kill(*player_, SIGTERM);
            if (!within(stopTime(), [&] { return waitpid(*player_, nullptr, WNOHANG) == *player_; })) {
                note(event::kPlayerStuck, "process " + std::to_string(*player_));
                kill(*player_, SIGKILL);
                waitpid(*player_, nullptr, 0);
                makeSafeInstead();
            }
        }
        devices_.makeSafe();
        if (leaveDevices) return;
        if (setup_.played.machine == Machine::emulated) guard_.stop();  // its display ends with the rig
        devices_.stop();
    }

private:
    bool simulated() const { return setup_.played.machine == Machine::simulated; }
    milliseconds stopTime() const { return simulated() ? kStopTime : kDeviceStopTime; }

    int untilNextStart() const {
        if (player_) return 100;
        const auto left = std::chrono::ceil<milliseconds>(nextStart_ - Clock::now());
        return static_cast<int>(std::clamp(left.count(), milliseconds::rep{0}, milliseconds::rep{100}));
    }

    void startPlayer() {
        player_ = startChild(setup_, {"--player", "--after-fault", afterFault_}, devices_.environment());
        started_ = Clock::now();
        if (player_) {
            note(event::kPlayerStarted, "process " + std::to_string(*player_));
        } else {
            note(event::kNoProcess);
            nextStart_ = Clock::now() + kLongestDelay;
        }
    }

    /// Simulated devices are told here; others by the next player, whose first act is safe light, in a moment.
    void playerDied(int status) {
        devices_.makeSafe();
        player_.reset();
        const bool crashed = Clock::now() - started_ < kGoodLife;
        delay_ = crashed ? std::min(2 * std::max(delay_, kFirstDelay), kLongestDelay) : kFirstDelay;
        nextStart_ = Clock::now() + delay_;
        afterFault_ = std::exchange(ended_, kPlayerEnded);
        const std::string how = WIFSIGNALED(status) ? "killed by signal " + std::to_string(WTERMSIG(status))
                                                    : "ended with " + std::to_string(WEXITSTATUS(status));
        note(event::kPlayerDied, how + "; next start in " + std::to_string(delay_.count()) + " ms");
    }

    void rigChanged() {
        note(event::kRigChanged);
        ended_ = kRigAnew;
        if (player_) kill(*player_, SIGTERM);
    }

    /// In the place of a player that had to be killed.
    void makeSafeInstead() {
        if (simulated()) return;
        const auto child = startChild(setup_, {"--make-safe"}, devices_.environment());
        if (!child) return note(event::kNoProcess);
        if (within(kSafeTime, [&] { return waitpid(*child, nullptr, WNOHANG) == *child; })) return;
        kill(*child, SIGKILL);
        waitpid(*child, nullptr, 0);
    }

    void tellManager() {
        if (!manager_.listens()) return;
        link_.poll(milliseconds(0));
        const auto& status = link_.status();
        if (!status.connected) return manager_.status("The player does not answer.");
        manager_.ready();
        manager_.alive();
        const bool slotted = status.light == devices::LightMode::slotted;
        manager_.status(!status.fault.empty() ? status.fault
                        : slotted             ? "Slotted light: a program plays."
                                              : "Steady white light, lens at rest.");
    }

    const CoreSetup& setup_;
    const Signals& signals_;
    ServiceManager& manager_;
    devices::CoreLink link_;
    DevicesKeeper devices_;
    GuardKeeper guard_;
    std::optional<pid_t> player_;
    Clock::time_point started_, nextStart_;
    milliseconds delay_{0};
    std::string ended_ = kPlayerEnded;  ///< why the player that runs will have ended, if it does
    std::string afterFault_;            ///< what the next player tells the studio
};

}  // namespace

int runSupervisor(const CoreSetup& setup, bool leaveDevices) {
    ServiceManager manager;
    const Signals signals{SIGTERM, SIGINT, SIGCHLD};
    comeFirst();
    startLog("output-core");
    const auto lock = devices::FileLock::tryTake(devices::supervisorLock(setup.runtimeDirectory));
    if (!lock || !*lock) {
        const std::string why =
            lock ? "An output core runs in \"" + setup.runtimeDirectory.string() + "\" already." : lock.error().what;
        std::fprintf(stderr, "%s\n", why.c_str());
        return 3;
    }
    note(event::kCoreStarted, "rig " + setup.played.word + ", in " + setup.runtimeDirectory.string());
    Supervisor supervisor(setup, signals, manager);
    supervisor.start();
    supervisor.watch();
    supervisor.stop(leaveDevices);
    note(event::kCoreStopped);
    return 0;
}

int stopSupervisor(const std::filesystem::path& runtimeDirectory, bool releaseDisplay) {
    const auto lock = devices::supervisorLock(runtimeDirectory);
    const auto pid = devices::FileLock::holder(lock);
    const bool runs = pid && *pid > 0;
    if (runs) kill(*pid, SIGTERM);
    if (runs && !within(kWholeStop, [&] { return !devices::FileLock::holder(lock); })) {
        std::fprintf(stderr, "The output core (process %d) does not stop.\n", *pid);
        return 1;
    }
    if (releaseDisplay) GuardKeeper::stopGuard(runtimeDirectory);
    if (runs) return 0;
    std::fprintf(stderr, "No output core runs in \"%s\".\n", runtimeDirectory.c_str());
    return 3;
}

}  // namespace ilf::app
