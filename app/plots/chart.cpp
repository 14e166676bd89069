#include "app/plots/chart.h"

#include <cassert>
#include <cmath>
#include <cstdio>
#include <utility>

namespace ilf::app {
namespace {

double roundStep(double low, double high, int about) {
    const double rough = (high - low) / about;
    const double power = std::pow(10.0, std::floor(std::log10(rough)));
    const double digits = rough / power;
    return power * (digits <= 1.0 ? 1.0 : digits <= 2.0 ? 2.0 : digits <= 5.0 ? 5.0 : 10.0);
}

constexpr double kSlack = 1e-9;  // of a step: what is round but for rounding counts as round

}  // namespace

std::vector<double> ticks(double low, double high, int about) {
    assert(low < high && std::isfinite(low) && std::isfinite(high) && about >= 2);
    const double step = roundStep(low, high, about);
    std::vector<double> out;
    const double first = std::ceil(low / step - kSlack), last = std::floor(high / step + kSlack);
    for (double i = first; i <= last; i += 1.0)
        out.push_back(i * step + 0.0);  // never -0
    return out;
}

std::vector<std::string> tickWords(const std::vector<double>& ticks) {
    const double step = ticks.size() > 1 ? ticks[1] - ticks[0] : 1.0;
    const int decimals = std::max(0, static_cast<int>(std::ceil(-std::log10(step) - kSlack)));
    std::vector<std::string> out;
    for (const double tick : ticks) {
        char text[64];
        std::snprintf(text, sizeof text, "%.*f", decimals, tick);
        out.emplace_back(text);
    }
    return out;
}

ChartAxis axisOver(std::string title, double low, double high) {
    if (!std::isfinite(low)) low = std::isfinite(high) ? high : 0.0;
    if (!std::isfinite(high)) high = low;
    if (!(low < high)) {
        low -= 0.5;
        high = low + 1.0;
    }
    const double step = roundStep(low, high, 6);
    return {std::move(title), step * std::floor(low / step + kSlack), step * std::ceil(high / step - kSlack)};
}

}  // namespace ilf::app
