#include "core/perceived/engine_lights.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "core/optics/chromatic.h"

namespace ilf::view {
namespace {

using Sample = PowerSpread::Sample;

/// Gauss-Legendre, five nodes on 0..1.
constexpr std::array<double, 5> kNodes{0.046910077030668, 0.230765344947158, 0.5, 0.769234655052842, 0.953089922969332};
constexpr std::array<double, 5> kWeights{0.118463442528095, 0.239314335249683, 0.284444444444444, 0.239314335249683,
                                         0.118463442528095};

void divide(std::vector<Sample> samples, double limit, int level, std::vector<PowerLight>& into) {
    double weight = 0.0, mean = 0.0, variance = 0.0, third = 0.0;
    for (const Sample& s : samples) {
        weight += s.weight;
        mean += s.weight * s.power;
    }
    if (!(weight > 0.0)) return;
    mean /= weight;
    for (const Sample& s : samples) {
        const double d = s.power - mean;
        variance += s.weight * d * d / weight;
        third += s.weight * d * d * d / weight;
    }
    const double spread = std::sqrt(variance);
    const auto add = [&](double power, double w) { into.push_back({level, Dioptre::fromSi(power), w}); };
    if (spread <= limit) return add(mean, weight);
    if (spread <= 2.0 * limit) {
        const double skew = third / (2.0 * variance), root = std::sqrt(variance + skew * skew);
        const double low = skew - root, high = skew + root;
        add(mean + low, weight * high / (high - low));
        add(mean + high, weight * -low / (high - low));
        return;
    }
    const auto [least, most] = std::ranges::minmax(samples, {}, &Sample::power);
    const double middle = 0.5 * (least.power + most.power);
    std::vector<Sample> upper;
    std::erase_if(samples, [&](const Sample& s) {
        if (s.power < middle) return false;
        upper.push_back(s);
        return true;
    });
    divide(std::move(samples), limit, level, into);
    divide(std::move(upper), limit, level, into);
}

}  // namespace

std::vector<PowerSpread> powerSpreads(const Plan& plan) {
    std::map<int, PowerSpread> byLevel;
    for (const Exposure& exposure : exposures(plan)) {
        PowerSpread& spread = byLevel[exposure.level];
        spread.level = exposure.level;
        const int parts = exposure.level == Exposure::kAmbient ? 64 : 1;
        for (int part = 0; part < parts; ++part) {
            for (std::size_t i = 0; i < kNodes.size(); ++i) {
                const Second t = exposure.start + (part + kNodes[i]) / parts * exposure.duration;
                const double weight = exposure.weight * kWeights[i] / parts;
                spread.samples.push_back({plan.waveform.powerAt(t).si(), weight});
                spread.weight += weight;
            }
        }
    }
    std::vector<PowerSpread> spreads;
    for (auto& [level, spread] : byLevel) {
        double sum = 0.0;
        for (const Sample& s : spread.samples)
            sum += s.weight * s.power;
        spread.mean = Dioptre::fromSi(spread.weight > 0.0 ? sum / spread.weight : 0.0);
        spreads.push_back(std::move(spread));
    }
    return spreads;
}

std::vector<PowerLight> powerLights(const PowerSpread& spread, Dioptre limit) {
    std::vector<PowerLight> lights;
    divide(spread.samples, limit.si(), spread.level, lights);
    return lights;
}

std::array<Dioptre, 3> colourShifts(const Plan& plan, const ViewRequest& request) {
    std::array<Dioptre, 3> shifts{};
    if (!request.chromatic || plan.input.camera || !plan.input.rig.primaries) return shifts;
    for (std::size_t c = 0; c < 3; ++c)
        shifts[c] = chromaticRefraction((*plan.input.rig.primaries)[c]).value_or(0.0_D);
    return shifts;
}

}  // namespace ilf::view
