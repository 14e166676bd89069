// What an emulated rig was meant to give in one sweep against what its cables brought: light and lenses, in numbers.
#pragma once

#include <array>
#include <vector>

#include "core/document/rig.h"
#include "devices/comparison/light_comparison.h"
#include "devices/link/messages.h"

namespace ilf::app {

/// The newest whole sweep of an emulated rig, with the light of each of its exposures.
struct ReceivedSweep {
    devices::Received received;
    std::vector<devices::ExposedLight> light;  ///< one for each of received.exposures
};

/// What a program's slots should give, times counted from the sweep's trigger: light as the projector's bits state it.
std::vector<devices::SlotLight> intendedSlots(const Program& program, const Rig& rig);
std::vector<devices::SlotLight> receivedSlots(const ReceivedSweep& sweep);

/// A lens's powers over a sweep from its trigger, as a Fourier series. Precondition: `powers` is not empty.
Harmonics receivedPower(const std::vector<Dioptre>& powers);

/// What a program loses to the bits of the projector's pictures, as shares of full light. No difference of light
/// received: the plan states it.
struct Quantisation {
    int bits = 8;
    double step = 0.0;     ///< between two levels of light: what a pixel's error stays below
    double largest = 0.0;  ///< error of a pixel
    double mean = 0.0;     ///< of all pixels' errors, without sign
    double shift = 0.0;    ///< of the mean light, with its sign: what dither leaves
};
Quantisation quantisationOf(const Program& program, const Rig& rig);

/// One eye's lens over the sweep: power received less power predicted, at the same time after the sweep's trigger.
struct LensDeviation {
    Dioptre rms, worst;
    struct InSlot {
        Dioptre predicted, received;  ///< means while the slot's light was on; missing slots: while it was due
    };
    std::vector<InSlot> slots;
    Dioptre rmsInSlots;  ///< while any light was on
};
/// `comparison` tells how late each slot was. Precondition: `powers` is not empty.
LensDeviation deviationOf(const std::vector<Dioptre>& powers, Second sweep, const Program& program,
                          const devices::LightComparison& comparison);

/// How a show ended: the light of the newest sweep as a share of full steady light, and the lenses.
struct Ended {
    bool steadyWhite = false;  ///< every pixel of every exposure is full, and they fill the sweep but for a thousandth
    double light = 0.0;        ///< mean over pixels and time, 1: full
    Dioptre farthest;          ///< the most that either lens was away from `rest`
    bool atRest = false;       ///< within kAtRest
};
/// A lens that rests keeps within this: a static calibration's straight lines and a degree of warmth. Half of what the
/// stage may still call settled.
inline constexpr Dioptre kAtRest = Dioptre::fromSi(0.1);
Ended endedAs(const ReceivedSweep& sweep, Dioptre rest);

}  // namespace ilf::app
