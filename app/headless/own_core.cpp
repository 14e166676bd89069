#include "app/headless/own_core.h"

#include <cmath>
#include <cstdlib>
#include <thread>

#include "devices/link/start_core.h"

namespace ilf::app {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

/// A core on a loaded machine may need this long to be heard, or to put a program on show: a real projector arranges
/// its patterns and a lens settles first.
constexpr std::chrono::seconds kPatience{30};
/// A picture travels longer than a question.
constexpr milliseconds kRigAnswers{3000};
/// Safe light is reached at once, and the newest whole sweep is that of safe light a little later; a lens rings for
/// less.
constexpr milliseconds kSafeForAWhile{1500};

}  // namespace

Result<std::unique_ptr<OwnCore>> OwnCore::start(const std::string& coreProgram,
                                                const std::vector<std::string>& arguments) {
    std::string name = (std::filesystem::temp_directory_path() / "ilf-run-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) {
        return fail(Fault::cannotWrite, "No temporary directory can be made for the output core: check " +
                                            std::filesystem::temp_directory_path().string() + ".");
    }
    auto core = std::unique_ptr<OwnCore>(new OwnCore(coreProgram, name));
    if (const auto started = devices::ensureCoreRunning(coreProgram, name, arguments); !started)
        return tl::unexpected(started.error());
    core->link_ = std::make_unique<devices::CoreLink>(core->directory_);
    return core;
}

OwnCore::OwnCore(std::string coreProgram, std::filesystem::path directory)
    : coreProgram_(std::move(coreProgram)), directory_(std::move(directory)) {}

OwnCore::~OwnCore() {
    const std::string stop =
        "'" + coreProgram_ + "' --runtime-dir '" + directory_.string() + "' --stop --release-display >/dev/null 2>&1";
    (void)std::system(stop.c_str());
    std::error_code ignored;
    std::filesystem::remove_all(directory_, ignored);
}

Result<std::int64_t> OwnCore::shown(const Program& program, devices::Why why) {
    const auto patience = Clock::now() + kPatience;
    while (!link_->status().connected) {
        link_->poll(milliseconds(50));
        if (Clock::now() > patience) return fail(Fault::device, "The output core does not answer: try again.");
    }
    const std::int64_t sent = devices::monotonicNs();
    if (const auto done = link_->send(program, ++revision_, why); !done) return tl::unexpected(done.error());
    while (link_->status().revisionPlayed != revision_) {
        link_->poll(milliseconds(20));
        if (!link_->status().fault.empty()) return fail(Fault::device, link_->status().fault);
        if (!link_->status().lastRefusal.empty()) return fail(Fault::device, link_->status().lastRefusal);
        if (Clock::now() > patience) {
            return fail(Fault::device, "The output core did not put the program on show in time: try again.");
        }
    }
    return sent;
}

Result<Played> OwnCore::play(const Program& program, std::chrono::duration<double> time) {
    const auto sent = shown(program, devices::Why::take);
    if (!sent) return tl::unexpected(sent.error());
    Played played;
    const std::int64_t swapped_ns = link_->status().swapped_ns;
    played.sentToSwapped_ms = static_cast<double>(swapped_ns - *sent) / 1e6;
    const auto until = Clock::now() + time;
    while (Clock::now() < until) {
        link_->poll(milliseconds(50));
        if (!link_->status().fault.empty()) return fail(Fault::device, link_->status().fault);
    }
    played.status = link_->status();
    std::int64_t now_ns = devices::monotonicNs();
    if (played.status.simulated) {
        const auto state = devices::DeviceClient(directory_).readState();
        if (!state) return tl::unexpected(state.error());
        played.state = *state;
        now_ns = state->now_ns;
    }
    played.sweeps = std::lround(static_cast<double>(now_ns - swapped_ns) * 1e-9 * program.waveform.rate.si());
    return played;
}

Result<double> OwnCore::update(const Program& program) {
    const auto sent = shown(program, devices::Why::live);
    if (!sent) return tl::unexpected(sent.error());
    return static_cast<double>(link_->status().swapped_ns - *sent) / 1e6;
}

Result<Mishap> OwnCore::befall(const std::vector<devices::RigMishap>& mishaps, std::chrono::duration<double> patience) {
    devices::DeviceClient rig(directory_, kRigAnswers);
    for (const auto& mishap : mishaps) {
        if (const auto done = rig.mishap(mishap); !done) return tl::unexpected(done.error());
    }
    Mishap found;
    const auto begun = Clock::now(), until = begun + std::chrono::duration_cast<Clock::duration>(patience);
    while (link_->status().fault.empty() && Clock::now() < until)
        link_->poll(milliseconds(10));
    found.fault = link_->status().fault;
    found.noticed_ms = std::chrono::duration<double, std::milli>(Clock::now() - begun).count();
    const auto settled = Clock::now() + kSafeForAWhile;
    while (Clock::now() < settled)
        link_->poll(milliseconds(50));
    return found;
}

Result<LightImage> OwnCore::slot(int slot) {
    devices::DeviceClient client(directory_);
    auto image = client.readSlot(slot);
    if (!image) return tl::unexpected(image.error());
    return image->image;
}

Result<ReceivedSweep> OwnCore::received() {
    devices::DeviceClient rig(directory_, kRigAnswers);
    auto sweep = rig.readReceived();
    if (!sweep) return tl::unexpected(sweep.error());
    ReceivedSweep all{*std::move(sweep), {}};
    for (int number = 0; number < static_cast<int>(all.received.exposures.size()); ++number) {
        auto light = rig.readExposure(number);
        if (!light) return tl::unexpected(light.error());
        all.light.push_back(*std::move(light));
    }
    return all;
}

}  // namespace ilf::app
