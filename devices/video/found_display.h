// A display that a display server knows of, and which of them is the projector's.
#pragma once

#include <string>
#include <vector>

#include "core/base/geometry.h"
#include "core/base/quantity.h"
#include "core/base/result.h"
#include "core/document/rig_devices.h"

namespace ilf::devices {

using ilf::DisplayIdentity;
using ilf::Size;

/// The display wanted: by its identity, or, with all of that empty, the only one of the projector's raster.
struct DisplayWish {
    DisplayIdentity display;
    Size raster;  ///< pixels, sent one to one
};

/// A connected display. Maker, model and serial are its EDID's; servers without any (Xvfb) tell the connector only.
struct FoundDisplay {
    DisplayIdentity identity;
    Size mode;                 ///< what it is sent now; 0x0: switched off
    Hertz refresh;             ///< of that mode by its timing, not measured; 0: the server does not say
    int left = 0, top = 0;     ///< where it lies on the desktop
    bool primary = false;      ///< where desktops put their panels: the operator's
    bool plain = true;         ///< neither scaled, nor rotated, nor panning
    std::vector<Size> offers;  ///< modes it could be set to
    bool operator==(const FoundDisplay&) const = default;
};

/// What has to be done with a display before it can be used.
struct ChosenDisplay {
    std::size_t index = 0;  ///< into the displays chosen from
    bool setMode = false;   ///< it offers the raster, and does not have it now, or not one to one
};

/// Which of `displays` is meant; refused in words rather than guessed.
///
/// Maker, model and serial are compared where the wish has them, and the display may hang on any connector; of several
/// alike the wished connector decides. A wish of nothing but a connector means that connector. An empty wish means the
/// only display that has exactly the raster, or else the only one that offers it.
///
/// Never the operator's screen. The operator's is the primary one wherever another is switched on, and so is the only
/// one that is switched on, with one exception: a display server whose only display has exactly the raster already is
/// the projector's own (an emulated rig's, or a machine with nothing else attached). A display that covers the same
/// part of the desktop as another (mirrored) shows the operator's screen, and is refused too. An unnamed display is
/// switched to the raster only where the primary display is known to be another.
///
/// A display that is switched off is left so, since somebody may have meant it, unless `switchOn`: it was unplugged
/// and is back.
Result<ChosenDisplay> chosenDisplay(const std::vector<FoundDisplay>& displays, const DisplayWish& wish,
                                    bool switchOn = false);

/// "HDMI-2 (TXN DLPC350)": as operators know it.
std::string displayName(const DisplayIdentity& identity);

/// "912x1140": a display's mode.
std::string sizeText(Size size);

}  // namespace ilf::devices
