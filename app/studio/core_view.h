// The core's status as the window shows it.
#pragma once

#include <cstdint>
#include <string>

#include "app/studio/latency.h"
#include "devices/link/messages.h"
#include "ui/view.h"

namespace ilf::app {

inline ui::DeviceHealth healthView(devices::DeviceHealth health) {
    switch (health) {
    case devices::DeviceHealth::well:
        return ui::DeviceHealth::well;
    case devices::DeviceHealth::absent:
        return ui::DeviceHealth::absent;
    case devices::DeviceHealth::unplugged:
        return ui::DeviceHealth::unplugged;
    case devices::DeviceHealth::wrongMode:
        return ui::DeviceHealth::wrongMode;
    case devices::DeviceHealth::silent:
        break;
    }
    return ui::DeviceHealth::silent;
}

/// `sent` is the last revision that left the studio, `faultsSeen` how many faults the operator has acknowledged.
inline ui::CoreStatus coreView(const devices::Status& status, const std::string& trouble, std::uint64_t sent,
                               std::uint64_t faultsSeen, const Latency& latency) {
    ui::CoreStatus view;
    view.connected = status.connected;
    view.simulated = status.simulated;
    view.light = !status.connected                             ? ui::Light::unknown
                 : status.light == devices::LightMode::slotted ? ui::Light::slotted
                                                               : ui::Light::steady;
    view.revisionPlayed = status.revisionPlayed;
    view.revisionSent = sent;
    view.swaps = status.swaps;
    view.droppedUpdates = status.droppedUpdates;
    view.strokeToSwap_ms = latency.last_ms().value_or(0.0);
    view.projector = status.projectorLine;
    view.lens = status.lensLine;
    view.projectorWell = status.projectorWell;
    view.lensWell = status.lensWell;
    view.emulated = status.emulated;
    if (const auto& t = status.timing)
        view.timing = ui::CoreStatus::Timing{t->locked, t->phase, t->jitter, t->driftPpm, t->missedTriggers};
    view.lensTemperature_C = status.lensTemperature_C;
    for (const devices::DeviceLine& device : status.devices)
        view.devices.push_back({device.what, healthView(device.health), device.name, device.line});
    view.limits = status.limits;
    view.lastFault = !status.fault.empty() ? status.fault : trouble;
    view.faultSeen = view.lastFault.empty() || status.faults <= faultsSeen;
    return view;
}

}  // namespace ilf::app
