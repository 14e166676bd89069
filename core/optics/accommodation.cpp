#include "core/optics/accommodation.h"

#include <algorithm>

namespace ilf {

AccommodationAmplitude accommodationByAge(double years) {
    const auto line = [years](double atBirth, double perYear) {
        return Dioptre::fromSi(std::max(0.0, atBirth - perYear * years));
    };
    return {line(15.0, 0.25), line(18.5, 0.3), line(25.0, 0.4)};
}

}  // namespace ilf
