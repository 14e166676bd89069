#include "core/perceived/engine_resample.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace ilf::view {
namespace {

using Four = std::array<double, 4>;

double sincSquared(double half) { return half == 0.0 ? 1.0 : std::pow(std::sin(half) / half, 2); }
double averaged(double w) { return 0.8 * std::cos(0.5 * w) + 0.2 * std::cos(1.5 * w); }

/// Weights of the samples -1, 0, 1, 2 for a value at `t` in 0..1 that make the picture averaged over `coarse` pixels,
/// blurred between coarse samples, look most like the fine one blurred: least squares over all frequencies, weighed
/// with what a picture (1/f) under a blur disc of about five samples has of them.
Four fitted(int coarse, double t) {
    std::array<Four, 4> normal{};
    Four right{};
    constexpr int kSteps = 400;
    for (int i = 0; i < kSteps; ++i) {
        const double theta = coarse * std::numbers::pi * (i + 0.5) / kSteps, w = theta / coarse;
        const double power = 1.0 / std::pow(1.0 + theta * theta / 0.36, 2);
        double down = averaged(w);
        if (coarse == 4) down *= averaged(2.0 * w);
        const double have = down * std::sin(0.5 * theta) / (0.5 * theta), want = sincSquared(0.5 * w);
        for (std::size_t a = 0; a < 4; ++a) {
            for (std::size_t b = 0; b < 4; ++b)
                normal[a][b] +=
                    power * have * have * std::cos(theta * (static_cast<double>(a) - static_cast<double>(b)));
            right[a] += power * have * want * std::cos(theta * (static_cast<double>(a) - 1.0 - t));
        }
    }
    for (std::size_t a = 0; a < 4; ++a) {  // a uniform picture stays what it is
        for (std::size_t b = 0; b < 4; ++b)
            normal[a][b] += 1e6;
        right[a] += 1e6;
    }
    for (std::size_t a = 0; a < 4; ++a) {
        for (std::size_t b = a + 1; b < 4; ++b) {
            const double factor = normal[b][a] / normal[a][a];
            for (std::size_t c = a; c < 4; ++c)
                normal[b][c] -= factor * normal[a][c];
            right[b] -= factor * right[a];
        }
    }
    Four weights{};
    for (std::size_t a = 4; a-- > 0;) {
        double rest = right[a];
        for (std::size_t c = a + 1; c < 4; ++c)
            rest -= normal[a][c] * weights[c];
        weights[a] = rest / normal[a][a];
    }
    const double sum = weights[0] + weights[1] + weights[2] + weights[3];
    for (double& weight : weights)
        weight /= sum;
    return weights;
}

/// `fitted` by linear interpolation in a table.
class FittedTable {
public:
    explicit FittedTable(int coarse) {
        for (int i = 0; i <= kPhases; ++i)
            table_[static_cast<std::size_t>(i)] = fitted(coarse, static_cast<double>(i) / kPhases);
    }
    Four operator()(double t) const {
        const double at = t * kPhases;
        const auto i = static_cast<std::size_t>(std::min(at, kPhases - 1.0));
        const double f = at - static_cast<double>(i);
        Four weights{};
        for (std::size_t k = 0; k < 4; ++k)
            weights[k] = (1.0 - f) * table_[i][k] + f * table_[i + 1][k];
        return weights;
    }

private:
    static constexpr int kPhases = 64;
    std::array<Four, kPhases + 1> table_{};
};

/// Linear weights averaged over a disc seen from its edge (density 2 sqrt(r^2 - p^2) / (pi r^2)): Gauss-Chebyshev
/// quadrature of the second kind. Small discs round only the corners at samples, where a blur between samples would be
/// smeared once more by interpolation.
Four softened(double radius, double t) {
    struct Point {
        double at, part;
    };
    static const auto points = [] {
        std::array<Point, 12> made{};
        for (std::size_t i = 0; i < made.size(); ++i) {
            const double n = static_cast<double>(made.size()) + 1.0;
            const double angle = std::numbers::pi * (static_cast<double>(i) + 1.0) / n, sine = std::sin(angle);
            made[i] = {std::cos(angle), 2.0 * sine * sine / n};
        }
        return made;
    }();
    Four weights{};
    for (const Point& point : points) {
        const double at = t + radius * point.at, left = std::floor(at);
        const auto first = static_cast<std::size_t>(static_cast<int>(left) + 1);
        weights[first] += point.part * (1.0 - (at - left));
        if (first + 1 < 4) weights[first + 1] += point.part * (at - left);
    }
    return weights;
}

Four weightsAt(const Placing& placing, double t) {
    if (placing.interpolation == Interpolation::linear) {
        return placing.softness > 0.0 ? softened(placing.softness, t) : Four{0.0, 1.0 - t, t, 0.0};
    }
    if (placing.coarse == 1) {
        const double t2 = t * t, t3 = t2 * t;
        return {-0.5 * t3 + t2 - 0.5 * t, 1.5 * t3 - 2.5 * t2 + 1.0, -1.5 * t3 + 2.0 * t2 + 0.5 * t,
                0.5 * t3 - 0.5 * t2};
    }
    static const FittedTable half(2), quarter(4);
    return placing.coarse == 2 ? half(t) : quarter(t);
}

/// The first of four samples for a pixel, and their weights.
struct At {
    int first = 0;
    Four weights{};
};
At sampleAt(const Placing& placing, double centre, int pixel) {
    const double source = (centre + (pixel + 0.5 - centre) / placing.magnification) / placing.coarse - 0.5;
    const double left = std::floor(source);
    return {static_cast<int>(left) - 1, weightsAt(placing, source - left)};
}

}  // namespace

AcrossTaps acrossTaps(const Placing& placing, int column) {
    AcrossTaps taps;
    taps.coarse = placing.coarse;
    std::array<At, kTileW> at;
    for (int x = 0; x < kTileW; ++x)
        at[static_cast<std::size_t>(x)] = sampleAt(placing, placing.centreX, column * kTileW + x);
    const auto [least, most] = std::ranges::minmax(at, {}, &At::first);
    taps.first = least.first;
    taps.width = most.first + 4 - least.first;
    const int perPhase = kTileW / placing.coarse;
    std::vector<std::array<At, AcrossTaps::kLanes>> groups;
    for (int phase = 0; phase < placing.coarse; ++phase) {
        for (int start = 0; start < perPhase; start += AcrossTaps::kLanes) {
            auto& lanes = groups.emplace_back();
            int low = 0, high = 0;
            for (int lane = 0; lane < AcrossTaps::kLanes; ++lane) {
                const auto of = static_cast<std::size_t>(lane);
                lanes[of] = at[static_cast<std::size_t>(placing.coarse * (start + lane) + phase)];
                low = lane == 0 ? lanes[of].first : std::min(low, lanes[of].first - lane);
                high = lane == 0 ? low : std::max(high, lanes[of].first - lane);
            }
            taps.groups.push_back({low - taps.first, 0});
            taps.taps = std::max(taps.taps, high - low + 4);
        }
    }
    for (std::size_t g = 0; g < groups.size(); ++g) {
        AcrossTaps::Group& group = taps.groups[g];
        group.weights = static_cast<int>(taps.weights.size());
        taps.weights.resize(taps.weights.size() + static_cast<std::size_t>(taps.taps * AcrossTaps::kLanes));
        for (int lane = 0; lane < AcrossTaps::kLanes; ++lane) {
            const At& of = groups[g][static_cast<std::size_t>(lane)];
            const int shift = of.first - lane - (group.base + taps.first);
            for (int i = 0; i < 4; ++i) {
                taps.weights[static_cast<std::size_t>(group.weights + (shift + i) * AcrossTaps::kLanes + lane)] =
                    static_cast<float>(of.weights[static_cast<std::size_t>(i)]);
            }
        }
    }
    return taps;
}

DownTaps downTaps(const Placing& placing, int row) {
    DownTaps taps;
    std::array<At, kTileH> at;
    for (int y = 0; y < kTileH; ++y)
        at[static_cast<std::size_t>(y)] = sampleAt(placing, placing.centreY, row * kTileH + y);
    const auto [least, most] = std::ranges::minmax(at, {}, &At::first);
    taps.first = least.first;
    taps.height = most.first + 4 - least.first;
    for (std::size_t y = 0; y < at.size(); ++y) {
        taps.row[y] = at[y].first - taps.first;
        for (std::size_t i = 0; i < 4; ++i)
            taps.weights[y][i] = static_cast<float>(at[y].weights[i]);
    }
    return taps;
}

}  // namespace ilf::view
