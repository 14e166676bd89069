#include "core/plan/projector.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>
#include <string>

#include "core/plan/words.h"

namespace ilf {
namespace {

constexpr std::array<double, 8> kShortest_us{235.0, 700.0, 1570.0, 1700.0, 2000.0, 2500.0, 4500.0, 8333.0};
constexpr int kPlanesAFrame = 24;
constexpr double kMostBelowSweep = 0.005;
/// Rates are typed with a few digits: 8333 us fit twice into 60 Hz.
constexpr double kSlack = 1.0 + 1e-6;

std::string rates(const Rig& rig, int slots) {
    return std::to_string(slots) + " slots, " + inWords(slots * rig.sweepRate.si(), 1) + " Hz";
}

}  // namespace

Second shortestSlot(const Rig& rig) {
    if (rig.kind == ProjectorKind::highSpeed) return 1.0 / rig.fastest;
    return kShortest_us[static_cast<std::size_t>(std::clamp(rig.bits, 1, 8) - 1)] * 1.0_us;
}

int mostSlots(const Rig& rig) {
    const double fit = 1.0 / (rig.sweepRate * shortestSlot(rig)) * kSlack;
    const int slots = static_cast<int>(std::min(fit, 4096.0));
    return rig.kind == ProjectorKind::lightCrafter4500 ? std::min(slots, kPlanesAFrame / std::clamp(rig.bits, 1, 8))
                                                       : slots;
}

Result<void> checkedProjector(const Rig& rig) {
    const int slots = slotsPerSweep(rig), most = mostSlots(rig);
    if (slots <= most) return {};
    const std::string pictures = "pictures of " + std::to_string(rig.bits) + (rig.bits == 1 ? " bit" : " bits");
    const std::string which = rig.kind == ProjectorKind::lightCrafter4500
                                  ? "A LightCrafter 4500 shows " + pictures + " for at least "
                                  : "This projector shows " + pictures + " for at least ";
    std::string why = which + inWords(shortestSlot(rig).in(1.0_us), 0) + " us, so that " + std::to_string(slots) +
                      " slots do not fit into a sweep of " + inWords(rig.sweepRate.si(), 1) + " Hz. ";
    const bool few = rig.kind == ProjectorKind::lightCrafter4500;
    if (most >= 2)
        return fail(Fault::unsafe, why + "Use at most " + rates(rig, most) + (few ? ", or fewer bits." : "."));
    return fail(Fault::unsafe, why + (few ? "Use fewer bits or a slower sweep." : "Use a slower sweep."));
}

Rig withProjector(Rig rig, ProjectorKind kind, int bits) {
    rig.kind = kind;
    rig.bits = std::clamp(bits, 1, 8);
    rig.slotRate = std::max(2, mostSlots(rig)) * rig.sweepRate;
    return rig;
}

Beat slowestBeat(Hertz slotRate, Hertz sweepRate) {
    // The pattern repeats after the least number of sweeps that hold a whole number of slots.
    const double ratio = slotRate / sweepRate;
    int sweeps = 1;
    while (sweeps < 1000 && std::abs(ratio * sweeps - std::round(ratio * sweeps)) > 1e-6 * ratio * sweeps)
        ++sweeps;
    const double length = ratio * sweeps;  // in slots
    for (int k = 1; k < sweeps; ++k) {
        std::complex<double> sum = 0.0;
        for (int i = 0; i < sweeps; ++i) {
            const double slot = std::round(ratio * i);
            sum += std::polar(1.0, -2.0 * std::numbers::pi * k * slot / length);
        }
        const double modulation = 2.0 * std::abs(sum) / sweeps;
        if (modulation > kMostBelowSweep) return {(static_cast<double>(k) / sweeps) * sweepRate, modulation};
    }
    return {};
}

}  // namespace ilf
