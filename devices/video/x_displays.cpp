#include "devices/video/x_displays.h"

#include <X11/Xatom.h>
#include <X11/Xlib.h>
#include <X11/extensions/Xrandr.h>
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <span>
#include <string>

#include "devices/video/edid.h"

namespace ilf::devices {
namespace {

template <auto Free>
struct FreeWith {
    void operator()(auto* thing) const { Free(thing); }
};
using Resources = std::unique_ptr<XRRScreenResources, FreeWith<XRRFreeScreenResources>>;
using OutputInfo = std::unique_ptr<XRROutputInfo, FreeWith<XRRFreeOutputInfo>>;
using CrtcInfo = std::unique_ptr<XRRCrtcInfo, FreeWith<XRRFreeCrtcInfo>>;
using Panning = std::unique_ptr<XRRPanning, FreeWith<XRRFreePanning>>;
using Transform = std::unique_ptr<XRRCrtcTransformAttributes, FreeWith<XFree>>;

Resources resourcesOf(XConnection& x) { return Resources(XRRGetScreenResourcesCurrent(x.get(), x.root())); }

const XRRModeInfo* modeOf(const XRRScreenResources& resources, RRMode id) {
    const std::span modes(resources.modes, static_cast<std::size_t>(resources.nmode));
    const auto found = std::find_if(modes.begin(), modes.end(), [&](const XRRModeInfo& mode) { return mode.id == id; });
    return found == modes.end() ? nullptr : &*found;
}

Size sizeOf(const XRRModeInfo& mode) { return {static_cast<int>(mode.width), static_cast<int>(mode.height)}; }

double refreshOf(const XRRModeInfo& mode) {
    double lines = mode.vTotal;
    if ((mode.modeFlags & RR_DoubleScan) != 0) lines *= 2;
    if ((mode.modeFlags & RR_Interlace) != 0) lines /= 2;
    if (mode.hTotal == 0 || lines <= 0) return 0;
    return static_cast<double>(mode.dotClock) / (mode.hTotal * lines);
}

DisplayIdentity identityOf(XConnection& x, RROutput output, const XRROutputInfo& info) {
    Atom type = 0;
    int format = 0;
    unsigned long items = 0, left = 0;
    unsigned char* bytes = nullptr;
    DisplayIdentity identity;
    const Atom edid = XInternAtom(x.get(), RR_PROPERTY_RANDR_EDID, False);
    if (XRRGetOutputProperty(x.get(), output, edid, 0, 128, False, False, XA_INTEGER, &type, &format, &items, &left,
                             &bytes) == Success &&
        bytes != nullptr && type == XA_INTEGER && format == 8)
        identity = identityFromEdid({bytes, items});
    if (bytes != nullptr) XFree(bytes);
    identity.connector.assign(info.name, static_cast<std::size_t>(info.nameLen));
    return identity;
}

bool unscaled(XConnection& x, RRCrtc crtc) {
    XRRCrtcTransformAttributes* told = nullptr;
    if (XRRGetCrtcTransform(x.get(), crtc, &told) == 0 || told == nullptr) return true;
    const Transform transform(told);
    const auto& matrix = transform->currentTransform.matrix;
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column)
            if (matrix[row][column] != (row == column ? XDoubleToFixed(1.0) : 0)) return false;
    return true;
}

/// Panning only where the server knows of it; a display without has no area.
bool pans(XConnection& x, XRRScreenResources* resources, RRCrtc crtc, Size mode) {
    const Panning panning(XRRGetPanning(x.get(), resources, crtc));
    return panning &&
           (panning->width > static_cast<unsigned>(mode.width) || panning->height > static_cast<unsigned>(mode.height));
}

void addCrtc(XConnection& x, XRRScreenResources* resources, XDisplay& display) {
    const CrtcInfo crtc(XRRGetCrtcInfo(x.get(), resources, display.crtc));
    const XRRModeInfo* mode = crtc ? modeOf(*resources, crtc->mode) : nullptr;
    if (mode == nullptr) {
        display.crtc = 0;
        return;
    }
    FoundDisplay& found = display.found;
    found.mode = sizeOf(*mode);
    found.refresh = Hertz::fromSi(refreshOf(*mode));
    found.left = crtc->x;
    found.top = crtc->y;
    found.plain = crtc->rotation == RR_Rotate_0 && crtc->width == mode->width && crtc->height == mode->height &&
                  unscaled(x, display.crtc) && !pans(x, resources, display.crtc, found.mode);
}

/// The crtc it has, or else one that is free and can drive it; 0: none.
RRCrtc crtcFor(XConnection& x, XRRScreenResources* resources, const XDisplay& display, const XRROutputInfo& info) {
    if (display.crtc != 0) return display.crtc;
    for (const RRCrtc crtc : std::span(info.crtcs, static_cast<std::size_t>(info.ncrtc))) {
        const CrtcInfo state(XRRGetCrtcInfo(x.get(), resources, crtc));
        if (state && state->mode == 0) return crtc;
    }
    return 0;
}

const XRRModeInfo* bestMode(const XRRScreenResources& resources, const XRROutputInfo& info, Size raster) {
    const XRRModeInfo* best = nullptr;
    double bestOff = std::numeric_limits<double>::infinity();
    for (const RRMode id : std::span(info.modes, static_cast<std::size_t>(info.nmode))) {
        const XRRModeInfo* mode = modeOf(resources, id);
        if (mode == nullptr || sizeOf(*mode) != raster || (mode->modeFlags & RR_Interlace) != 0) continue;
        const double off = std::abs(refreshOf(*mode) - 60.0);
        if (off >= bestOff) continue;
        best = mode;
        bestOff = off;
    }
    return best;
}

struct Place {
    int left = 0, top = 0;
};

Place placeFor(const std::vector<XDisplay>& displays, const XDisplay& display, Size raster) {
    bool covers = display.crtc == 0;
    int right = 0;
    for (const XDisplay& other : displays) {
        if (other.output == display.output || other.crtc == 0) continue;
        const FoundDisplay& o = other.found;
        right = std::max(right, o.left + o.mode.width);
        covers |= display.found.left < o.left + o.mode.width && o.left < display.found.left + raster.width &&
                  display.found.top < o.top + o.mode.height && o.top < display.found.top + raster.height;
    }
    return covers ? Place{right, 0} : Place{display.found.left, display.found.top};
}

/// The desktop must be large enough before a display can lie there; its size in millimetres keeps the dots per inch.
void growDesktop(XConnection& x, int width, int height) {
    const int screen = DefaultScreen(x.get());
    Window root = 0;
    int left = 0, top = 0;
    unsigned nowWidth = 0, nowHeight = 0, border = 0, depth = 0;
    if (XGetGeometry(x.get(), x.root(), &root, &left, &top, &nowWidth, &nowHeight, &border, &depth) == 0) return;
    const int newWidth = std::max(width, static_cast<int>(nowWidth));
    const int newHeight = std::max(height, static_cast<int>(nowHeight));
    if (newWidth == static_cast<int>(nowWidth) && newHeight == static_cast<int>(nowHeight)) return;
    const double mmPerPixel =
        std::max(1, DisplayHeightMM(x.get(), screen)) / std::max(1.0, 1.0 * DisplayHeight(x.get(), screen));
    XRRSetScreenSize(x.get(), x.root(), newWidth, newHeight, std::max(1, static_cast<int>(newWidth * mmPerPixel)),
                     std::max(1, static_cast<int>(newHeight * mmPerPixel)));
}

void noTransform(XConnection& x, RRCrtc crtc) {
    XTransform identity{};
    for (int i = 0; i < 3; ++i)
        identity.matrix[i][i] = XDoubleToFixed(1.0);
    std::string filter = "nearest";
    XRRSetCrtcTransform(x.get(), crtc, &identity, filter.data(), nullptr, 0);
}

}  // namespace

Result<std::vector<XDisplay>> xDisplays(XConnection& x) {
    int event = 0, error = 0, major = 0, minor = 0;
    if (!XRRQueryExtension(x.get(), &event, &error) || XRRQueryVersion(x.get(), &major, &minor) == 0 ||
        (major == 1 && minor < 3))
        return fail(Fault::unsupported,
                    "This display server cannot tell its displays apart (RandR 1.3 is missing); use "
                    "an ordinary X server.");
    const Resources resources = resourcesOf(x);
    if (!resources) return fail(Fault::device, "The display server does not say which displays it has.");
    const RROutput primary = XRRGetOutputPrimary(x.get(), x.root());
    std::vector<XDisplay> displays;
    for (const RROutput output : std::span(resources->outputs, static_cast<std::size_t>(resources->noutput))) {
        const OutputInfo info(XRRGetOutputInfo(x.get(), resources.get(), output));
        if (!info || info->connection == RR_Disconnected) continue;
        XDisplay display;
        display.output = output;
        display.crtc = info->crtc;
        display.found.identity = identityOf(x, output, *info);
        display.found.primary = output == primary;
        for (const RRMode id : std::span(info->modes, static_cast<std::size_t>(info->nmode)))
            if (const XRRModeInfo* mode = modeOf(*resources, id); mode != nullptr)
                display.found.offers.push_back(sizeOf(*mode));
        if (display.crtc != 0) addCrtc(x, resources.get(), display);
        displays.push_back(std::move(display));
    }
    (void)x.accepted();  // what vanished in between is simply not there
    if (x.lost()) return fail(Fault::device, "The display server is gone.");
    return displays;
}

std::vector<FoundDisplay> foundOf(const std::vector<XDisplay>& displays) {
    std::vector<FoundDisplay> found;
    found.reserve(displays.size());
    for (const XDisplay& display : displays)
        found.push_back(display.found);
    return found;
}

void watchDisplays(XConnection& x) {
    XRRSelectInput(x.get(), x.root(), RRScreenChangeNotifyMask | RRCrtcChangeNotifyMask | RROutputChangeNotifyMask);
}

Result<void> setRaster(XConnection& x, const std::vector<XDisplay>& displays, const XDisplay& display, Size raster) {
    const std::string name = displayName(display.found.identity);
    const auto refused = [&](const char* why) {
        return fail(Fault::device, "The projector's display " + name + " could not be set to " +
                                       std::to_string(raster.width) + "x" + std::to_string(raster.height) + ": " + why +
                                       ". Set it by hand, in the display settings or with xrandr.");
    };
    const Resources resources = resourcesOf(x);
    if (!resources) return refused("the display server does not answer");
    const OutputInfo info(XRRGetOutputInfo(x.get(), resources.get(), display.output));
    if (!info) return refused("it is gone");
    const XRRModeInfo* mode = bestMode(*resources, *info, raster);
    if (mode == nullptr) return refused("it does not have that mode");
    const RRCrtc crtc = crtcFor(x, resources.get(), display, *info);
    if (crtc == 0) return refused("the graphics card drives as many displays as it can");

    // In one go for whoever watches displays come and go.
    const Place place = placeFor(displays, display, raster);
    (void)x.accepted();
    XGrabServer(x.get());
    growDesktop(x, place.left + raster.width, place.top + raster.height);
    if (!unscaled(x, crtc)) noTransform(x, crtc);
    (void)x.accepted();  // whether it became unscaled is seen when it is asked for again
    RROutput output = display.output;
    const int status = XRRSetCrtcConfig(x.get(), resources.get(), crtc, CurrentTime, place.left, place.top, mode->id,
                                        RR_Rotate_0, &output, 1);
    XUngrabServer(x.get());
    if (!x.accepted() || status != RRSetConfigSuccess) return refused("the display server refused");
    return {};
}

}  // namespace ilf::devices
