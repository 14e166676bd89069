// White below the output window, by another process: what the projector shows when the player is gone.
#pragma once

#include <functional>
#include <string>

#include "devices/video/found_display.h"

namespace ilf::devices {

/// A plain white full-screen window on the display of `wish`, below the output window of `displayOutput` (in whichever
/// order the two come) and above everything else: when the process that plays is killed, the X server takes its window
/// away and the projector shows white, not the desktop. For a process of its own, since it must outlive that one. The
/// window needs no OpenGL; the server paints it, so it is white even while this process is stopped.
///
/// Blocks until `stopDescriptor` becomes readable or its other end closes, then takes the window away and returns.
/// Sleeps in between. A display that is unplugged, or a server that is gone, is looked for again; `said` hears one
/// sentence when the display is found, and one each time the reason why there is none changes. Displays are never
/// switched to another mode from here: the guard waits until the output has done so.
///
/// Returns an error only for a `wish` that can never be met (no raster).
Result<void> keepWhite(const DisplayWish& wish, int stopDescriptor,
                       const std::function<void(const std::string&)>& said);

}  // namespace ilf::devices
