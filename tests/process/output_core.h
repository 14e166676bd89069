// A real output core with its devices, in a directory of its own, for tests that kill them.
#pragma once

#include <doctest/doctest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <string>
#include <thread>
#include <vector>

#include "app/output_core/stage_mark.h"
#include "devices/link/core_link.h"
#include "devices/link/start_core.h"
#include "devices/simulated/device_client.h"
#include "tests/devices/programs.h"

namespace ilf::test {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;
using std::chrono::seconds;

/// How many kills: 10, or what ILF_KILLS says.
inline int kills() {
    const char* set = std::getenv("ILF_KILLS");
    return set != nullptr && std::atoi(set) > 0 ? std::atoi(set) : 10;
}

/// On the ideal lens, which plays the powers of programs made by hand, unless told another.
class OutputCore {
public:
    explicit OutputCore(std::string lens = "ideal", std::string rig = "simulated", bool leavesDevices = false,
                        bool makesTapes = false)
        : directory_(temporary()), arguments_{"--simulated-lens", std::move(lens), "--rig", std::move(rig)} {
        if (leavesDevices) arguments_.emplace_back("--leave-devices");
        if (makesTapes) {
            std::filesystem::create_directory(tapes());
            arguments_.insert(arguments_.end(), {"--tapes", tapes().string()});
        }
        setenv("XDG_STATE_HOME", (directory_ / "state").c_str(), 1);
        start();
    }
    ~OutputCore() {
        for (const auto& lock : {devices::supervisorLock(directory_), devices::playerLock(directory_),
                                 app::guardLock(directory_), devices::devicesLock(directory_)})
            if (const auto pid = devices::FileLock::holder(lock); pid && *pid > 0) kill(*pid, SIGKILL);
        std::error_code ignored;
        std::filesystem::remove_all(directory_, ignored);
    }
    OutputCore(const OutputCore&) = delete;
    OutputCore& operator=(const OutputCore&) = delete;

    void start() {
        const auto running = devices::ensureCoreRunning(ILF_CORE_PATH, directory_, arguments_);
        REQUIRE_MESSAGE(running.has_value(), (running ? "" : running.error().what));
    }
    const std::filesystem::path& directory() const { return directory_; }
    std::filesystem::path tapes() const { return directory_ / "tapes"; }
    int supervisor() const { return devices::FileLock::holder(devices::supervisorLock(directory_)).value_or(0); }
    int player() const { return devices::FileLock::holder(devices::playerLock(directory_)).value_or(0); }
    int guard() const { return devices::FileLock::holder(app::guardLock(directory_)).value_or(0); }
    int devicesPid() const { return devices::FileLock::holder(devices::devicesLock(directory_)).value_or(0); }

    devices::CoreLink connected() const {
        devices::CoreLink link(directory_);
        REQUIRE(until(link, seconds(5), [](const devices::Status& s) { return s.connected; }));
        return link;
    }
    /// Moves the link until the status is as wanted.
    static bool until(devices::CoreLink& link, milliseconds time,
                      const std::function<bool(const devices::Status&)>& wanted) {
        const auto deadline = Clock::now() + time;
        while (!wanted(link.status())) {
            if (Clock::now() > deadline) return false;
            link.poll(milliseconds(20));
        }
        return true;
    }
    /// TAKE, and wait for it.
    static void take(devices::CoreLink& link, const Program& program, std::uint64_t revision) {
        const auto sent = link.send(program, revision, devices::Why::take);
        REQUIRE_MESSAGE(sent.has_value(), (sent ? "" : sent.error().what));
        REQUIRE(until(link, seconds(5), [&](const devices::Status& s) { return s.revisionPlayed == revision; }));
    }
    /// Asks the devices until they are as wanted.
    bool devicesBecome(milliseconds time, const std::function<bool(const devices::DeviceState&)>& wanted) const {
        auto client = devicesClient();
        const auto deadline = Clock::now() + time;
        while (Clock::now() <= deadline) {
            const auto state = client.readState();
            if (state && wanted(*state)) return true;
            std::this_thread::sleep_for(milliseconds(5));
        }
        return false;
    }
    /// Patient: it is this process, not the devices, that a busy machine keeps waiting.
    devices::DeviceClient devicesClient() const { return devices::DeviceClient(directory_, seconds(3)); }
    devices::DeviceState deviceState() const {
        const auto state = devicesClient().readState();
        REQUIRE_MESSAGE(state.has_value(), (state ? "" : state.error().what));
        return *state;
    }

private:
    static std::filesystem::path temporary() {
        std::string name = (std::filesystem::temp_directory_path() / "ilf-core-XXXXXX").string();
        REQUIRE(mkdtemp(name.data()) != nullptr);
        return name;
    }
    std::filesystem::path directory_;
    std::vector<std::string> arguments_;
};

inline bool safe(const devices::DeviceState& s) {
    return s.light == devices::LightMode::steady && s.lens == devices::LensMode::rest && s.hashShown == 0;
}

/// What the devices were told last, for a failing check.
inline std::string words(const devices::DeviceState& s) {
    std::string out = "watchdog trips: " + std::to_string(s.watchdogTrips) + "; log:";
    for (const auto& line : s.log)
        out += "\n  " + line;
    return out;
}

/// What must hold after whatever happened.
inline void checkOrderKept(const devices::DeviceState& s) {
    CHECK(s.rateChangesUnderSlottedLight == 0);
    CHECK(s.waveformChangesUnderSlottedLight == 0);
}

}  // namespace ilf::test
