// The full-screen window on the projector's display, and which displays there are.
#pragma once

#include <memory>
#include <vector>

#include "devices/clock.h"
#include "devices/rig/video_output.h"
#include "devices/video/found_display.h"

namespace ilf::devices {

/// Frames on exactly the display of `wish` (`chosenDisplay` says which that is, and when none is taken), on the X
/// server that DISPLAY names, in exactly its raster: the display is set to it where it has another mode, its gamma ramp
/// to a straight line, and its driver to full-range RGB without dithering, underscan or scaling where it offers that.
/// Each frame is drawn whole, unscaled, without gamma or dither, and swapped in at a vertical sync; the first is read
/// back and compared, and refused where the driver changed a value.
///
/// Nothing is opened before the first call, which takes some tenths of a second and shows white for a few frames, as
/// does the first one after a loss; call from one thread, whichever. The output is bound to the display it first found:
/// once that is unplugged, switched off, switched to another mode, or its server is gone, each call is an error
/// (`device`), tried anew at most twice a second, until it is back, on whatever connector. Two displays whose EDIDs are
/// alike to the serial number cannot be told apart but by connector.
///
/// `mode().refresh` is measured from the swaps. Where the server does not wait for the vertical sync (Xvfb, software
/// OpenGL) it stays 0; then `show` returns once the server has the whole picture, and `ScannedOut::at` is that time
/// and says nothing about scan-out.
///
/// While the window is there its display neither sleeps nor blanks. The pointer is invisible over it, it takes no
/// keyboard focus, no window manager has a say in it, and it comes back on top when something covers it.
///
/// `clock` must run with the machine's monotonic clock for `ScannedOut::at` to be the server's time of scan-out.
Result<std::shared_ptr<VideoOutput>> displayOutput(const DisplayWish& wish, Clock clock = Clock::steady());

/// The displays connected to the X server that DISPLAY names; an error (`notFound`) where there is no such server.
Result<std::vector<FoundDisplay>> displays();

}  // namespace ilf::devices
