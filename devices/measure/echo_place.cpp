#include "devices/measure/echo_place.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

namespace ilf::devices {
namespace {

// A told wave below this says nothing (volts rms): one step of the input is 4.9 mV.
constexpr double kFaintest = 0.02;
constexpr int kPlaces = 1024;

}  // namespace

std::optional<EchoPlace> echoPlace(std::span<const double> heard, double first, const Harmonics& told, double frames) {
    double toldSquare = 0.0;
    for (std::size_t k = 1; k < told.c.size(); ++k)
        toldSquare += std::norm(told.c[k]);
    if (std::sqrt(0.5 * toldSquare) < kFaintest) return EchoPlace{};

    const std::size_t count = std::min(told.c.size() - 1, heard.size() / 2 - 1);
    Harmonics is = harmonicsOf(heard, count);
    // From places counted from the first sample to reckoned ones.
    is = is.delayed(first);
    double heardSquare = 0.0;
    for (std::size_t k = 1; k < is.c.size(); ++k)
        heardSquare += std::norm(is.c[k]);
    const auto alike = [&](double later) {
        double sum = 0.0;
        for (std::size_t k = 1; k < is.c.size() && k < told.c.size(); ++k)
            sum += std::real(is.c[k] * std::conj(told.c[k]) *
                             std::polar(1.0, -2.0 * std::numbers::pi * static_cast<double>(k) * later));
        return sum;
    };
    double best = 0.0;
    for (int i = 1; i < kPlaces; ++i) {
        const double later = static_cast<double>(i) / kPlaces;
        if (alike(later) > alike(best)) best = later;
    }
    double low = best - 1.0 / kPlaces, high = best + 1.0 / kPlaces;
    constexpr double kGolden = 0.381966011250105;
    for (int i = 0; i < 60; ++i) {
        const double a = low + kGolden * (high - low), b = high - kGolden * (high - low);
        (alike(a) > alike(b) ? high : low) = alike(a) > alike(b) ? b : a;
    }
    best = 0.5 * (low + high);
    EchoPlace place;
    place.gain = alike(best) / toldSquare;
    if (place.gain < 0.8 || place.gain > 1.25 || alike(best) < 0.95 * std::sqrt(toldSquare * heardSquare))
        return std::nullopt;
    place.later = best + 0.5 / frames;
    place.later -= std::round(place.later);
    return place;
}

}  // namespace ilf::devices
