#include "devices/emulated_rig/rig_cables.h"

#include <algorithm>
#include <cmath>

#include "devices/emulated_rig/emulated_rig.h"
#include "devices/emulated_rig/rig_mishaps.h"

namespace ilf::devices {
namespace {

using emulators::Mishap;

constexpr double kLogic_V = 3.3;
constexpr int kTriggerInput = 0, kEchoInput = 1;
// The converter asks for triggers as late as the projector may be told its syncs.
constexpr std::int64_t kWireRemembers_ns = 1'000'000'000;
constexpr std::size_t kPowers = 240;
constexpr Dioptre kStill = 0.02_D;

Second seconds(std::int64_t ns) { return Second::fromSi(1e-9 * static_cast<double>(ns)); }

/// Syncs that a busy machine tells late are on time all the same (RigVideo makes up for half a second of them).
emulators::LightCrafterOptions patient() {
    emulators::LightCrafterOptions options;
    options.framesAwaited = 40;
    return options;
}

const char* place(std::size_t device) { return device == 0 ? kEmulatedProjectorAt : kEmulatedLensesAt; }

}  // namespace

RigCables::RigCables(LensPreset preset)
    : preset_(preset), projector_(patient()),
      lenses_{SampledLens(preset, monotonicNs()), SampledLens(preset, monotonicNs())} {}

Result<std::unique_ptr<RigCables>> RigCables::started(LensPreset preset) {
    auto bus = emulators::UsbHost::started();
    if (!bus) return tl::unexpected(bus.error());
    std::unique_ptr<RigCables> rig(new RigCables(preset));
    rig->bus_ = *std::move(bus);
    rig->wire();
    auto plugged = rig->bus_->plug(kEmulatedProjectorAt, rig->projector_).and_then([&] {
        return rig->bus_->plug(kEmulatedLensesAt, rig->converter_);
    });
    if (!plugged) return tl::unexpected(plugged.error());
    return rig;
}

RigCables::~RigCables() {
    bus_.reset();  // before the devices on it
}

void RigCables::wire() {
    converter_.setInput([this](int channel, std::int64_t time_ns) { return inputVolts(channel, time_ns); },
                        [this](std::int64_t now_ns) { return projector_.knownUntil(now_ns); });
}

double RigCables::inputVolts(int channel, std::int64_t time_ns) {
    if (channel == kEchoInput) return emulators::EmulatedDaq::volts(converter_.outputsAt(time_ns).codes[0]);
    if (channel != kTriggerInput) return 0.0;
    hearTriggers(time_ns);
    for (; !onTheWire_.empty() && onTheWire_.front().time_ns <= time_ns; onTheWire_.pop_front())
        triggerHigh_ = onTheWire_.front().high;
    return triggerHigh_ ? kLogic_V : 0.0;
}

void RigCables::hearTriggers(std::int64_t now_ns) {
    for (const emulators::TriggerEdge& edge : projector_.takeTriggers(now_ns)) {
        if (edge.high) sweeps_.trigger(edge.time_ns);
        onTheWire_.push_back(edge);
    }
}

void RigCables::plugVideo(double refresh_Hz) {
    bus_->locked([&](std::int64_t now_ns) {
        projector_.plugVideo({emulators::kMirrorColumns, emulators::kMirrorRows, refresh_Hz}, now_ns);
    });
}

void RigCables::unplugVideo() {
    bus_->locked([&](std::int64_t now_ns) {
        projector_.unplugVideo(now_ns);
        sweeps_.forget();
    });
}

void RigCables::sync(emulators::FramePtr frame, std::int64_t due_ns) {
    bus_->locked([&](std::int64_t now_ns) {
        projector_.verticalSync(std::move(frame), due_ns);
        hearTriggers(due_ns);
        for (; !onTheWire_.empty() && onTheWire_.front().time_ns < due_ns - kWireRemembers_ns; onTheWire_.pop_front())
            triggerHigh_ = onTheWire_.front().high;
        takeLight(due_ns);
        if (!projector_.draws(due_ns)) sweeps_.sync(due_ns);
        moveLenses(now_ns);
    });
}

void RigCables::withoutVideo() {
    bus_->locked([&](std::int64_t now_ns) {
        takeLight(now_ns);
        moveLenses(now_ns);
    });
}

/// A picture of the board's own is a sweep of its own.
void RigCables::takeLight(std::int64_t now_ns) {
    for (auto& slot : projector_.takeLight(now_ns)) {
        if (slot.drawn) sweeps_.sync(slot.end_ns);
        sweeps_.light(std::move(slot));
    }
}

void RigCables::moveLenses(std::int64_t now_ns) {
    for (const emulators::OutputSample& sample : converter_.takeOutput(now_ns))
        for (std::size_t eye = 0; eye < 2; ++eye)
            lenses_[eye].drive(sample.time_ns,
                               Ampere::fromSi(1e-3 * converter_.current_mA(sample, static_cast<int>(eye))));
    for (SampledLens& lens : lenses_)
        lens.advance(now_ns);
}

Result<void> RigCables::befall(const RigMishap& mishap) {
    if (mishap.device != "projector" && mishap.device != "lenses")
        return fail(Fault::outOfRange,
                    "An emulated rig has no \"" + mishap.device + "\": mishaps befall projector, lenses or display.");
    const std::size_t device = mishap.device == "projector" ? 0 : 1;
    const bool pulled = mishap.kind == "unplug" && mishap.after == 0, putIn = mishap.kind == "plug";
    if (device == 0 && mishap.kind == "power-cycle") {
        bus_->locked([&](std::int64_t now_ns) { projector_.powerCycle(now_ns); });
        return {};
    }
    if (!putIn && mishap.kind != "none" && !mishapFromWord(mishap.kind))
        return fail(Fault::outOfRange, "\"" + mishap.kind + "\" is no mishap: plug, none, power-cycle (projector), " +
                                           mishapWords() + ".");
    bus_->locked([&](std::int64_t now_ns) {
        auto& faults = faults_[device];
        if (mishap.kind == "none")
            faults.clear();
        else if (putIn)
            std::erase_if(faults, [](const auto& fault) { return fault.kind == Mishap::unplug; });
        else if (!pulled)
            faults.push_back(faultOf(mishap));
        if (device == 0) return projector_.setFaults(faults);
        converter_.setFaults(faults);
        moveLenses(now_ns);
        double warmer_C = 0.0;
        for (const auto& fault : faults)
            if (fault.kind == Mishap::overTemperature) warmer_C += fault.amount;
        for (SampledLens& lens : lenses_)
            lens.warmer(warmer_C);
    });
    // Never while the bus is locked.
    if (pulled) bus_->unplug(place(device));
    if (!putIn || bus_->plugged(place(device))) return {};
    if (device == 0) return bus_->plug(place(device), projector_);
    return bus_->plug(place(device), converter_);
}

Received RigCables::received(std::vector<emulators::LightSlot>& light) {
    Received made;
    bus_->locked([&](std::int64_t now_ns) {
        moveLenses(now_ns);
        const auto sweep = sweeps_.newest().value_or(ReceivedSweep{now_ns, now_ns, {}});
        light = sweep.light;
        made.trigger_ns = sweep.trigger_ns;
        made.sweep = seconds(sweep.end_ns - sweep.trigger_ns);
        made.raster = {emulators::kMirrorColumns, emulators::kMirrorRows};
        for (const auto& slot : light)
            made.exposures.push_back({seconds(slot.start_ns - sweep.trigger_ns), seconds(slot.end_ns - slot.start_ns),
                                      slot.depth, slot.leds, slot.video});
        made.left = lenses_[0].powers(sweep.trigger_ns, sweep.end_ns, kPowers);
        made.right = lenses_[1].powers(sweep.trigger_ns, sweep.end_ns, kPowers);
        for (std::size_t eye = 0; eye < 2; ++eye) {
            made.temperature_C[eye] = lenses_[eye].temperature_C();
            made.most_mA[eye] = 1e3 * lenses_[eye].most(sweep.trigger_ns, sweep.end_ns).si();
        }
        made.patterns = projector_.patternMode(now_ns);
        made.harmed = projector_.harmed();
        made.ledCurrentWrites = projector_.ledCurrentWrites();
        made.frames = sweeps_.syncs();
        made.triggers = sweeps_.triggers();
    });
    made.transfers = bus_->transfers();
    return made;
}

DeviceState RigCables::state() {
    DeviceState made;
    bus_->locked([&](std::int64_t now_ns) {
        moveLenses(now_ns);
        made.now_ns = now_ns;
        made.light = projector_.running() ? LightMode::slotted : LightMode::steady;
        const auto sweep = sweeps_.newest();
        if (sweep && sweep->end_ns > sweep->trigger_ns)
            made.slotRate = static_cast<double>(sweep->light.size()) / seconds(sweep->end_ns - sweep->trigger_ns);
        made.powerNow = lenses_[0].power();
        const auto lately = lenses_[0].powers(now_ns - 40'000'000, now_ns, kPowers);
        const auto [low, high] = std::ranges::minmax(lately);
        const Ampere current = lenses_[0].most(now_ns, now_ns + 1);
        made.lens = high - low > kStill ? LensMode::sweeping : current == Ampere{} ? LensMode::rest : LensMode::holding;
        made.lensName = "emulated lens, preset " + std::string(word(preset_));
        made.lensTemperature_C = lenses_[0].temperature_C();
    });
    made.calls = bus_->transfers();
    return made;
}

}  // namespace ilf::devices
