// The displays of an X server: what RandR says of them, and the few things it is told.
#pragma once

#include <vector>

#include "devices/video/found_display.h"
#include "devices/video/x_connection.h"

namespace ilf::devices {

/// A display with the server's numbers for it, which last as long as the connection.
struct XDisplay {
    FoundDisplay found;
    unsigned long output = 0;
    unsigned long crtc = 0;  ///< what scans it out; 0: switched off
};

/// The connected ones, as the server knows them now (nothing is probed, which would make displays flicker).
Result<std::vector<XDisplay>> xDisplays(XConnection& x);

std::vector<FoundDisplay> foundOf(const std::vector<XDisplay>& displays);

/// Asks for an event whenever displays come, go or change.
void watchDisplays(XConnection& x);

/// Sets `display` to `raster`, upright and unscaled, where it lies now; to the right of all others if it was off or
/// would cover one there. Of several such modes the one nearest to 60 Hz, since LightCrafter programs are made for
/// that.
Result<void> setRaster(XConnection& x, const std::vector<XDisplay>& displays, const XDisplay& display, Size raster);

/// Has pixel values sent as they are: a straight gamma ramp (no night light, no colour profile), the full range of RGB,
/// and neither dithering, underscan nor a scaler, as far as the display's driver has such properties.
void sendPlainly(XConnection& x, const XDisplay& display);

}  // namespace ilf::devices
