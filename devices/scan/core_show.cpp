#include "devices/scan/core_show.h"

#include <chrono>
#include <exception>
#include <utility>

namespace ilf::devices {
namespace {

using std::chrono::milliseconds;
using std::chrono::steady_clock;

/// A real projector arranges its patterns and a lens settles before the first picture.
constexpr std::chrono::seconds kPatience{30};

}  // namespace

Program restingProgram(const Rig& rig, Dioptre rest, const Image<std::uint8_t>& picture) {
    Program program;
    program.waveform = stillWave(rest, rest, rig.sweepRate);
    program.slotRate = rig.slotRate;
    program.projectorDelay = rig.projectorDelay;
    program.projector = rig.projector;
    program.images = {toTiles(picture)};
    program.imageOfSlot.assign(static_cast<std::size_t>(slotsPerSweep(rig)), 0);
    return program;
}

CoreShow::CoreShow(const std::filesystem::path& runtimeDirectory, Rig rig, Dioptre rest, std::stop_token stop)
    : link_(runtimeDirectory), rig_(std::move(rig)), rest_(rest), stop_(std::move(stop)),
      revision_(static_cast<std::uint64_t>(monotonicNs())) {}  // not a number that a studio beside us uses

Result<Second> CoreShow::show(const Image<std::uint8_t>& picture) {
    const auto patience = steady_clock::now() + kPatience;
    const auto stopped = [&]() -> Result<Second> { return fail(Fault::device, "Showing patterns was cancelled."); };
    const bool first = !link_.status().connected;
    while (!link_.status().connected) {
        link_.poll(milliseconds(50));
        if (stop_.stop_requested()) return stopped();
        if (steady_clock::now() > patience)
            return fail(Fault::device, "The output core does not answer: start it, or try again.");
    }
    const Program program = restingProgram(rig_, rest_, picture);
    const auto sent = link_.send(program, ++revision_, first ? Why::take : Why::live);
    if (!sent) return tl::unexpected(sent.error());
    while (link_.status().revisionPlayed != revision_) {
        link_.poll(milliseconds(10));
        const Status& status = link_.status();
        if (stop_.stop_requested()) return stopped();
        if (!status.fault.empty() && !first) return fail(Fault::device, status.fault);
        if (!status.lastRefusal.empty()) return fail(Fault::device, status.lastRefusal);
        if (steady_clock::now() > patience)
            return fail(Fault::device, status.fault.empty()
                                           ? "The output core did not put a pattern on show in time: try again."
                                           : status.fault);
    }
    return Second::fromSi(1e-9 * static_cast<double>(link_.status().swapped_ns));
}

Result<void> CoreShow::hold(std::chrono::milliseconds time) {
    for (const auto end = steady_clock::now() + time; steady_clock::now() < end && !stop_.stop_requested();)
        link_.poll(milliseconds(10));
    const Status& status = link_.status();
    if (!status.connected) return fail(Fault::device, "The connection to the output core was lost.");
    if (status.light == LightMode::steady)
        return fail(Fault::device,
                    status.fault.empty() ? "Safe light was asked for: nothing is shown any more." : status.fault);
    return {};
}

void CoreShow::safe() noexcept {
    try {
        if (!link_.safeLight()) return;
        // Said by the core when it is so.
        const auto patience = steady_clock::now() + std::chrono::seconds(3);
        while (link_.status().connected && link_.status().light != LightMode::steady && steady_clock::now() < patience)
            link_.poll(milliseconds(20));
    } catch (const std::exception&) {  // out of memory: the core's supervisor sees to safe light
    }
}

}  // namespace ilf::devices
