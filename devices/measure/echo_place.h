// Where in its sweep an output stands, from what an input heard of it.
#pragma once

#include <optional>
#include <span>

#include "core/lens/harmonics.h"

namespace ilf::devices {

struct EchoPlace {
    double later = 0.0;  ///< in sweeps: to be added to the reckoned x
    double gain = 0.0;   ///< heard against told; 0 where the told drive stands still and says nothing
};

/// `heard`: one period of volts at reckoned places first, first + 1/n, ...; `told`: what the output was to put out, in
/// volts (its mean is not looked at), held from each of `frames` samples a sweep to the next, which makes it half a
/// sample late. None: what is heard is not this wave (below 0.8 or above 1.25 of it, or less alike than 0.95).
std::optional<EchoPlace> echoPlace(std::span<const double> heard, double first, const Harmonics& told, double frames);

}  // namespace ilf::devices
