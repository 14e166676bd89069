// A program's slots as pictures of the plugin boundary: so many bits, in the values' upper bits.
#pragma once

#include <vector>

#include "core/compile/program.h"

namespace ilf::devices {

/// One picture a slot, in the order of light; slots of one image share their pixels, dark slots are 0. At 8 bits values
/// are the image's own, else ordered dither (dlpc350/frame_quantised.h), as the plan states it. 1 <= bits <= 8.
/// Precondition: `checked(program)`.
std::vector<Image<std::uint8_t>> slotPictures(const Program& program, int bits);

/// Full light in every slot.
std::vector<Image<std::uint8_t>> whiteSlots(Size raster, int slots, int bits);

}  // namespace ilf::devices
