// The program: what lens and projector play, sweep after sweep, until the next one is swapped in.
#pragma once

#include <cstdint>
#include <vector>

#include "core/base/tile_grid.h"
#include "core/plan/plan.h"

namespace ilf {

/// Light of one slot: 8 bits, linear in emitted light, projector frame.
using LightImage = TileGrid;

struct Program {
    Waveform waveform;
    Hertz slotRate = 960.0_Hz;
    Second projectorDelay;  ///< the core triggers each slot this much before its light is due
    Size projector;
    /// Each the projector's size. First the plan's levels, each alone at full light; then what slots show besides.
    std::vector<LightImage> images;
    std::vector<int> imageOfSlot;  ///< one entry per slot of the sweep: index into images, or kDark
    bool operator==(const Program&) const = default;

    static constexpr int kDark = -1;
};

/// Hash of all that is played; equal programs have equal hashes. Tells a swapped program by content.
std::uint64_t contentHash(const Program& program);

/// Says what is wrong with a program before it may reach light (sizes, indices, finite powers, slot rate an integer
/// multiple of the sweep rate, a still lens lit in all slots).
Result<void> checked(const Program& program);

}  // namespace ilf
