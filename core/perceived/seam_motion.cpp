#include "core/perceived/seam_motion.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace ilf {
namespace {

constexpr double kTau_s = 4.94e-3;
/// After this long nothing of a flash is felt: 1e-6 of its most.
constexpr double kForgotten_s = 0.17;
constexpr int kSamplesPerPeriod = 24;
constexpr int kPhases = 8;
constexpr long kMostSweeps = 24;  ///< looked at in each phase

double felt(double t) {
    if (t <= 0.0 || t > kForgotten_s) return 0.0;
    constexpr double kFactorial8 = 40320.0;
    const double u = t / kTau_s, u2 = u * u, u4 = u2 * u2;
    return u4 * u4 * std::exp(-u) / (kFactorial8 * kTau_s);
}

/// The mask across the edge as it is seen: a ramp of the feather's width, blurred by the disc; 0 before, 1 behind.
class BlurredRamp {
public:
    explicit BlurredRamp(const MovingEdge& edge)
        : width_(std::max(1e-9, edge.feather.si())), radius_(std::max(1e-9, edge.blurRadius.si())) {}
    double operator()(double x) const { return (rise(x + 0.5 * width_) - rise(x - 0.5 * width_)) / width_; }
    double reach() const { return 0.5 * width_ + radius_; }

private:
    /// Integral of a step blurred by the disc's chords.
    double rise(double x) const {
        if (x <= -radius_) return 0.0;
        if (x >= radius_) return x;
        const double t = x / radius_, root = std::sqrt(1.0 - t * t);
        return radius_ * (t * (0.5 + (std::asin(t) + t * root) / std::numbers::pi) +
                          2.0 / (3.0 * std::numbers::pi) * root * root * root);
    }
    double width_, radius_;
};

/// Where the mask of a pulse is drawn less where the edge truly is when its light falls.
double late(const EdgeLight::Pulse& pulse, const MovingEdge& edge, MaskTiming timing) {
    const double moved = edge.speed_m_s * pulse.at.si();
    return timing == MaskTiming::perPeriod ? -moved : edge.speedError * moved;
}

double pursued(const EdgeLight& light, const MovingEdge& edge, MaskTiming timing) {
    const BlurredRamp ramp(edge);
    double away = 0.0;
    for (const auto& pulse : light.pulses)
        away = std::max(away, std::abs(late(pulse, edge, timing)));
    const double reach = ramp.reach() + away;
    constexpr int kSteps = 400;
    double worst = 0.0;
    for (int i = 0; i <= kSteps; ++i) {
        const double x = reach * (2.0 * i / kSteps - 1.0);
        double sum = 0.0;
        for (const auto& pulse : light.pulses) {
            const double m = ramp(x - late(pulse, edge, timing));
            sum += pulse.weight * (pulse.displaced ? m : 1.0 - m);
        }
        worst = std::max(worst, std::abs(sum - 1.0));
    }
    return worst;
}

/// What is felt at a place the edge passes at time 0, over and above even light.
class Passing {
public:
    Passing(const EdgeLight& light, const MovingEdge& edge, MaskTiming timing)
        : light_(light), edge_(edge), timing_(timing), ramp_(edge), period_(light.period.si()) {
        for (int i = 0; i < kSamplesPerPeriod; ++i)
            flashes_[static_cast<std::size_t>(i)] = flashesFeltAt(period_ * i / kSamplesPerPeriod);
    }

    double worst() const {
        const double crossing = ramp_.reach() / edge_.speed_m_s + period_;
        const auto first = static_cast<long>(std::floor(-crossing / period_));
        const auto last = static_cast<long>(std::ceil((crossing + kForgotten_s) / period_)) + 1;
        // A slow edge stands nearly where it was a sweep before: no more of its sweeps than tell its way, spread over
        // it, others for each phase.
        const long stride = std::max(1L, (last - first) / kMostSweeps);
        double most = 0.0;
        for (int phase = 0; phase < kPhases; ++phase) {
            const double passes = period_ * phase / kPhases;
            for (long sweep = first + phase * stride / kPhases; sweep <= last; sweep += stride) {
                for (const auto& flashes : flashes_)
                    most = std::max(most, std::abs(at(flashes, static_cast<double>(sweep) * period_, passes) - 1.0));
            }
        }
        return std::max(0.0, most - ripple());
    }

private:
    /// A pulse that is still felt at a moment of a sweep.
    struct Flash {
        const EdgeLight::Pulse* pulse;
        double since;  ///< when its own sweep began, counted from the start of the sweep it is felt in
        double share;
    };

    std::vector<Flash> flashesFeltAt(double t) const {
        std::vector<Flash> flashes;
        for (auto k = static_cast<long>(std::floor((t - kForgotten_s) / period_)) - 1; k <= 0; ++k) {
            const double start = static_cast<double>(k) * period_;
            for (const auto& pulse : light_.pulses) {
                const double feels = felt(t - start - pulse.at.si());
                if (feels > 0.0) flashes.push_back({&pulse, start, period_ * pulse.weight * feels});
            }
        }
        return flashes;
    }
    double at(const std::vector<Flash>& flashes, double sweep, double passes) const {
        double sum = 0.0;
        for (const Flash& flash : flashes) {
            const double when = sweep + flash.since + flash.pulse->at.si();
            const double m = ramp_(edge_.speed_m_s * (passes - when) - late(*flash.pulse, edge_, timing_));
            sum += flash.share * (flash.pulse->displaced ? m : 1.0 - m);
        }
        return sum;
    }
    double ripple() const {
        double most = 0.0;
        for (const auto& flashes : flashes_) {
            std::array<double, 2> even{};
            for (const Flash& flash : flashes)
                even[flash.pulse->displaced ? 1 : 0] += flash.share;
            for (const double light : even)
                most = std::max(most, std::abs(light - 1.0));
        }
        return most;
    }

    const EdgeLight& light_;
    const MovingEdge& edge_;
    MaskTiming timing_;
    BlurredRamp ramp_;
    double period_;
    std::array<std::vector<Flash>, kSamplesPerPeriod> flashes_;
};

}  // namespace

EdgeLight edgeLight(const Plan& plan, int displaced, int other) {
    EdgeLight light{1.0 / plan.waveform.rate, {}};
    for (const int level : {displaced, other}) {
        double all = 0.0;
        const std::size_t first = light.pulses.size();
        for (const Slot& slot : plan.slots) {
            for (const LevelLight& lit : slot.lit) {
                if (lit.level != level) continue;
                light.pulses.push_back({slot.middle(), lit.weight, level == displaced});
                all += lit.weight;
            }
        }
        for (std::size_t i = first; i < light.pulses.size(); ++i)
            light.pulses[i].weight /= all;
    }
    return light;
}

double movingSeam(const EdgeLight& light, const MovingEdge& edge, MaskTiming timing, Watching watching) {
    if (edge.speed_m_s == 0.0) return 0.0;
    MovingEdge forward = edge;
    forward.speed_m_s = std::abs(edge.speed_m_s);
    return watching == Watching::pursuit ? pursued(light, forward, timing) : Passing(light, forward, timing).worst();
}

std::optional<double> speedThatShows(const EdgeLight& light, MovingEdge edge, MaskTiming timing, Watching watching,
                                     double limit) {
    constexpr double kSlowest = 1e-3, kFastest = 10.0;
    const auto shows = [&](double speed) {
        edge.speed_m_s = speed;
        return movingSeam(light, edge, timing, watching) > limit;
    };
    // Upwards in steps, then halving the last one.
    double low = kSlowest, high = kSlowest;
    while (!shows(high)) {
        if (high >= kFastest) return std::nullopt;
        low = high;
        high = std::min(kFastest, 1.5 * high);
    }
    for (int i = 0; i < 8; ++i) {
        const double middle = 0.5 * (low + high);
        (shows(middle) ? high : low) = middle;
    }
    return high;
}

Metre featherForSpeed(double speed_m_s, Second period) {
    return Metre::fromSi(2.0 * std::abs(speed_m_s) * period.si());
}

}  // namespace ilf
