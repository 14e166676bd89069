// Recording the lens emulator as one would record a lens: which drives, played how, on which emulator.
#pragma once

#include <cstdint>
#include <vector>

#include "devices/simulated/lens_emulator.h"

namespace ilf::app {

/// Every drive is played on a lens that rested before, so that records do not depend on each other's order.
struct LensBench {
    devices::LensPreset preset = devices::LensPreset::datasheet;
    std::uint64_t seed = 0;       ///< of the preset's variation; 0: the preset itself
    double temperature_C = 30.0;  ///< of the room and the resting lens
    devices::RecordOptions options;

    devices::LensEmulator lens() const;
};

/// Plays `drives` at `rate`, on two cores; ids count from 1.
Result<std::vector<LensRecord>> recordedAll(const LensBench& bench, const std::vector<Harmonics>& drives, Hertz rate);

/// Three drives to learn how far the lens moves at this rate, then about `waves` (at least 9) that cover sweeps between
/// -2.5 and 7 D as a model needs it, steady ones included; fewer dioptres where the lens's drive ends before.
/// `rest` moves all of it: where the wearer's prescription holds the lens.
Result<std::vector<LensRecord>> surveyed(const LensBench& bench, Hertz rate, std::size_t waves, Dioptre rest = {});

/// The paper's: a sine between any two of 71 voltages from -70 to 70 mV, 2485 of them (section 3.4). Where the lens
/// resonates many leave its +-10 D; they are recorded as they are, and selection leaves them out.
Result<std::vector<LensRecord>> paperWaves(const LensBench& bench, Hertz rate);

}  // namespace ilf::app
