#include "app/output_core/rest_current.h"

#include "core/plan/words.h"

namespace ilf::app {
Result<Ampere> restCurrent(const LensWiring& wiring, Dioptre rest, const std::string& lens) {
    const auto& points = wiring.powers;
    if (points.empty()) {
        if (rest == 0.0_D) return Ampere();
        return fail(Fault::device, "The " + lens + " should rest at " + inWords(rest) +
                                       ", and the rig does not say what current gives that: measure its static powers "
                                       "and put them into the rig's file.");
    }
    for (std::size_t i = 1; i < points.size(); ++i) {
        const StaticPower &a = points[i - 1], &b = points[i];
        const double share = (rest - a.power) / (b.power - a.power);
        if (share >= 0.0 && share <= 1.0) return a.current + share * (b.current - a.current);
    }
    return fail(Fault::device, "The " + lens + " should rest at " + inWords(rest) +
                                   ", which is beyond its static calibration of " + inWords(points.front().power) +
                                   " to " + inWords(points.back().power) + ": measure farther, or let it rest there.");
}

}  // namespace ilf::app
