// The slots of one sweep as the bit planes of one video frame.
#pragma once

#include <cstdint>
#include <vector>

#include "core/compile/program.h"
#include "devices/dlpc350/frame_quantised.h"
#include "devices/dlpc350/sequence.h"

namespace ilf::devices::dlpc350 {

/// The mirrors; video of this size and no other is shown pixel by pixel.
inline constexpr Size kRaster{912, 1140};

/// A picture for the projector's video input: red, green, blue, 8 bits each, row by row without padding.
struct VideoPicture {
    Size size = kRaster;
    std::vector<std::uint8_t> rgb;
    bool operator==(const VideoPicture&) const = default;
};

/// A program as one frame, and the pattern table that shows it.
struct PackedFrame {
    VideoPicture picture;
    PatternSequence sequence;
    int depth = 8;  ///< bits of each slot's picture
    bool operator==(const PackedFrame&) const = default;
};

/// Slot i is the table's entry i and the frame's picture i of `depth` bits, its light quantised (frame_quantised.h).
/// All slots are 1 / slotRate long. Dark slots are pictures of zeros, not the black pattern, and equal images take
/// planes of their own: so the table depends on rate and depth alone and a new program is a new frame, while changing
/// the table means stopping the patterns. That costs no slot, as a table never has more than the frame has pictures.
/// Refuses (words for the operator) what `checked(program)` refuses, another raster than kRaster, depths other than
/// 1 ... 8, more slots than a frame has pictures of that depth, and slots too short for it.
Result<PackedFrame> packed(const Program& program, int depth);

/// The same as packed(after, former.depth), but only tiles of slots that changed are packed anew. `former` must be what
/// `before` was packed into.
Result<PackedFrame> repacked(PackedFrame former, const Program& before, const Program& after);

/// What the slots of a sweep should show at `depth` bits, for comparison with light received: one image a slot.
std::vector<LightImage> intendedLight(const Program& program, int depth);

}  // namespace ilf::devices::dlpc350
