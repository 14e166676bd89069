// How far an eye of a given age can accommodate: least, mean and most.
#pragma once

#include "core/base/quantity.h"

namespace ilf {

struct AccommodationAmplitude {
    Dioptre least, mean, most;
    bool operator==(const AccommodationAmplitude&) const = default;
};

/// Hofstetter's amplitudes of accommodation, each at least 0 D: least 15 - 0.25 age, mean 18.5 - 0.3 age, most 25 - 0.4
/// age (years; valid to about 60; found by asking, measured ones are lower). In this order at every age. Source: H. W.
/// Hofstetter, 1950.
AccommodationAmplitude accommodationByAge(double years);

}  // namespace ilf
