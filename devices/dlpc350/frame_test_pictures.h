// Pictures for first light and for steady light, which no program makes.
#pragma once

#include "devices/dlpc350/frame.h"

namespace ilf::devices::dlpc350 {

/// Every bit of every plane is 1: uniform white, whichever pattern table runs, and as plain video.
VideoPicture whitePicture();

/// Where plane `plane` (0 ... 23, numbered as planesOf does) lights its number: cells from left to right, then down,
/// six columns and four rows.
PixelRect<ProjectorFrame> identificationCell(int plane);

/// A frame in which each plane lights a cell of its own, with a rim and its number, and nothing else. The table shows
/// all 24 planes in order, evenly over a frame of 60 Hz, so that all numbers are seen at once; `onlyPlane` shows one,
/// which tells whether the board's planes are where planesOf has them: number n alone must be lit.
PackedFrame identificationFrame();
/// One entry: plane `plane` alone for as long as `exposure`, once a frame.
PatternSequence onlyPlane(int plane, Second exposure = 16000.0_us);

}  // namespace ilf::devices::dlpc350
