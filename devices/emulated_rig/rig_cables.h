// The emulated projector and converter on their bus, the wires between them, and a lens for each eye.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <memory>
#include <string>
#include <vector>

#include "devices/emulated_rig/received_sweeps.h"
#include "devices/emulated_rig/sampled_lens.h"
#include "devices/emulators/daq.h"
#include "devices/emulators/light_crafter.h"
#include "devices/emulators/usb_host.h"
#include "devices/link/messages.h"
#include "devices/link/runtime_directory.h"

namespace ilf::devices {

/// AI0 hears TRIG_OUT_2, AI1 hears AO0; AO0 drives the left lens, AO1 the right. Calls may come from any thread.
class RigCables {
public:
    /// Everything plugged in and as it is when switched on, but for the video.
    static Result<std::unique_ptr<RigCables>> started(LensPreset preset);
    ~RigCables();
    RigCables(const RigCables&) = delete;
    RigCables& operator=(const RigCables&) = delete;

    std::int64_t now_ns() const { return bus_->now_ns(); }
    const std::string& busDirectory() const { return bus_->directory(); }

    void plugVideo(double refresh_Hz);
    void unplugVideo();
    /// A vertical sync that was due at `due_ns`; `frame` begins to come in. Told late, it is no less on time: light and
    /// triggers follow from `due_ns`, and the converter samples no further than that.
    void sync(emulators::FramePtr frame, std::int64_t due_ns);
    /// Time goes on where no video comes: what the projector shows by itself is taken.
    void withoutVideo();

    /// See RigMishap, for the projector and the lenses.
    Result<void> befall(const RigMishap& mishap);
    /// What came of the newest whole sweep; `light` gets its exposures' pictures.
    Received received(std::vector<emulators::LightSlot>& light);
    DeviceState state();

private:
    explicit RigCables(LensPreset preset);
    void wire();
    double inputVolts(int channel, std::int64_t time_ns);
    void hearTriggers(std::int64_t now_ns);
    void takeLight(std::int64_t now_ns);
    void moveLenses(std::int64_t now_ns);

    std::unique_ptr<emulators::UsbHost> bus_;
    LensPreset preset_;
    // All that follows is touched only while the bus is locked.
    emulators::EmulatedLightCrafter projector_;
    emulators::EmulatedDaq converter_;
    std::deque<emulators::TriggerEdge> onTheWire_;
    bool triggerHigh_ = false;
    std::array<SampledLens, 2> lenses_;
    ReceivedSweeps sweeps_;
    std::array<std::vector<emulators::DeviceFault>, 2> faults_;  ///< of projector and lenses
};

}  // namespace ilf::devices
