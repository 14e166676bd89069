// What a real output core over an emulated rig plays, and what its light and lenses were, for tests that kill
// processes.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include "tests/process/output_core.h"

namespace ilf::test {

/// Of a wearer whose lenses rest elsewhere than at 0 D.
inline constexpr Dioptre kRest = 1.0_D;

/// Six slots of four bits, seen through a lens that swings by 3 D.
inline Program shown(std::uint32_t seed) {
    Program p = program(seed, 2.0_D, {912, 1140});
    p.waveform.rest = kRest;
    p.waveform.unit = DriveUnit::ampere;
    p.waveform.drive.c = {0.005, 0.012};
    p.slotRate = 360.0_Hz;
    p.projectorDelay = 0.0_ms;
    p.imageOfSlot = {0, 0, Program::kDark, 1, 1, Program::kDark};
    return p;
}

/// What the rig received last, and the darkest and brightest pixel of all its exposures.
struct Seen {
    devices::Received received;
    int darkest = 255, brightest = 0;
    bool white() const { return !received.exposures.empty() && darkest == 255; }
    bool atRest(Dioptre rest) const {
        const auto near = [&](Dioptre power) { return abs(power - rest) < 0.25_D; };
        return std::all_of(received.left.begin(), received.left.end(), near) &&
               std::all_of(received.right.begin(), received.right.end(), near);
    }
};

inline std::optional<Seen> seen(devices::DeviceClient& client) {
    auto received = devices::ask<devices::Received>(client, devices::ReadReceived{});
    if (!received) return std::nullopt;
    Seen now{*std::move(received), 255, 0};
    for (std::size_t i = 0; i < now.received.exposures.size(); ++i) {
        const auto light = devices::ask<devices::ExposedLight>(client, devices::ReadExposure{static_cast<int>(i)});
        if (!light || light->light.empty()) return std::nullopt;
        const auto [low, high] = std::minmax_element(light->light.begin(), light->light.end());
        now.darkest = std::min<int>(now.darkest, *low);
        now.brightest = std::max<int>(now.brightest, *high);
    }
    return now;
}

/// Within `time` the light is white and the lens at `rest`. Counts sweeps that were all black on the way.
inline bool becomesSafe(const OutputCore& core, milliseconds time, Dioptre rest, int& black) {
    auto client = core.devicesClient();
    const auto deadline = Clock::now() + time;
    while (Clock::now() < deadline) {
        const auto now = seen(client);
        if (now && !now->received.exposures.empty() && now->brightest == 0) ++black;
        if (now && now->white() && now->atRest(rest)) return true;
        std::this_thread::sleep_for(milliseconds(20));
    }
    return false;
}

/// None where an emulated rig cannot run.
inline bool ready(devices::CoreLink& link) {
    const auto allWell = [](const devices::Status& s) {
        return s.devices.size() == 3 && std::all_of(s.devices.begin(), s.devices.end(), [](const auto& one) {
                   return one.health == devices::DeviceHealth::well;
               });
    };
    const auto lacking = [](const devices::Status& s) {
        return s.devices.size() == 1 && s.devices[0].line.find("Xvfb") != std::string::npos;
    };
    REQUIRE(OutputCore::until(link, seconds(20), [&](const devices::Status& s) { return allWell(s) || lacking(s); }));
    if (allWell(link.status())) return true;
    MESSAGE("SKIPPED: ", link.status().devices[0].line);
    return false;
}

/// TAKE. On a machine that is busy with other things a rig in real time may miss its time, which is a fault and safe
/// light; then again.
inline void taken(devices::CoreLink& link, const Program& program, std::uint64_t& revision) {
    for (int tries = 0; tries < 5; ++tries) {
        const auto faults = link.status().faults;
        const auto sent = link.send(program, ++revision, devices::Why::take);
        REQUIRE_MESSAGE(sent.has_value(), (sent ? "" : sent.error().what));
        REQUIRE(OutputCore::until(link, seconds(20), [&](const devices::Status& s) {
            return s.revisionPlayed == revision || s.faults != faults;
        }));
        if (link.status().revisionPlayed == revision) return;
        MESSAGE("taken again: ", link.status().fault);
        REQUIRE(ready(link));
    }
    FAIL("no take was played");
}

/// What was not white, or not at rest, within `time`; nothing: all was.
inline std::string leavesSafe(const OutputCore& core, milliseconds time, Dioptre rest) {
    auto client = core.devicesClient();
    const auto deadline = Clock::now() + time;
    while (Clock::now() < deadline) {
        const auto now = seen(client);
        if (now && !now->received.exposures.empty() && !now->white())
            return "light of " + std::to_string(now->darkest) + " to " + std::to_string(now->brightest);
        if (now && !now->atRest(rest)) return "a lens away from its rest";
        std::this_thread::sleep_for(milliseconds(20));
    }
    return "";
}

inline bool unmarked(const OutputCore& core, milliseconds time) {
    const auto deadline = Clock::now() + time;
    while (app::stageIsMarked(core.directory()) && Clock::now() < deadline)
        std::this_thread::sleep_for(milliseconds(20));
    return !app::stageIsMarked(core.directory());
}

}  // namespace ilf::test
