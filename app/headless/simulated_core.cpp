#include "app/headless/simulated_core.h"

#include <cmath>
#include <cstdlib>
#include <thread>

#include "devices/link/core_link.h"
#include "devices/link/start_core.h"

namespace ilf::app {
namespace {

using Clock = std::chrono::steady_clock;

/// A core on a loaded machine may need this long to be heard, or to put a program on show.
constexpr std::chrono::seconds kPatience{15};

}  // namespace

Result<std::unique_ptr<SimulatedCore>> SimulatedCore::start(const std::string& coreProgram,
                                                            devices::SimulatedLens lens) {
    std::string name = (std::filesystem::temp_directory_path() / "ilf-run-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) {
        return fail(Fault::cannotWrite, "No temporary directory can be made for the simulated core: check " +
                                            std::filesystem::temp_directory_path().string() + ".");
    }
    auto core = std::unique_ptr<SimulatedCore>(new SimulatedCore(coreProgram, name));
    if (const auto started = devices::ensureCoreRunning(coreProgram, name, devices::coreArguments(lens)); !started)
        return tl::unexpected(started.error());
    return core;
}

SimulatedCore::SimulatedCore(std::string coreProgram, std::filesystem::path directory)
    : coreProgram_(std::move(coreProgram)), directory_(std::move(directory)) {}

SimulatedCore::~SimulatedCore() {
    const std::string stop =
        "'" + coreProgram_ + "' --runtime-dir '" + directory_.string() + "' --stop >/dev/null 2>&1";
    (void)std::system(stop.c_str());
    std::error_code ignored;
    std::filesystem::remove_all(directory_, ignored);
}

Result<Played> SimulatedCore::play(const Program& program, std::chrono::duration<double> time) {
    constexpr std::uint64_t kRevision = 1;
    devices::CoreLink link(directory_);
    const auto patience = Clock::now() + kPatience;
    while (!link.status().connected) {
        link.poll(std::chrono::milliseconds(50));
        if (Clock::now() > patience) return fail(Fault::device, "The simulated core does not answer: try again.");
    }
    const std::int64_t sent = devices::monotonicNs();
    if (const auto done = link.send(program, kRevision, devices::Why::take); !done) return tl::unexpected(done.error());
    while (link.status().revisionPlayed != kRevision) {
        link.poll(std::chrono::milliseconds(20));
        if (!link.status().fault.empty()) return fail(Fault::device, link.status().fault);
        if (!link.status().lastRefusal.empty()) return fail(Fault::device, link.status().lastRefusal);
        if (Clock::now() > patience) {
            return fail(Fault::device, "The simulated core did not put the program on show: try again.");
        }
    }
    Played played;
    played.sentToSwapped_ms = static_cast<double>(link.status().swapped_ns - sent) / 1e6;
    const auto until = Clock::now() + time;
    while (Clock::now() < until) {
        link.poll(std::chrono::milliseconds(50));
        if (!link.status().fault.empty()) return fail(Fault::device, link.status().fault);
    }
    devices::DeviceClient client(directory_);
    const auto state = client.readState();
    if (!state) return tl::unexpected(state.error());
    played.state = *state;
    played.sweeps =
        std::lround(static_cast<double>(state->now_ns - link.status().swapped_ns) * 1e-9 * program.waveform.rate.si());
    return played;
}

Result<LightImage> SimulatedCore::slot(int slot) {
    devices::DeviceClient client(directory_);
    auto image = client.readSlot(slot);
    if (!image) return tl::unexpected(image.error());
    return image->image;
}

}  // namespace ilf::app
