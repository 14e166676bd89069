// `lens`: wave databases from the command line: recorded on the lens emulator, imported, looked into and chosen from.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace ilf::app {

struct LensRecordOptions {
    std::string preset = "datasheet";
    double rate_Hz = 60.0;
    std::size_t waves = 40;
    bool paper = false;  ///< the paper's 2485 instead
    double temperature_C = 30.0;
    std::uint64_t seed = 0;
    std::string out;
};
/// Records the lens emulator. Never replaces a database of a real lens.
int lensRecordCommand(const LensRecordOptions& options);

/// What is in a database: rates, families, powers, drives, temperature, where from, and how well a model fits.
int lensInfoCommand(const std::string& file, bool json);

int lensImportCommand(const std::string& folder, const std::string& out);
int lensExportCommand(const std::string& file, const std::string& folder);

struct LensChooseOptions {
    std::string file;
    double low_D = 0.0, high_D = 0.0;
    std::string mode = "continuous";  ///< paper, slot-aware, continuous or shaped
    double rate_Hz = 60.0;
    bool json = false;
};
/// Exit code 4 with the largest reachable power when no wave serves.
int lensChooseCommand(const LensChooseOptions& options);

struct LensShapeOptions {
    std::string file, preset;  ///< one of the two
    std::vector<double> levels_D;
    double duty = 0.3;
    int harmonics = 5;
    double rate_Hz = 60.0;
    std::string out;  ///< the file's waves and the learnt one; empty: only told
    bool json = false;
};
/// Learns a shaped wave on the lens emulator; a database of a real lens is refused, since none can be driven.
int lensShapeCommand(const LensShapeOptions& options);

}  // namespace ilf::app
