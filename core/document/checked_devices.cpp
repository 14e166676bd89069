// What a rig may say of its devices. Drivers check again what they are given.
#include <algorithm>
#include <cmath>

#include "core/document/edit_parts.h"

namespace ilf {
namespace {

/// Where a device hangs, as the kernel writes it: bus, then ports: "1-2", "1-2.3.1".
bool isUsbPlace(const std::string& text) {
    const auto number = [&](std::size_t from, std::size_t to) {
        return from < to && to - from <= 3 &&
               std::all_of(
                   text.begin() + static_cast<std::ptrdiff_t>(from), text.begin() + static_cast<std::ptrdiff_t>(to),
                   [](char c) { return c >= '0' && c <= '9'; });
    };
    std::size_t from = text.find('-');
    if (from == std::string::npos || !number(0, from)) return false;
    while (true) {
        const std::size_t to = std::min(text.find('.', ++from), text.size());
        if (!number(from, to)) return false;
        if (to == text.size()) return true;
        from = to;
    }
}

Result<void> checkedPlace(const std::string& spoken, const std::string& place) {
    if (place.empty() || isUsbPlace(place)) return {};
    return fail(Fault::outOfRange, "The place of the " + spoken + " must be one on the USB such as 1-2 or 1-2.3 (see " +
                                       "illuminatedfocus --list-devices), or empty where there is only one.");
}

Result<void> checkedPlugin(const RigDevices& devices) {
    constexpr std::size_t kLongest = 4000;
    const std::string& path = devices.projectorPlugin;
    if (path.size() > kLongest || devices.projectorOptions.size() > kLongest)
        return fail(Fault::outOfRange, "The projector's plugin and its options may have 4000 letters each at most.");
    if (!path.empty() && path.front() != '/')
        return fail(Fault::outOfRange, "The projector's plugin must be named by its whole path, such as "
                                       "/opt/vendor/projector.so: nothing is searched for.");
    if (!path.empty() && devices.rehearsal)
        return fail(Fault::outOfRange, "A rig rehearses on a display or plays through a plugin: leave one of the two.");
    return {};
}

Result<void> checkedText(const std::string& text) {
    if (text.empty()) return {};
    const auto fine = checkedName(text);
    if (!fine) return fail(Fault::outOfRange, "In what the rig says of its display: " + fine.error().what);
    return {};
}

Result<void> checkedAmplifier(const Amplifier& a, const std::string& lens) {
    const std::string of = " of the " + lens + " lens's amplifier";
    const auto gain = [&](const std::string& spoken, VoltPerAmpere value) {
        return inRange(spoken, std::abs(value.si()), 1e-3, 1e4, "V/A, either sign");
    };
    if (auto ok = inRange("the rest voltage" + of, a.zero.si(), 0.0, 5.0, "V", "the DAC gives no other"); !ok)
        return ok;
    if (auto ok = gain("the gain at the DAC" + of, a.dac); !ok) return ok;
    if (auto ok = gain("the gain at the input" + of, a.input); !ok) return ok;
    // No tunable lens of this kind bears more.
    if (auto ok = inRange("the greatest current" + of, a.most.si(), 1e-3, 0.3, "A"); !ok) return ok;
    if (auto ok = inRange("the greatest slope" + of, a.slew.si(), 0.1, 1e5, "A/s"); !ok) return ok;
    const double swing = std::abs(a.dac.si()) * a.most.si();
    if (a.zero.si() - swing < -1e-9 || a.zero.si() + swing > 5.0 + 1e-9)
        return fail(Fault::outOfRange, "The greatest current" + of +
                                           " needs more than the 0 to 5 V of the DAC: lower " +
                                           "it, or correct the gain.");
    return {};
}

Result<void> checkedWiring(const LensWiring& wiring, const std::string& lens) {
    if (auto ok = checkedAmplifier(wiring.amplifier, lens); !ok) return ok;
    const std::string of = " of the " + lens + " lens's static calibration";
    constexpr std::size_t kMost = 1000;
    const auto& powers = wiring.powers;
    if (powers.size() == 1 || powers.size() > kMost)
        return fail(Fault::outOfRange,
                    "The points" + of + " must be none or from 2 to 1000, not " + std::to_string(powers.size()) + ".");
    for (const StaticPower& one : powers) {
        const double most = wiring.amplifier.most.si();
        if (auto ok = inRange("each current" + of, one.current.si(), -most, most, "A", "its amplifier gives no more");
            !ok)
            return ok;
        if (auto ok = inRange("each power" + of, one.power.si(), -50.0, 50.0, "D"); !ok) return ok;
    }
    for (std::size_t i = 1; i < powers.size(); ++i) {
        const bool ascends = powers[i].current > powers[i - 1].current;
        const bool rises = powers[i].power > powers[i - 1].power, risesAtFirst = powers[1].power > powers[0].power;
        if (!ascends || rises != risesAtFirst || powers[i].power == powers[i - 1].power)
            return fail(Fault::outOfRange, "The points" + of + " must ascend in current, and their powers must all " +
                                               "rise or all fall: sort them, or measure again.");
    }
    return {};
}

}  // namespace

Result<void> checked(const RigDevices& devices) {
    for (const auto& ok :
         {checkedPlugin(devices),
          devices.projectorPlugin.empty() ? checkedPlace("projector", devices.projectorAt) : Result<void>(),
          checkedPlace("lenses", devices.lensesAt), checkedText(devices.display.connector),
          checkedText(devices.display.maker), checkedText(devices.display.model), checkedText(devices.display.serial),
          checkedWiring(devices.left, "left"), checkedWiring(devices.right, "right"),
          inRange("the low level of the projector's trigger", devices.triggerLow.si(), 0.0, 10.0, "V"),
          inRange("the high level of the projector's trigger", devices.triggerHigh.si(), 0.0, 10.0, "V")})
        if (!ok) return ok;
    if (!devices.projectorAt.empty() && devices.projectorAt == devices.lensesAt)
        return fail(Fault::outOfRange, "Projector and lenses cannot hang on the same place of the USB.");
    if (devices.triggerLow >= devices.triggerHigh)
        return fail(Fault::outOfRange, "The low level of the projector's trigger must be below the high one.");
    return {};
}

}  // namespace ilf
