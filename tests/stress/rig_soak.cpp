// rig_soak [SECONDS] [EVERY_S]: the output core on the emulated rig while cables are pulled and put back. One line of
// CSV every ten seconds: events, takes, refusals and the memory of each process. Ends with 1 when a take did not put
// its program on show, light other than intended was received, or memory grew by more than a tenth after the first
// minute.
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>

#include "app/headless/prepare.h"
#include "devices/link/core_link.h"
#include "devices/link/runtime_directory.h"
#include "devices/link/start_core.h"
#include "devices/simulated/device_client.h"

namespace {

using namespace ilf;
using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

/// Resident, in MiB; 0: no such process.
double resident_MiB(int pid) {
    std::ifstream file("/proc/" + std::to_string(pid) + "/statm");
    long all = 0, resident = 0;
    file >> all >> resident;
    return static_cast<double>(resident) * static_cast<double>(sysconf(_SC_PAGESIZE)) / (1024.0 * 1024.0);
}

struct Memory {
    double supervisor = 0.0, player = 0.0, rig = 0.0;
};

class Soak {
public:
    Soak(const std::filesystem::path& directory, const Program& program, Clock::duration every)
        : directory_(directory), program_(program), every_(every), link_(directory),
          rig_(directory, milliseconds(3000)) {}

    int run(Clock::duration time) {
        std::puts("s,pulled,put back,takes,shown,faults,player starts,power cycles,supervisor_MiB,player_MiB,rig_MiB");
        const auto start = Clock::now();
        auto nextEvent = start + every_, nextLine = start;
        while (Clock::now() - start < time) {
            link_.poll(milliseconds(20));
            watch();
            if (Clock::now() >= nextEvent) {
                event();
                nextEvent += every_;
            }
            if (Clock::now() >= nextLine) {
                line(std::chrono::duration<double>(Clock::now() - start).count());
                nextLine += std::chrono::seconds(10);
            }
        }
        if (pulled_) event();
        // What was on its way when the time was over must still come.
        const auto patience = Clock::now() + std::chrono::seconds(60);
        while (Clock::now() < patience && link_.status().revisionPlayed == 0) {
            link_.poll(milliseconds(20));
            watch();
        }
        line(std::chrono::duration<double>(Clock::now() - start).count());
        return judged();
    }

private:
    static constexpr const char* kCables[] = {"lenses", "projector", "display"};

    /// Cables are pulled one after the other, each for one step.
    void event() {
        const char* cable = kCables[static_cast<std::size_t>(pulls_) % std::size(kCables)];
        const auto done = rig_.mishap({cable, pulled_ ? "plug" : "unplug", 0, 0, 0.0});
        if (!done) std::fprintf(stderr, "%s: %s\n", cable, done.error().what.c_str());
        if (pulled_) ++pulls_;
        pulled_ = !pulled_;
    }

    bool devicesWell() const {
        for (const auto& device : link_.status().devices)
            if (device.health != devices::DeviceHealth::well) return false;
        return !link_.status().devices.empty();
    }

    /// Presses TAKE whenever light is safe and all devices are back, as an operator would.
    void watch() {
        const auto& status = link_.status();
        if (status.connected && status.pid != player_) {
            player_ = status.pid;
            ++starts_;
        }
        if (!status.connected || pulled_) return;
        // A board hangs after some 25 changes from patterns to video, as users report of the real one.
        for (const auto& device : status.devices)
            if (device.what == "projector" && device.health == devices::DeviceHealth::silent &&
                Clock::now() - cycledAt_ > std::chrono::seconds(5) &&
                rig_.mishap({"projector", "power-cycle", 0, 0, 0.0})) {
                cycledAt_ = Clock::now();
                ++powerCycles_;
            }
        if (status.revisionPlayed == revision_ && revision_ != 0) {
            if (shownRevision_ != revision_) ++shown_;
            shownRevision_ = revision_;
            return;
        }
        if (status.hold == 0 || !devicesWell() || Clock::now() - takenAt_ < std::chrono::seconds(1)) return;
        if (takenHold_ == status.hold && Clock::now() - takenAt_ < std::chrono::seconds(15)) return;
        if (link_.send(program_, ++revision_, devices::Why::take)) {
            ++takes_;
            takenHold_ = status.hold;
            takenAt_ = Clock::now();
        }
    }

    void line(double seconds) {
        const auto& s = link_.status();
        const auto devices = devices::FileLock::holder(devices::devicesLock(directory_));
        const Memory now{resident_MiB(s.supervisorPid), resident_MiB(s.pid), resident_MiB(devices.value_or(0))};
        std::printf("%.0f,%d,%d,%d,%d,%llu,%d,%d,%.1f,%.1f,%.1f\n", seconds, pulls_ + (pulled_ ? 1 : 0), pulls_, takes_,
                    shown_, static_cast<unsigned long long>(s.faults), starts_, powerCycles_, now.supervisor,
                    now.player, now.rig);
        std::fflush(stdout);
        Memory& most = seconds < 60.0 ? early_ : late_;
        most.supervisor = std::max(most.supervisor, now.supervisor);
        most.player = std::max(most.player, now.player);
        most.rig = std::max(most.rig, now.rig);
    }

    int judged() const {
        const auto grew = [](const char* who, double early, double late) {
            if (late <= 1.1 * early) return false;
            std::fprintf(stderr, "%s grew from %.1f to %.1f MiB\n", who, early, late);
            return true;
        };
        bool good = true;
        if (link_.status().revisionPlayed != revision_ || shown_ == 0) {
            std::fprintf(stderr, "the last program is not on show: %s\n", link_.status().fault.c_str());
            good = false;
        }
        if (starts_ != 1) {
            std::fprintf(stderr, "the player ended and was started again\n");
            good = false;
        }
        good &= !grew("the supervisor", early_.supervisor, late_.supervisor);
        good &= !grew("the player", early_.player, late_.player);
        good &= !grew("the emulated rig", early_.rig, late_.rig);
        return good ? 0 : 1;
    }

    std::filesystem::path directory_;
    const Program& program_;
    Clock::duration every_;
    devices::CoreLink link_;
    devices::DeviceClient rig_;
    int pulls_ = 0, takes_ = 0, shown_ = 0, player_ = 0, starts_ = 0, powerCycles_ = 0;
    bool pulled_ = false;
    std::uint64_t revision_ = 0, shownRevision_ = 0, takenHold_ = 0;
    Clock::time_point takenAt_, cycledAt_;
    Memory early_, late_;  ///< the most of the first minute, and since
};

}  // namespace

int main(int argc, char** argv) {
    const double seconds = argc > 1 ? std::atof(argv[1]) : 60.0, every = argc > 2 ? std::atof(argv[2]) : 3.0;
    if (!(seconds > 0.0) || !(every > 0.0)) {
        std::fputs("rig_soak [SECONDS] [EVERY_S]: both must be above 0.\n", stderr);
        return 2;
    }
    app::RigChoice choice;
    choice.rig = "emulated";
    const auto project = app::prepared(ILF_SOURCE_DIR "/projects/samples/museum-guide.ilfd", choice);
    const auto arguments = app::coreArguments(choice);
    if (!project || !arguments) {
        std::fprintf(stderr, "%s\n", (project ? arguments.error() : project.error()).what.c_str());
        return 1;
    }
    std::string directory = (std::filesystem::temp_directory_path() / "ilf-soak-XXXXXX").string();
    if (mkdtemp(directory.data()) == nullptr) return 1;
    int result = 1;
    if (const auto started = devices::ensureCoreRunning(ILF_CORE_PATH, directory, *arguments); started) {
        const auto duration = [](double s) {
            return std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(s));
        };
        result = Soak(directory, project->compiled.program, duration(every)).run(duration(seconds));
    } else {
        std::fprintf(stderr, "%s\n", started.error().what.c_str());
    }
    const std::string stop = std::string(ILF_CORE_PATH) + " --runtime-dir '" + directory + "' --stop";
    if (std::system(stop.c_str()) != 0) result = 1;
    std::error_code ignored;
    std::filesystem::remove_all(directory, ignored);
    return result;
}
