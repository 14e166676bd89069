#include "core/lens/shaped_model.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace ilf {
namespace {

/// Of the static gain: what a harmonic that the lens hardly passes may still change, since the bend of the static
/// answer comes before the resonance. Without it a moved mean is blamed on the drive's mean alone, and learning swings.
constexpr double kCoupled = 0.1;

void addTo(Harmonics& sum, const Harmonics& f, double times) {
    if (sum.c.size() < f.c.size()) sum.c.resize(f.c.size());
    for (std::size_t k = 0; k < f.c.size(); ++k)
        sum.c[k] += times * f.c[k];
}

}  // namespace

std::vector<double> unknownsOf(const Harmonics& drive, std::size_t harmonics) {
    std::vector<double> x(2 * harmonics + 1);
    x[0] = drive.mean();
    for (std::size_t k = 1; k < drive.c.size() && k <= harmonics; ++k) {
        x[2 * k - 1] = drive.c[k].real();
        x[2 * k] = drive.c[k].imag();
    }
    return x;
}

Harmonics driveOf(std::span<const double> unknowns) {
    Harmonics drive{{unknowns[0]}};
    for (std::size_t j = 1; j + 1 < unknowns.size(); j += 2)
        drive.c.emplace_back(unknowns[j], unknowns[j + 1]);
    return drive;
}

Harmonics PowerModel::power(const Harmonics& drive) const {
    Harmonics sum = rest;
    const std::vector<double> x = unknownsOf(drive, harmonics());
    for (std::size_t j = 0; j < slopes.size(); ++j)
        addTo(sum, slopes[j], x[j]);
    return sum;
}

PowerModel modelOf(const LensResponse& response, std::size_t harmonics) {
    assert(response.gain.size() > harmonics);
    PowerModel model{response.rate, response.unit, {{response.bias_D}}, {}};
    model.slopes.push_back({{response.gain[0].real()}});
    for (std::size_t k = 1; k <= harmonics; ++k) {
        for (const std::complex<double> one : {std::complex<double>(1.0), std::complex<double>(0.0, 1.0)}) {
            Harmonics slope;
            slope.c.resize(k + 1);
            slope.c[k] = one * response.gain[k];
            model.slopes.push_back(std::move(slope));
        }
    }
    return model;
}

void moveTo(PowerModel& model, const Harmonics& drive, const Harmonics& power) {
    Harmonics miss = power;
    addTo(miss, model.power(drive), -1.0);
    addTo(model.rest, miss, 1.0);
}

void correct(PowerModel& model, const Harmonics& driveChange, const Harmonics& powerChange, double noise_D) {
    const std::vector<double> s = unknownsOf(driveChange, model.harmonics());
    Harmonics miss = powerChange;
    std::vector<double> weighted(s.size());
    double square = 0.0;
    const double coupled = kCoupled * model.slopes[0].rms();
    for (std::size_t j = 0; j < s.size(); ++j) {
        addTo(miss, model.slopes[j], -s[j]);
        const double effect = std::hypot(model.slopes[j].rms(), coupled);
        weighted[j] = effect * effect * s[j];
        square += weighted[j] * s[j];
    }
    const double scale = square + noise_D * noise_D;
    if (!(scale > 0.0)) return;
    for (std::size_t j = 0; j < s.size(); ++j)
        addTo(model.slopes[j], miss, weighted[j] / scale);
}

}  // namespace ilf
