// Pictures of a project for files and screens: overlay, slot light, grey and colour images.
#pragma once

#include "core/base/image.h"
#include "core/compile/compile.h"

namespace ilf::app {

/// The scene in 8-bit sRGB, 3 channels.
Image<std::uint8_t> scenePicture(const Document& document);
/// The scene with the regions' overlay (edge line and hatch by look) on top, 3 channels.
Image<std::uint8_t> overlayPicture(const Document& document);
/// The light of slot `slot` on the projector's raster, 1 channel; black for a dark slot.
Image<std::uint8_t> slotPicture(const Program& program, int slot);

}  // namespace ilf::app
