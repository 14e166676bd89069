#include "core/track/region_move.h"

#include <algorithm>

namespace ilf {

RegionMotion motionAt(const RegionMove& move, Second intoSweep) {
    Quad to = move.now;
    for (std::size_t k = 0; k < to.size(); ++k) {
        to[k].x += intoSweep.si() * move.speed[k].x;
        to[k].y += intoSweep.si() * move.speed[k].y;
    }
    return {move.region, motionBetween(move.from, to).value_or(Motion{}), move.fade};
}

std::vector<RegionMotion> motionsAt(std::span<const RegionMove> moves, Second intoSweep) {
    std::vector<RegionMotion> motions;
    motions.reserve(moves.size());
    for (const RegionMove& move : moves)
        motions.push_back(motionAt(move, intoSweep));
    return motions;
}

bool anyMoves(std::span<const RegionMove> moves) {
    return std::ranges::any_of(moves, [](const RegionMove& move) { return move.speed != Quad{}; });
}

}  // namespace ilf
