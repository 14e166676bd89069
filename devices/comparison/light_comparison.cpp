#include "devices/comparison/light_comparison.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>

namespace ilf::devices {
namespace {

std::string milliseconds(Second time, bool sign) {
    char text[32];
    // -0.00 reads as if there were something.
    const double value = std::abs(time.in(1.0_ms)) < 0.005 ? 0.0 : time.in(1.0_ms);
    std::snprintf(text, sizeof text, sign ? "%+.2f ms" : "%.2f ms", value);
    return text;
}

std::string counted(std::int64_t count, const char* what) {
    return std::to_string(count) + " " + what + (count == 1 ? "" : "s");
}

/// For each intended slot the received one that is its own, if any.
std::vector<std::optional<std::size_t>> partners(const std::vector<SlotLight>& intended,
                                                 const std::vector<SlotLight>& received) {
    std::vector<std::optional<std::size_t>> of(intended.size());
    const auto away = [&](std::size_t slot, std::size_t light) {
        return abs(received[light].start - intended[slot].start);
    };
    for (std::size_t light = 0; light < received.size(); ++light) {
        std::optional<std::size_t> nearest;
        for (std::size_t slot = 0; slot < intended.size(); ++slot)
            if (!nearest || away(slot, light) < away(*nearest, light)) nearest = slot;
        if (!nearest || away(*nearest, light) >= 0.5 * intended[*nearest].length) continue;
        auto& partner = of[*nearest];
        if (!partner || away(*nearest, light) < away(*nearest, *partner)) partner = light;
    }
    return of;
}

SlotDifference difference(const SlotLight& intended, const SlotLight& received) {
    SlotDifference found;
    found.late = received.start - intended.start;
    found.longer = received.length - intended.length;
    const auto wanted = intended.light.pixels(), got = received.light.pixels();
    if (intended.light.size() != received.light.size() || wanted.size() != got.size()) {
        found.differingPixels = static_cast<std::int64_t>(wanted.size());
        found.largest = 255;
        found.mean = 255.0;
        return found;
    }
    const bool sameColours = intended.colours == received.colours;
    std::int64_t sum = 0;
    for (std::size_t i = 0; i < wanted.size(); ++i) {
        const int away = sameColours ? std::abs(int(wanted[i]) - int(got[i])) : int(std::max(wanted[i], got[i]));
        sum += away;
        found.differingPixels += away != 0 ? 1 : 0;
        found.largest = std::max(found.largest, away);
    }
    found.mean = wanted.empty() ? 0.0 : double(sum) / double(wanted.size());
    return found;
}

SlotDifference missing(const SlotLight& intended) {
    SlotDifference lost;
    lost.missing = true;
    const auto wanted = intended.light.pixels();
    lost.differingPixels = static_cast<std::int64_t>(wanted.size());
    double sum = 0.0;
    for (const std::uint8_t value : wanted) {
        sum += value;
        lost.largest = std::max<int>(lost.largest, value);
    }
    lost.mean = wanted.empty() ? 0.0 : sum / double(wanted.size());
    return lost;
}

}  // namespace

LightComparison compared(const std::vector<SlotLight>& intended, const std::vector<SlotLight>& received) {
    LightComparison found;
    const auto partner = partners(intended, received);
    std::optional<Second> earliest, latest;
    for (std::size_t slot = 0; slot < intended.size(); ++slot) {
        if (!partner[slot]) {
            found.slots.push_back(missing(intended[slot]));
            ++found.missing;
        } else {
            const auto& slotFound = found.slots.emplace_back(difference(intended[slot], received[*partner[slot]]));
            earliest = earliest ? std::min(*earliest, slotFound.late) : slotFound.late;
            latest = latest ? std::max(*latest, slotFound.late) : slotFound.late;
        }
        found.differingPixels += found.slots.back().differingPixels;
    }
    found.extra = static_cast<int>(received.size()) - (static_cast<int>(intended.size()) - found.missing);
    if (earliest) {
        found.offset = 0.5 * (*earliest + *latest);
        found.jitter = 0.5 * (*latest - *earliest);
    }
    return found;
}

std::string verdict(const LightComparison& comparison) {
    const auto slots = static_cast<std::int64_t>(comparison.slots.size());
    const std::string timing = comparison.missing == slots ? ""
                                                           : ", starts " + milliseconds(comparison.offset, true) +
                                                                 " (+-" + milliseconds(comparison.jitter, false) + ")";
    if (comparison.same()) return counted(slots, "slot") + " as intended, 0 differing pixels" + timing;

    std::string words = counted(comparison.differingPixels, "differing pixel") + " in ";
    std::string which;
    int differing = 0, largest = 0;
    for (std::size_t i = 0; i < comparison.slots.size(); ++i) {
        const SlotDifference& slot = comparison.slots[i];
        if (slot.differingPixels == 0) continue;
        constexpr int kMostNamed = 4;
        if (++differing <= kMostNamed) which += (differing == 1 ? " " : ", ") + std::to_string(i);
        if (differing == kMostNamed + 1) which += ", ...";
        largest = std::max(largest, slot.largest);
    }
    words += std::to_string(differing) + " of " + counted(slots, "slot");
    if (differing > 0) words += " (" + which.substr(1) + "), by up to " + std::to_string(largest) + " of 255";
    if (comparison.missing > 0) words += ", " + std::to_string(comparison.missing) + " missing";
    if (comparison.extra > 0) words += ", " + std::to_string(comparison.extra) + " too many";
    return words + timing;
}

}  // namespace ilf::devices
