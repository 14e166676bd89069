#include "devices/survey/machine_check.h"

#include <grp.h>
#include <sched.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <thread>

#include "devices/survey/udev_rules.h"

namespace ilf::devices {
namespace {

namespace fs = std::filesystem;

constexpr const char* kLimits = "/etc/security/limits.d/70-illuminatedfocus.conf";
/// Of SCHED_FIFO, below the kernel's own threads (50).
constexpr int kPriority = 20;
/// A program with its pictures and waves; more never hurts.
constexpr rlim_t kLocked = rlim_t{512} << 20;
constexpr const char* kMode = "912x1140";
/// The community's mode with 83.68 in place of 83.60 MHz: 60.001 Hz, as the lenses' sweep needs it, not 59.94.
constexpr const char* kModeLine = "83.68 912 952 1016 1192 1140 1150 1156 1170 +HSync +VSync";

std::string thisUser() {
    const std::string name = userName();
    return name.empty() ? "this user" : name;
}

bool inGroup(const char* name) {
    const group* wanted = getgrnam(name);  // NOLINT(concurrency-mt-unsafe)
    if (wanted == nullptr) return false;
    std::vector<gid_t> groups(static_cast<std::size_t>(std::max(getgroups(0, nullptr), 0)));
    const int count = getgroups(static_cast<int>(groups.size()), groups.data());
    groups.resize(static_cast<std::size_t>(std::max(count, 0)));
    return getegid() == wanted->gr_gid || std::find(groups.begin(), groups.end(), wanted->gr_gid) != groups.end();
}

bool udevRuns(const SystemPlaces& places) {
    std::error_code none;
    return fs::exists(places / "run/udev/control", none);
}

MachineCheck rules(const InstalledRules& installed, bool udev) {
    MachineCheck check{"udev-rules", Standing::good, "", "", {}};
    if (installed.same) {
        check.what = "USB rules are installed (" + installed.file.string() + ").";
    } else if (!installed.file.empty() && !installed.ours) {
        check.standing = Standing::missing;
        check.what = installed.file.string() + " was written by somebody else, or hides this program's USB rules.";
        check.help = "It is left as it is. Ask who wrote it, move it away, then install the rules:";
        check.commands = {installCommand()};
    } else {
        check.standing = Standing::missing;
        check.what = installed.file.empty()
                         ? "USB rules are not installed, so only root may open projector and converter."
                         : "USB rules in " + installed.file.string() + " are those of another version.";
        check.help = "Install them:";
        check.commands = {installCommand()};
    }
    if (!udev) check.what += " udev does not run here (a container?): permissions are set outside of it.";
    return check;
}

MachineCheck groups() {
    MachineCheck check{"groups", Standing::good, "", "", {}};
    const char* seat = std::getenv("XDG_SEAT");  // NOLINT(concurrency-mt-unsafe): nothing here sets variables
    if (geteuid() == 0) {
        check.what = "This is root, who may open every device. Play shows as an ordinary user.";
    } else if (seat != nullptr && *seat != '\0') {
        check.what = "Logged in at the screen: the USB rules are enough, no group is needed.";
    } else if (inGroup("plugdev") && inGroup("dialout")) {
        check.what = "This user is in the groups plugdev (USB) and dialout (serial ports).";
    } else {
        check.standing = Standing::missing;
        check.what = "Not logged in at the screen (ssh, or a service), and not in the groups plugdev and dialout.";
        check.help = "Join them, then log in again:";
        check.commands = {joinCommand("plugdev,dialout,video")};
    }
    return check;
}

MachineCheck modemManager(const SystemPlaces& places, bool ignored) {
    std::error_code none;
    const bool there = fs::exists(places / "usr/sbin/ModemManager", none);
    MachineCheck check{"modem-manager", Standing::good, "", "", {}};
    if (!there) {
        check.what = "ModemManager is not on this machine: nobody else talks to serial ports.";
    } else if (ignored) {
        check.what = "ModemManager leaves the lens driver's port alone (the USB rules say so).";
    } else {
        check.standing = Standing::missing;
        check.what = "ModemManager will take the lens driver for a modem and talk to it for some seconds after it is "
                     "plugged in.";
        check.help = "The USB rules above forbid it; then unplug the lens driver and plug it in again.";
    }
    return check;
}

/// Tried on a thread that ends at once, since neither limits nor root alone decide it.
bool mayRunInRealTime() {
    bool allowed = false;
    std::thread([&] {
        const sched_param wanted{kPriority};
        allowed = pthread_setschedparam(pthread_self(), SCHED_FIFO, &wanted) == 0;
    }).join();
    return allowed;
}

bool mayLockMemory() {
    rlimit limit{};
    if (getrlimit(RLIMIT_MEMLOCK, &limit) == 0 && limit.rlim_cur >= kLocked) return true;
    std::ifstream status("/proc/self/status");
    for (std::string line; std::getline(status, line);) {
        constexpr int kIpcLock = 14;  // capabilities(7): CAP_IPC_LOCK
        if (line.starts_with("CapEff:")) return (std::strtoull(line.c_str() + 7, nullptr, 16) >> kIpcLock & 1U) != 0;
    }
    return false;
}

std::string limitsCommand(const std::string& item) {
    // limits.conf(5): ":1000" is the user of that number.
    const std::string name = userName(), whom = name.empty() ? ":" + std::to_string(getuid()) : name;
    return "echo " + shellWord(whom + " - " + item) + " | sudo tee -a " + kLimits;
}

MachineCheck realTime() {
    if (mayRunInRealTime()) return {"real-time", Standing::good, "Real-time priority is allowed.", "", {}};
    return {"real-time",
            Standing::missing,
            "Real-time priority is not allowed to " + thisUser() +
                ": a busy machine may make the lenses late, and then a show stops in steady white light.",
            "Allow it, then log out and in again (in a container: start it with rtprio):",
            {limitsCommand("rtprio " + std::to_string(kPriority))}};
}

MachineCheck lockedMemory() {
    if (mayLockMemory()) return {"locked-memory", Standing::good, "Memory may be kept from being swapped out.", "", {}};
    return {"locked-memory",
            Standing::missing,
            "Locked memory is not allowed to " + thisUser() + ": swapping may make the lenses late.",
            "Allow it, then log out and in again:",
            {limitsCommand("memlock unlimited")}};
}

MachineCheck projectorDisplay(const SystemPlaces& places) {
    MachineCheck check{"projector-display", Standing::unknown, "", "", {}};
    std::string connected;
    bool any = false;
    std::error_code none;
    std::vector<fs::path> connectors;
    for (fs::directory_iterator it(places / "sys/class/drm", none), end; !none && it != end; it.increment(none))
        if (it->path().filename().string().find('-') != std::string::npos) connectors.push_back(it->path());
    std::sort(connectors.begin(), connectors.end());
    for (const fs::path& connector : connectors) {
        any = true;
        if (firstLine(connector / "status") != "connected") continue;
        const std::string name = connector.filename().string();
        const std::string output = name.substr(name.find('-') + 1);  // card0-HDMI-A-1
        std::ifstream modes(connector / "modes");
        for (std::string mode; std::getline(modes, mode);)
            if (mode == kMode) {
                check.standing = Standing::good;
                check.what = output + " offers " + kMode + ", as the projector needs it.";
                return check;
            }
        connected += (connected.empty() ? "" : ", ") + output + " (" + firstLine(connector / "modes") + ")";
    }
    if (!any) {
        check.what = std::string("No display can be asked on this machine (no graphics card in /sys/class/drm), so "
                                 "whether one offers ") +
                     kMode + " is not known.";
        return check;
    }
    check.standing = Standing::missing;
    check.what = std::string("No display offers ") + kMode + ". " +
                 (connected.empty() ? "No display is connected." : "Connected: " + connected + ".");
    check.help = "Connect the projector's HDMI input and switch the projector on. If its display is among those "
                 "connected, add the mode (OUTPUT as xrandr calls it):";
    check.commands = {std::string("xrandr --newmode ") + kMode + " " + kModeLine,
                      std::string("xrandr --addmode OUTPUT ") + kMode,
                      std::string("xrandr --output OUTPUT --mode ") + kMode};
    return check;
}

}  // namespace

std::string word(Standing standing) {
    return standing == Standing::good ? "good" : standing == Standing::missing ? "missing" : "unknown";
}

std::vector<MachineCheck> machineChecks(const SystemPlaces& places) {
    const InstalledRules installed = installedRules(places);
    return {rules(installed, udevRuns(places)),
            groups(),
            modemManager(places, installed.same),
            realTime(),
            lockedMemory(),
            projectorDisplay(places)};
}

}  // namespace ilf::devices
