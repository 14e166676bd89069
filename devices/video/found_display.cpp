#include "devices/video/found_display.h"

#include <algorithm>
#include <cassert>

namespace ilf::devices {

std::string sizeText(Size size) { return std::to_string(size.width) + "x" + std::to_string(size.height); }

namespace {

bool isOn(const FoundDisplay& display) { return display.mode.width > 0; }

bool offers(const FoundDisplay& display, Size raster) {
    return std::find(display.offers.begin(), display.offers.end(), raster) != display.offers.end();
}

bool overlap(const FoundDisplay& a, const FoundDisplay& b) {
    return a.left < b.left + b.mode.width && b.left < a.left + a.mode.width && a.top < b.top + b.mode.height &&
           b.top < a.top + a.mode.height;
}

bool same(const std::string& wished, const std::string& found) { return wished.empty() || wished == found; }

bool namesTheDevice(const DisplayIdentity& wish) {
    return !wish.maker.empty() || !wish.model.empty() || !wish.serial.empty();
}

bool fits(const DisplayIdentity& found, const DisplayIdentity& wish) {
    if (!namesTheDevice(wish)) return found.connector == wish.connector;
    return same(wish.maker, found.maker) && same(wish.model, found.model) && same(wish.serial, found.serial);
}

std::string namesOf(const std::vector<FoundDisplay>& displays, const std::vector<std::size_t>& which) {
    std::string names;
    for (const std::size_t i : which)
        names += (names.empty() ? "" : ", ") + displayName(displays[i].identity);
    return names;
}

std::vector<std::size_t> indices(const std::vector<FoundDisplay>& displays, const auto& meets) {
    std::vector<std::size_t> found;
    for (std::size_t i = 0; i < displays.size(); ++i)
        if (meets(displays[i])) found.push_back(i);
    return found;
}

Result<std::size_t> named(const std::vector<FoundDisplay>& displays, const DisplayIdentity& wish) {
    auto found = indices(displays, [&](const FoundDisplay& d) { return fits(d.identity, wish); });
    if (found.size() > 1 && !wish.connector.empty()) {
        const auto there = indices(
            displays, [&](const auto& d) { return fits(d.identity, wish) && d.identity.connector == wish.connector; });
        if (there.size() == 1) found = there;
    }
    if (found.empty())
        return fail(Fault::notFound,
                    "The projector's display " + displayName(wish) + " is not there; check its cable and its power.");
    if (found.size() > 1)
        return fail(Fault::notFound, "Several displays are called " + displayName(wish) + ": " +
                                         namesOf(displays, found) +
                                         "; name the projector's connector in the rig, or unplug the others.");
    return found.front();
}

Result<std::size_t> unnamed(const std::vector<FoundDisplay>& displays, Size raster) {
    const std::size_t on = indices(displays, isOn).size();
    const bool primaryKnown = !indices(displays, [](const FoundDisplay& d) { return d.primary && isOn(d); }).empty();
    auto found = indices(displays, [&](const FoundDisplay& d) { return d.mode == raster && !(d.primary && on > 1); });
    if (found.empty() && primaryKnown)
        found = indices(displays, [&](const FoundDisplay& d) { return isOn(d) && !d.primary && offers(d, raster); });
    if (found.empty())
        return fail(Fault::notFound,
                    "No display but the operator's is " + sizeText(raster) +
                        ", as the projector's must be; connect it and set it to that mode, or name its "
                        "display in the rig.");
    if (found.size() > 1)
        return fail(Fault::notFound, "Several displays could be the projector's: " + namesOf(displays, found) +
                                         "; name the right one in the rig.");
    return found.front();
}

/// Why this display must not be drawn on; empty: it may be.
std::string operatorsScreen(const std::vector<FoundDisplay>& displays, std::size_t index, Size raster) {
    const FoundDisplay& chosen = displays[index];
    const std::string name = displayName(chosen.identity);
    bool alone = true;
    for (std::size_t i = 0; i < displays.size(); ++i) {
        if (i == index || !isOn(displays[i])) continue;
        alone = false;
        if (isOn(chosen) && overlap(chosen, displays[i]))
            return name + " shows the same as " + displayName(displays[i].identity) +
                   ", which would be covered; extend the desktop instead of mirroring it.";
    }
    if (!alone && chosen.primary)
        return name +
               " is the operator's screen (the primary one), not a projector's; make another display primary, or "
               "name the projector's in the rig.";
    if (alone && isOn(chosen) && chosen.mode != raster)
        return name + " is the only display and " + sizeText(chosen.mode) +
               ", so it is the operator's screen, not the projector's " + sizeText(raster) + "; connect the projector.";
    return {};
}

}  // namespace

Result<ChosenDisplay> chosenDisplay(const std::vector<FoundDisplay>& displays, const DisplayWish& wish, bool switchOn) {
    assert(wish.raster.width > 0 && wish.raster.height > 0);
    const auto index =
        wish.display == DisplayIdentity{} ? unnamed(displays, wish.raster) : named(displays, wish.display);
    if (!index) return tl::unexpected(index.error());
    const FoundDisplay& chosen = displays[*index];
    const std::string name = displayName(chosen.identity);
    if (!isOn(chosen) && !switchOn)
        return fail(Fault::notFound, "The projector's display " + name +
                                         " is switched off; switch it on beside the operator's screen, as " +
                                         sizeText(wish.raster) + ".");
    if (const auto refusal = operatorsScreen(displays, *index, wish.raster); !refusal.empty())
        return fail(Fault::unsafe, refusal);
    if (chosen.mode == wish.raster && chosen.plain) return ChosenDisplay{*index, false};
    if (chosen.mode != wish.raster && !offers(chosen, wish.raster))
        return fail(Fault::unsupported,
                    "The projector's display " + name + " has no mode " + sizeText(wish.raster) +
                        (isOn(chosen) ? " (it is " + sizeText(chosen.mode) + ")" : "") +
                        "; nothing else shows its pixels one to one. Check that it is the projector, or add the mode "
                        "(illuminatedfocus doctor says how).");
    return ChosenDisplay{*index, true};
}

std::string displayName(const DisplayIdentity& identity) {
    std::string device = identity.maker;
    for (const std::string& part : {identity.model, identity.serial})
        if (!part.empty()) device += (device.empty() ? "" : " ") + part;
    if (identity.connector.empty()) return device;
    return device.empty() ? identity.connector : identity.connector + " (" + device + ")";
}

}  // namespace ilf::devices
