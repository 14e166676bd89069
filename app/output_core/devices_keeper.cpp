#include "app/output_core/devices_keeper.h"

#include <algorithm>
#include <csignal>
#include <cstdlib>

#include "app/output_core/events.h"
#include "app/output_core/wait.h"
#include "devices/link/rig_environment.h"
#include "devices/link/runtime_directory.h"

namespace ilf::app {
namespace {

using std::chrono::milliseconds;

// A machine that vanished is switched on again after this long: time enough to see what its loss does. One that fails
// again and again is left alone for longer and longer.
constexpr milliseconds kBack{1500}, kLongestBack{30000};
// An emulated rig starts a display server.
constexpr milliseconds kReady{3000}, kEmulatedReady{12000};
// By then a process has its lock, or has failed.
constexpr milliseconds kBegun{1500};
constexpr milliseconds kDevicesStopTime{3000};
constexpr const char* kUsbPreload = "libumockdev-preload.so.0";

/// What must be loaded before the C library for an emulated bus, after what already is (a sanitizer insists on that).
std::string withUsbPreload() {
    const char* before = std::getenv("LD_PRELOAD");  // NOLINT(concurrency-mt-unsafe): nothing here sets variables
    const std::string others = before != nullptr ? before : "";
    if (others.find("umockdev-preload") != std::string::npos) return others;
    return others.empty() ? kUsbPreload : others + ":" + kUsbPreload;
}

}  // namespace

bool DevicesKeeper::runs() const {
    return devices::FileLock::holder(devices::devicesLock(setup_.runtimeDirectory)).has_value();
}

bool DevicesKeeper::ready() {
    if (!runs()) return false;
    return emulated() ? devices::rigEnvironment(setup_.runtimeDirectory).has_value() : client_.readState().has_value();
}

void DevicesKeeper::startProcess() {
    Environment environment;
    if (emulated()) {
        devices::removeRigEnvironment(setup_.runtimeDirectory);  // of one that was killed
        environment = {{"LD_PRELOAD", withUsbPreload()}};
    }
    const auto started = startRole(setup_, {"--devices"}, "devices.out", environment);
    if (started)
        note(event::kDevicesStarted, setup_.played.word);
    else
        note(event::kNoProcess, started.error().what);
}

void DevicesKeeper::start() {
    if (!needed()) return;
    if (!runs()) startProcess();
    const auto begun = Clock::now();
    const bool there = within(emulated() ? kEmulatedReady : kReady,
                              [&] { return ready() || (!runs() && Clock::now() - begun > kBegun); });
    if (!there || !ready()) note(event::kDevicesSilent, "see " + (devices::stateDirectory() / "devices.out").string());
    sawAnother();
}

bool DevicesKeeper::sawAnother() {
    if (!emulated() || !runs()) return false;
    const auto now = devices::rigEnvironment(setup_.runtimeDirectory);
    if (!now || *now == environment_) return false;
    environment_ = *now;
    return true;
}

bool DevicesKeeper::watch() {
    if (!needed()) return false;
    const auto now = Clock::now();
    if (runs()) {
        gone_.reset();
        if (ready()) back_ = kBack;
    } else if (!gone_) {
        note(event::kDevicesGone, setup_.played.word);
        gone_ = now;
        back_ = std::clamp(2 * back_, kBack, kLongestBack);
    } else if (now - *gone_ > back_) {
        gone_.reset();
        startProcess();
        within(kBegun, [&] { return runs(); });
    }
    return sawAnother();
}

void DevicesKeeper::makeSafe() {
    if (setup_.played.machine != Machine::simulated) return;
    if (const auto safe = client_.safeLight(); !safe) note(event::kNotSafe, safe.error().what);
}

void DevicesKeeper::stop() {
    if (!needed()) return;
    const auto lock = devices::devicesLock(setup_.runtimeDirectory);
    if (const auto pid = devices::FileLock::holder(lock); pid && *pid > 0) {
        kill(*pid, SIGTERM);
        within(kDevicesStopTime, [&] { return !devices::FileLock::holder(lock); });
    }
}

}  // namespace ilf::app
