#include <array>
#include <chrono>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "app/output_core/roles.h"
#include "devices/link/core_link.h"
#include "devices/simulated/device_client.h"

namespace ilf::app {
namespace {

using nlohmann::json;

/// Hashes as text: JSON numbers lose bits beyond 2^53 in many readers.
std::string hex(std::uint64_t hash) {
    std::array<char, 17> text{};
    std::snprintf(text.data(), text.size(), "%016llx", static_cast<unsigned long long>(hash));
    return text.data();
}

const char* word(devices::LightMode light) { return light == devices::LightMode::slotted ? "slotted" : "steady"; }
const char* word(devices::LensMode lens) {
    switch (lens) {
    case devices::LensMode::rest:
        return "rest";
    case devices::LensMode::holding:
        return "holding";
    case devices::LensMode::sweeping:
        return "sweeping";
    }
    return "";
}

const char* word(devices::DeviceHealth health) {
    switch (health) {
    case devices::DeviceHealth::well:
        return "well";
    case devices::DeviceHealth::absent:
        return "absent";
    case devices::DeviceHealth::unplugged:
        return "unplugged";
    case devices::DeviceHealth::wrongMode:
        return "wrong-mode";
    case devices::DeviceHealth::silent:
        return "silent";
    }
    return "";
}

json written(const devices::StageTiming& timing) {
    return {{"locked", timing.locked},
            {"phase_us", timing.phase.in(1.0_us)},
            {"jitter_us", timing.jitter.in(1.0_us)},
            {"drift_ppm", timing.driftPpm},
            {"missed_triggers", timing.missedTriggers}};
}

json written(const std::vector<devices::DeviceLine>& lines) {
    json out = json::array();
    for (const auto& one : lines)
        out.push_back({{"what", one.what}, {"health", word(one.health)}, {"name", one.name}, {"line", one.line}});
    return out;
}

json written(const devices::Status& s) {
    return {{"connected", s.connected},
            {"pid", s.pid},
            {"supervisor_pid", s.supervisorPid},
            {"simulated", s.simulated},
            {"emulated", s.emulated},
            {"light", word(s.light)},
            {"safe_light_held", s.hold != 0},
            {"revision_played", s.revisionPlayed},
            {"hash_played", hex(s.contentHashPlayed)},
            {"swaps", s.swaps},
            {"dropped_updates", s.droppedUpdates},
            {"received_to_swapped_ms", static_cast<double>(s.swapped_ns - s.received_ns) * 1e-6},
            {"lens", word(s.lens)},
            {"sweep_D", {s.low.si(), s.high.si()}},
            {"projector", s.projectorLine},
            {"lens_line", s.lensLine},
            {"lens_name", s.lensName},
            {"lens_temperature_C", s.lensTemperature_C ? json(*s.lensTemperature_C) : json(nullptr)},
            {"timing", s.timing ? written(*s.timing) : json(nullptr)},
            {"devices", written(s.devices)},
            {"limits", s.limits},
            {"last_refusal", s.lastRefusal},
            {"fault", s.fault},
            {"faults", s.faults}};
}

json written(const devices::DeviceState& s) {
    json slots = json::array();
    for (const auto hash : s.slotHashes)
        slots.push_back(hex(hash));
    return {{"pid", s.pid},
            {"simulated", true},
            {"light", word(s.light)},
            {"slot_rate_Hz", s.slotRate.si()},
            {"hash_shown", hex(s.hashShown)},
            {"slot_hashes", std::move(slots)},
            {"swaps", s.swaps},
            {"lens", word(s.lens)},
            {"sweep_D", {s.waveform.low.si(), s.waveform.high.si()}},
            {"rest_D", s.waveform.rest.si()},
            {"power_D", s.powerNow.si()},
            {"lens_error_D", s.lensError.si()},
            {"lens_name", s.lensName},
            {"off_wave_D", s.offWave.si()},
            {"lens_temperature_C", s.lensTemperature_C},
            {"phase_error_us", s.phaseError.si() * 1e6},
            {"triggers_lost", s.triggersLost},
            {"rate_changes_under_slotted_light", s.rateChangesUnderSlottedLight},
            {"waveform_changes_under_slotted_light", s.waveformChangesUnderSlottedLight},
            {"refusals", s.refusals},
            {"watchdog_trips", s.watchdogTrips},
            {"log", s.log}};
}

}  // namespace

int printStatus(const std::filesystem::path& runtimeDirectory) {
    using Clock = std::chrono::steady_clock;
    json out{{"runtime_directory", runtimeDirectory.string()}, {"core", nullptr}, {"devices", nullptr}};
    devices::CoreLink link(runtimeDirectory);
    const auto deadline = Clock::now() + std::chrono::milliseconds(2000);
    while (!link.status().connected && Clock::now() < deadline)
        link.poll(std::chrono::milliseconds(50));
    if (link.status().connected) out["core"] = written(link.status());
    if (const auto state = devices::DeviceClient(runtimeDirectory, std::chrono::milliseconds(1000)).readState())
        out["devices"] = written(*state);
    std::printf("%s\n", out.dump(-1, ' ', false, json::error_handler_t::replace).c_str());
    return link.status().connected ? 0 : 3;
}

}  // namespace ilf::app
