#include "app/measure/measured_files.h"

#include <filesystem>
#include <utility>

#include "app/words.h"
#include "ilf/version.h"

namespace ilf::app {

projects::WaveFile measuredWaves(const devices::MeasuredRig& measured, const MeasureOrder& order, bool simulated) {
    projects::WaveFile file;
    file.lens.emulated = simulated;
    // Not a preset's name alone: no planner shall take these records for what the lens emulator gives.
    file.lens.model = simulated ? "datasheet, on an emulated bench" : order.model;
    file.lens.serial = order.serial;
    file.lens.eye = order.eye == Eye::left ? "L" : "R";
    file.lens.notes = "static powers, hysteresis " + std::to_string(measured.sweep->hysteresis_D) + " D, drift " +
                      std::to_string(measured.drift_D) + " D";
    file.recordedUtc = utcNow();
    file.method = "photodiode";
    file.software = std::string("illuminatedfocus ") + kVersion;
    file.records = measured.waves;
    if (measured.delay) {
        const auto& delay = *measured.delay;
        file.delays.push_back({order.rig.name, std::to_string(order.rig.bits) + " bits", delay.mean.si(),
                               delay.delay.deviation.si(), static_cast<int>(delay.delay_s.size())});
    }
    return file;
}

Rig withMeasured(Rig rig, const devices::MeasuredRig& measured, Eye eye, const std::string& file, bool simulated) {
    auto& devices = rig.devices.emplace(rig.devices.value_or(RigDevices{}));
    (eye == Eye::left ? devices.left : devices.right).powers = measured.sweep->powers;
    if (measured.delay) rig.projectorDelay = measured.delay->mean;
    std::error_code ignored;
    rig.lens = std::filesystem::absolute(file, ignored).string();
    rig.provenance = simulated ? "simulated" : "measured";
    return rig;
}

}  // namespace ilf::app
