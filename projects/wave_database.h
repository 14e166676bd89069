// Recorded lens waves in one file: what a lens was driven with, what its power then did, and under what conditions.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/lens/record.h"
#include "core/lens/shaped_wave.h"

namespace ilf::projects {

/// Which lens was recorded.
struct RecordedLens {
    bool emulated = true;      ///< no glass: the records come from the lens emulator
    std::string model;         ///< of an emulator: its preset
    std::string serial;        ///< of an emulator: the seed of its variation, or nothing
    std::string eye = "mono";  ///< L, R or mono
    std::string notes;
    bool operator==(const RecordedLens&) const = default;
    /// "simulated lens, preset datasheet", or model and serial.
    std::string name() const;
};

/// How long after its trigger a projector's light comes.
struct ProjectorDelay {
    std::string projector;  ///< its model
    std::string mode;
    double delay_s = 0.0, deviation_s = 0.0;
    int measurements = 1;
    bool operator==(const ProjectorDelay&) const = default;
};

/// A value: the whole content of a database of one lens. `records` and `shaped` ascend by id after opening.
struct WaveFile {
    RecordedLens lens;
    std::string recordedUtc;          ///< when, ISO 8601
    std::string method = "emulator";  ///< emulator, photodiode, wavefront or csv
    std::string software;             ///< what wrote it
    std::vector<LensRecord> records;
    std::vector<ShapedWave> shaped;
    std::vector<ProjectorDelay> delays;
};

/// SQLite, application id "ILFW", version 1 (tables device, session, wave, model, projector_delay; SI units). Powers
/// are 16-bit: P = offset + scale q, so a sample comes back within (max - min)/131068. Each wave carries the SHA-256 of
/// its row together with its session's and its lens's; a shaped wave's row in `model` ends with one of its own. Ids
/// that are 0 are given the next free numbers. The file is written beside the old one and put in its place in one step,
/// and leaves no journal behind. Refused: nothing to save, a value that is not finite, two records of the same drive,
/// rate and temperature.
Result<void> saveWaves(const std::filesystem::path& path, const WaveFile& waves);

/// Refused with one sentence, the file untouched: not a database, another program's, a newer version, cut short,
/// damaged (SQLite's own check, each wave's checksum and length), no waves, more than one lens, a scale or power that
/// is not finite, extremes that are not those of the samples, drive units other than V and A or both in one file, a
/// shaped wave whose record is missing.
Result<WaveFile> openWaves(const std::filesystem::path& path);

/// The record with this id, sine or shaped; refused when there is none.
Result<LensRecord> waveOf(const WaveFile& waves, std::int64_t id);

}  // namespace ilf::projects
