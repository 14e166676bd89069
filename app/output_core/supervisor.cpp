#include <fcntl.h>
#include <spdlog/spdlog.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <optional>
#include <string>
#include <thread>

#include "app/output_core/log.h"
#include "app/output_core/priority.h"
#include "app/output_core/roles.h"
#include "app/output_core/signals.h"
#include "devices/link/runtime_directory.h"
#include "devices/link/start_core.h"
#include "devices/simulated/device_client.h"

namespace ilf::app {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

// A simulated machine that vanished is switched on again after this long: time enough to see what its loss does.
constexpr milliseconds kDevicesBack{1500};
// A player that lived this long did not crash because it was started.
constexpr std::chrono::seconds kGoodLife{5};
// One that crashes again and again must not keep the machine busy, but an operator waits for no more than this.
constexpr milliseconds kFirstDelay{20}, kLongestDelay{320};
// An orderly stop: safe light takes a few calls, each with its time limit.
constexpr milliseconds kStopTime{3000};

std::filesystem::path ownExecutable() { return std::filesystem::read_symlink("/proc/self/exe"); }

template <class Condition>
bool within(milliseconds time, Condition condition) {
    const auto deadline = Clock::now() + time;
    while (!condition()) {
        if (Clock::now() > deadline) return false;
        std::this_thread::sleep_for(milliseconds(5));
    }
    return true;
}

class Supervisor {
public:
    Supervisor(const std::filesystem::path& directory, const Signals& signals, devices::SimulatedLens lens)
        : directory_(directory), signals_(signals), lens_(lens), executable_(ownExecutable()), devices_(directory) {}

    void start() {
        startDevices();
        // A player may be left whose supervisor was killed a moment ago; it ends by itself, in safe light.
        if (!within(kStopTime, [&] { return !devices::FileLock::holder(devices::playerLock(directory_)); }))
            if (const auto pid = devices::FileLock::holder(devices::playerLock(directory_)); pid && *pid > 0)
                kill(*pid, SIGKILL);
        makeSafe();
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
            watchDevices();
        }
    }

    void stop(bool leaveDevices) {
        if (player_) {
            kill(*player_, SIGTERM);
            if (!within(kStopTime, [&] { return waitpid(*player_, nullptr, WNOHANG) == *player_; })) {
                kill(*player_, SIGKILL);
                waitpid(*player_, nullptr, 0);
            }
        }
        makeSafe();
        if (leaveDevices) return;
        const auto lock = devices::devicesLock(directory_);
        if (const auto pid = devices::FileLock::holder(lock); pid && *pid > 0) {
            kill(*pid, SIGTERM);
            within(kStopTime, [&] { return !devices::FileLock::holder(lock); });
        }
    }

private:
    int untilNextStart() const {
        if (player_) return 100;
        const auto left = std::chrono::ceil<milliseconds>(nextStart_ - Clock::now());
        return static_cast<int>(std::clamp(left.count(), std::chrono::milliseconds::rep{0}, milliseconds::rep{100}));
    }

    void makeSafe() {
        if (const auto safe = devices_.safeLight(); !safe) spdlog::error("safe light failed: {}", safe.error().what);
    }

    void startDevices() {
        if (devices::FileLock::holder(devices::devicesLock(directory_))) return;
        const auto log = devices::stateDirectory() / "simulated-devices.out";
        const auto started = devices::startDetached(
            executable_,
            {"--devices", "--runtime-dir", directory_.string(), "--simulated-lens", std::string(devices::word(lens_))},
            log);
        if (!started) spdlog::error("{}", started.error().what);
        if (!within(milliseconds(3000), [&] { return devices_.readState().has_value(); }))
            spdlog::error("the simulated devices do not answer; see {}", log.string());
    }

    void watchDevices() {
        const auto now = Clock::now();
        if (devices::FileLock::holder(devices::devicesLock(directory_))) {
            devicesGone_.reset();
        } else if (!devicesGone_) {
            spdlog::error("the simulated devices are gone");
            devicesGone_ = now;
        } else if (now - *devicesGone_ > kDevicesBack) {
            startDevices();
        }
    }

    void startPlayer() {
        const pid_t self = getpid();
        const std::string executable = executable_.string(), directory = directory_.string();
        const pid_t child = fork();
        if (child < 0) {
            spdlog::error("no room for the player's process");
            nextStart_ = Clock::now() + kLongestDelay;
            return;
        }
        if (child == 0) {
            // The player goes, in safe light, when this process is killed; also if that happened a moment ago.
            prctl(PR_SET_PDEATHSIG, SIGTERM);
            if (getppid() != self) _exit(1);
            execl(executable.c_str(), executable.c_str(), "--player", "--runtime-dir", directory.c_str(),
                  "--after-fault", afterFault_.c_str(), nullptr);
            _exit(127);
        }
        player_ = child;
        started_ = Clock::now();
        spdlog::info("player started: process {}", child);
    }

    void playerDied(int status) {
        makeSafe();
        player_.reset();
        const bool crashed = Clock::now() - started_ < kGoodLife;
        delay_ = crashed ? std::min(2 * std::max(delay_, kFirstDelay), kLongestDelay) : kFirstDelay;
        nextStart_ = Clock::now() + delay_;
        afterFault_ = "The output core's player ended unexpectedly; the light is steady and the lens rests. TAKE plays "
                      "again.";
        if (WIFSIGNALED(status))
            spdlog::error("the player was killed by signal {}; safe light; next start in {} ms", WTERMSIG(status),
                          delay_.count());
        else
            spdlog::error("the player ended with {}; safe light; next start in {} ms", WEXITSTATUS(status),
                          delay_.count());
    }

    std::filesystem::path directory_;
    const Signals& signals_;
    devices::SimulatedLens lens_;
    std::filesystem::path executable_;
    devices::DeviceClient devices_;
    std::optional<pid_t> player_;
    Clock::time_point started_, nextStart_;
    milliseconds delay_{0};
    std::string afterFault_;  ///< what the next player tells the studio
    std::optional<Clock::time_point> devicesGone_;
};

}  // namespace

int runSupervisor(const std::filesystem::path& runtimeDirectory, bool leaveDevices, devices::SimulatedLens lens) {
    const Signals signals{SIGTERM, SIGINT, SIGCHLD};
    comeFirst();
    startLog("output-core");
    const auto lock = devices::FileLock::tryTake(devices::supervisorLock(runtimeDirectory));
    if (!lock || !*lock) {
        const std::string why =
            lock ? "An output core runs in \"" + runtimeDirectory.string() + "\" already." : lock.error().what;
        std::fprintf(stderr, "%s\n", why.c_str());
        return 3;
    }
    spdlog::info("output core started in {}", runtimeDirectory.string());
    Supervisor supervisor(runtimeDirectory, signals, lens);
    supervisor.start();
    supervisor.watch();
    supervisor.stop(leaveDevices);
    spdlog::info("output core stopped");
    return 0;
}

int stopSupervisor(const std::filesystem::path& runtimeDirectory) {
    const auto lock = devices::supervisorLock(runtimeDirectory);
    const auto pid = devices::FileLock::holder(lock);
    if (!pid || *pid <= 0) {
        std::fprintf(stderr, "No output core runs in \"%s\".\n", runtimeDirectory.c_str());
        return 3;
    }
    kill(*pid, SIGTERM);
    if (within(4 * kStopTime, [&] { return !devices::FileLock::holder(lock); })) return 0;
    std::fprintf(stderr, "The output core (process %d) does not stop.\n", *pid);
    return 1;
}

}  // namespace ilf::app
