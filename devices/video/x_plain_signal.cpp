// What drivers may do to pixel values between the window and the cable, switched off.
#include <X11/Xatom.h>
#include <X11/Xlib.h>
#include <X11/extensions/Xrandr.h>
#include <algorithm>
#include <cstdlib>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "devices/video/x_displays.h"

namespace ilf::devices {
namespace {

struct Wanted {
    const char* property;
    const char* value;
};

// As Linux's drivers call them: i915; radeon, amdgpu and nouveau; radeon; nouveau; all but i915's external displays.
constexpr Wanted kPlain[] = {{"Broadcast RGB", "Full"},
                             {"underscan", "off"},
                             {"dither", "off"},
                             {"dithering mode", "off"},
                             {"scaling mode", "None"}};

// Of 65535: hardware keeps fewer bits, and reads back what it kept.
constexpr int kAlike = 127;

/// Only to a value the driver offers, and only where it has another.
void set(XConnection& x, RROutput output, Atom property, Atom value) {
    XRRPropertyInfo* offered = XRRQueryOutputProperty(x.get(), output, property);
    if (offered == nullptr) return;
    const std::span values(offered->values, static_cast<std::size_t>(std::max(0, offered->num_values)));
    const bool settable = !offered->immutable && !offered->range &&
                          std::find(values.begin(), values.end(), static_cast<long>(value)) != values.end();
    XFree(offered);
    if (!settable) return;
    Atom type = 0;
    int format = 0;
    unsigned long items = 0, left = 0;
    unsigned char* bytes = nullptr;
    XRRGetOutputProperty(x.get(), output, property, 0, 1, False, False, XA_ATOM, &type, &format, &items, &left, &bytes);
    // Format 32 comes and goes as longs.
    const bool already =
        bytes != nullptr && format == 32 && items == 1 && *reinterpret_cast<const Atom*>(bytes) == value;
    if (bytes != nullptr) XFree(bytes);
    if (already) return;
    XRRChangeOutputProperty(x.get(), output, property, XA_ATOM, 32, PropModeReplace,
                            reinterpret_cast<const unsigned char*>(&value), 1);
}

/// Told only where it is bent: drivers may wait for a frame to change it.
void straightenGamma(XConnection& x, RRCrtc crtc) {
    const std::unique_ptr<XRRCrtcGamma, decltype(&XRRFreeGamma)> ramp(XRRGetCrtcGamma(x.get(), crtc), &XRRFreeGamma);
    if (!ramp || ramp->size < 2) return;
    bool bent = false;
    for (int i = 0; i < ramp->size; ++i) {
        const auto straight = static_cast<unsigned short>(65535L * i / (ramp->size - 1));
        for (unsigned short* value : {&ramp->red[i], &ramp->green[i], &ramp->blue[i]}) {
            bent |= std::abs(*value - straight) > kAlike;
            *value = straight;
        }
    }
    if (bent) XRRSetCrtcGamma(x.get(), crtc, ramp.get());
}

}  // namespace

void sendPlainly(XConnection& x, const XDisplay& display) {
    straightenGamma(x, display.crtc);
    int count = 0;
    Atom* has = XRRListOutputProperties(x.get(), display.output, &count);
    const std::vector<Atom> properties(has, has + count);
    if (has != nullptr) XFree(has);
    for (const Wanted& wanted : kPlain) {
        const Atom property = XInternAtom(x.get(), wanted.property, True);
        const Atom value = XInternAtom(x.get(), wanted.value, True);
        if (property != 0 && value != 0 &&
            std::find(properties.begin(), properties.end(), property) != properties.end())
            set(x, display.output, property, value);
    }
    (void)x.accepted();  // a driver that refuses sends what it sends; nothing more can be done about it from here
}

}  // namespace ilf::devices
