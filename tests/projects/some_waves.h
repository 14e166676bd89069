// A wave database with one of everything, and the difference between what was saved and what came back.
#pragma once

#include <cmath>
#include <filesystem>
#include <string>

#include "projects/wave_database.h"

namespace ilf {

/// Three sines and a multisine of one simulated lens, a shaped wave and a projector's delay.
inline projects::WaveFile someWaves() {
    projects::WaveFile out;
    out.lens = {true, "datasheet", "seed 3", "L", "bench 2"};
    out.recordedUtc = "2026-11-22T12:00:00Z";
    out.software = "a test";
    for (int i = 0; i < 4; ++i) {
        LensRecord record;
        record.id = i + 1;
        record.rate = i == 2 ? 90.0_Hz : 60.0_Hz;
        record.drive.c = {0.001 * i, {0.0, -0.01 - 0.002 * i}};
        if (i == 2) record.drive.c = {0.02};  // steady
        if (i == 3) {
            record.family = "multisine";
            record.drive.c = {0.5, {0.25, -0.125}, {0.0625, 2.0}};
        }
        Harmonics power{{0.5 + 0.3 * i, {1.0, -0.7}, {0.02, 0.01}}};
        record.power_D = samplesOf(power, 250);
        record.temperature_C = 30.0 + 0.1 * i;
        record.periodsAveraged = 8;
        record.noise_D = i == 1 ? 0.01 : 0.007;
        out.records.push_back(record);
    }
    ShapedWave shaped;
    shaped.id = 9;
    shaped.holds = {{0.0, 0.3, 0.0}, {0.5, 0.3, 2.2}};
    shaped.drive.c = {0.015625, {0.25, 0.125}, {0.0, 0.5}, {0.03125, 0.0}};
    shaped.power.c = {1.1, {-1.3, 0.1}, {0.0, 0.02}, {0.2, 0.1}};
    shaped.largestError_D = 0.04;
    shaped.errors_D = {0.12, 0.05, 0.04};
    shaped.temperature_C = 31.0;
    out.shaped.push_back(shaped);
    out.delays.push_back({"projector", "8 bit", 0.46e-3, 1e-6, 20});
    return out;
}

/// Empty when `back` is `saved` but for what 16 bits a sample and 32 bits a harmonic lose; otherwise what differs.
inline std::string difference(const LensRecord& saved, const LensRecord& back) {
    LensRecord other = back;
    if (saved.power_D.size() != back.power_D.size()) return "samples";
    double low = saved.power_D[0], high = low, worst = 0.0;
    for (std::size_t i = 0; i < saved.power_D.size(); ++i) {
        low = std::min(low, saved.power_D[i]);
        high = std::max(high, saved.power_D[i]);
        worst = std::max(worst, std::abs(saved.power_D[i] - back.power_D[i]));
    }
    if (worst > (high - low) / 65534.0 * 0.5001 + 1e-12 * (std::abs(low) + std::abs(high))) return "powers";
    if (saved.drive.c.size() != back.drive.c.size()) return "drive";
    for (std::size_t k = 0; k < saved.drive.c.size(); ++k) {
        if (std::abs(saved.drive.c[k] - back.drive.c[k]) > 1e-7 * std::abs(saved.drive.c[k]) + 1e-16) return "drive";
    }
    other.power_D = saved.power_D;
    other.drive = saved.drive;
    if (saved.id == 0) other.id = 0;
    return other == saved ? "" : "another field";
}

inline std::string difference(const ShapedWave& saved, const ShapedWave& back) {
    if (saved.id != back.id || saved.rate != back.rate || saved.unit != back.unit) return "id, rate or unit";
    if (saved.errors_D != back.errors_D || saved.largestError_D != back.largestError_D) return "errors";
    if (saved.temperature_C != back.temperature_C || saved.provenance != back.provenance) return "conditions";
    if (saved.holds.size() != back.holds.size()) return "holds";
    for (std::size_t i = 0; i < saved.holds.size(); ++i) {
        const Hold &a = saved.holds[i], &b = back.holds[i];
        if (a.centre != b.centre || a.length != b.length || a.power_D != b.power_D) return "holds";
    }
    const auto far = [](const Harmonics& a, const Harmonics& b) {
        if (a.c.size() != b.c.size()) return true;
        for (std::size_t k = 0; k < a.c.size(); ++k) {
            if (std::abs(a.c[k] - b.c[k]) > 1e-4) return true;
        }
        return false;
    };
    if (far(saved.power, back.power)) return "power";
    return far(saved.drive, back.drive) ? "drive" : "";
}

}  // namespace ilf
