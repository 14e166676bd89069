// Lens waves as CSV files in a folder, one a wave, for other programs to write and read.
#pragma once

#include <filesystem>

#include "core/base/result.h"
#include "projects/wave_database.h"

namespace ilf::projects {

/// The files that `manifest.csv` names in its column `file`, in that order, or every other *.csv by name where there is
/// no manifest. Further columns of the manifest are header keys for the files that lack them.
///
/// A file begins with lines `# key=value`: schema (1), etl_serial, freq_Hz, u_unit (V or A), u_min, u_max, temp_C,
/// periods_avg, provenance; not required are id, family (sine), noise_D (else estimated), etl_kind (emulator or etl),
/// etl_model, eye, utc, method, u_harmonics, p_harmonics, holds, errors_D. Then `t_s,u,P_D` and one period: seconds
/// from the drive's rising middle, drive, power in dioptres. Equally spaced samples are kept; others are interpolated
/// at 250.
///
/// Refused with file and line: what is no number, time that does not increase, a period more than 0.1 % off freq_Hz, a
/// jump from end to start above 3 sigma, a key that is missing or unknown in its unit, fewer than 64 samples, a drive
/// that is not the sine its header tells of, a second lens.
Result<WaveFile> importWaves(const std::filesystem::path& folder);

/// Writes what `importWaves` reads: a new folder, put in place whole. Refuses a folder that is there and not empty.
Result<void> exportWaves(const std::filesystem::path& folder, const WaveFile& waves);

}  // namespace ilf::projects
