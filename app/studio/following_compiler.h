// Compiles documents whose regions move: each slot's light is of the scene at its own time.
#pragma once

#include <memory>
#include <span>

#include "core/compile/compile.h"
#include "core/track/region_move.h"

namespace ilf::app {

/// Not a value: keeps its last compile, so that only what moved is compiled anew.
class FollowingCompiler {
public:
    /// The document with what follows where it is at the mean time of the sweep's light: what a plan is made for.
    Document placed(const Document& document, std::span<const RegionMove> moves, Second light);

    /// `document`: as `placed` gave it of `painted`. While nothing moves this is `compile`. Else each image that slots
    /// show is compiled of the scene at the mean time of its slots' light (scheduling.md 5: per-slot masks, which take
    /// the seam of a region that moves at 100 mm/s from 8 % to 0.1), all within one sweep; the result's `document`,
    /// `parts` and views are those of the mean time. The same object as before where nothing changed.
    Result<std::shared_ptr<const Compiled>> compiled(const Document& painted, const Document& document,
                                                     const Plan& plan, std::span<const RegionMove> moves);

private:
    Result<std::shared_ptr<const Compiled>> one(const Document& document, const Plan& plan);

    std::shared_ptr<const Compiled> last_;   ///< of one time, never put together
    std::shared_ptr<const Compiled> shown_;  ///< the last answer
    std::shared_ptr<const Compiled> base_;   ///< what it is of at the mean time
    std::vector<RegionMove> moves_;          ///< and these
    Document placed_;                        ///< the last answer of `placed`, whose tiles the next one shares
};

/// Mean time of the light of each of a program's images in the plan's slots, from the sweep's start; nothing for images
/// that no slot shows.
std::vector<std::optional<Second>> lightOfImages(const Plan& plan, const Program& program);

}  // namespace ilf::app
