#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "core/lens/continuous_model.h"
#include "core/lens/continuous_wave.h"

namespace ilf {
namespace {

constexpr double kNearEnough_D = 1e-11;

/// Inside the border, or outside by less than rounding.
bool within(const ContinuousModel& model, const SineDrive& drive) {
    const double slack = 1e-9 * model.offsetScale * model.amplitudeScale;
    for (std::size_t i = 0; i < model.border.size(); ++i) {
        const SineDrive &p = model.border[i], &q = model.border[(i + 1) % model.border.size()];
        const double area = (q.offset - p.offset) * (drive.amplitude - p.amplitude) -
                            (q.amplitude - p.amplitude) * (drive.offset - p.offset);
        if (area < -slack) return false;
    }
    return !model.border.empty() && drive.amplitude >= 0.0;
}

/// Where the border cuts the line of this amplitude.
std::pair<double, double> offsetsAt(const ContinuousModel& model, double amplitude) {
    double left = std::numeric_limits<double>::infinity(), right = -left;
    for (std::size_t i = 0; i < model.border.size(); ++i) {
        const SineDrive &p = model.border[i], &q = model.border[(i + 1) % model.border.size()];
        if ((p.amplitude - amplitude) * (q.amplitude - amplitude) > 0.0) continue;
        const double rise = q.amplitude - p.amplitude;
        const double part = rise == 0.0 ? 0.0 : (amplitude - p.amplitude) / rise;
        const double offset = p.offset + part * (q.offset - p.offset);
        left = std::min({left, offset, rise == 0.0 ? q.offset : offset});
        right = std::max({right, offset, rise == 0.0 ? q.offset : offset});
    }
    return {left, right};
}

/// Newton in two dimensions: by the envelope theorem extremes change as the power does where they lie. Slots centred on
/// them nearly do, which costs a step or two more.
std::optional<SineDrive> solved(const ModelPolynomials& polynomials, const SlotMeasure& measure, SineDrive drive,
                                double low, double high) {
    for (int step = 0; step < 30; ++step) {
        const BentWave wave = polynomials.at(drive);
        const Extremes e = measure(wave.power, extremes(wave.power));
        const double offLow = e.low - low, offHigh = e.high - high;
        if (std::max(std::abs(offLow), std::abs(offHigh)) < kNearEnough_D) return drive;
        const ModelWave byOffset = measure(wave.byOffset), byAmplitude = measure(wave.byAmplitude);
        const double lowByO = byOffset.at(e.atLow), lowByA = byAmplitude.at(e.atLow);
        const double highByO = byOffset.at(e.atHigh), highByA = byAmplitude.at(e.atHigh);
        const double det = lowByO * highByA - lowByA * highByO;
        if (det == 0.0) return std::nullopt;
        double o = (offLow * highByA - offHigh * lowByA) / det, a = (offHigh * lowByO - offLow * highByO) / det;
        // Damped: a quarter of the records' range at once, and half of the way to no amplitude.
        const double most = std::max(std::abs(o), std::abs(a));
        if (most > 0.25) o *= 0.25 / most, a *= 0.25 / most;
        drive.offset -= o;
        drive.amplitude = std::max(drive.amplitude - a, 0.5 * drive.amplitude);
        if (!(std::abs(drive.offset) < 2.0 && drive.amplitude < 2.0)) return std::nullopt;
    }
    return std::nullopt;
}

/// The still lens: no amplitude, no extremes to follow.
std::optional<SineDrive> solvedStill(const ModelPolynomials& polynomials, double offset, double power) {
    for (int step = 0; step < 20; ++step) {
        const BentWave wave = polynomials.at({offset, 0.0});
        const double off = wave.power.re[0] - power;
        if (std::abs(off) < kNearEnough_D) return SineDrive{offset, 0.0};
        if (wave.byOffset.re[0] == 0.0) return std::nullopt;
        offset -= std::clamp(off / wave.byOffset.re[0], -0.25, 0.25);
    }
    return std::nullopt;
}

/// Where on a row of the map the lowest power is `low`.
struct OnRow {
    double offset = 0.0, high = 0.0;
};
std::optional<OnRow> onRow(const ContinuousModel::Row& row, double low) {
    const std::size_t last = row.low_D.size() - 1;
    for (std::size_t i = 0; i < last; ++i) {
        const double from = row.low_D[i] - low, to = row.low_D[i + 1] - low;
        if (from * to > 0.0 || from == to) continue;
        const double part = from / (from - to);
        const double along = (static_cast<double>(i) + part) / static_cast<double>(last);
        return OnRow{row.offsetLow + along * (row.offsetHigh - row.offsetLow),
                     row.high_D[i] + part * (row.high_D[i + 1] - row.high_D[i])};
    }
    return std::nullopt;
}

}  // namespace

std::vector<ContinuousModel::Row> mapped(const ContinuousModel& model) {
    constexpr std::size_t kRows = 17, kColumns = 13;
    const ModelPolynomials polynomials(model);
    double tallest = 0.0;
    for (const SineDrive& corner : model.border)
        tallest = std::max(tallest, corner.amplitude);
    const double top = model.scaled({0.0, tallest}).amplitude;
    std::vector<ContinuousModel::Row> map(kRows);
    for (std::size_t r = 0; r < kRows; ++r) {
        ContinuousModel::Row& row = map[r];
        row.amplitude = r + 1 == kRows
                            ? tallest
                            : model.unscaled({0.0, top * static_cast<double>(r) / double(kRows - 1)}).amplitude;
        std::tie(row.offsetLow, row.offsetHigh) = offsetsAt(model, row.amplitude);
        for (std::size_t c = 0; c < kColumns; ++c) {
            const double along = static_cast<double>(c) / double(kColumns - 1);
            const SineDrive at =
                model.scaled({row.offsetLow + along * (row.offsetHigh - row.offsetLow), row.amplitude});
            const Extremes e = extremes(polynomials.at(at).power);
            row.low_D.push_back(e.low);
            row.high_D.push_back(e.high);
        }
    }
    return map;
}

std::optional<Inverted> inverted(const ContinuousModel& model, double low, double high, double shift,
                                 double slotLength) {
    if (!(low <= high)) return std::nullopt;
    const double wantedLow = low - shift, wantedHigh = high - shift;
    const ModelPolynomials polynomials(model);
    const SlotMeasure measure(slotLength);
    const auto checked = [&](const std::optional<SineDrive>& at) -> std::optional<Inverted> {
        if (!at) return std::nullopt;
        const SineDrive drive = model.unscaled(*at);
        if (!within(model, drive)) return std::nullopt;
        const ModelWave wave = polynomials.at(*at).power;
        Inverted out{drive, {}, extremes(wave)};
        out.extremes.low += shift;
        out.extremes.high += shift;
        for (std::size_t k = 0; k < kModelHarmonics; ++k)
            out.power.c.emplace_back(wave.re[k] + (k == 0 ? shift : 0.0), wave.im[k]);
        return out;
    };

    const auto made = model.map.empty() ? mapped(model) : std::vector<ContinuousModel::Row>{};
    const auto& map = model.map.empty() ? made : model.map;
    // Where a start has an amplitude, if only a small one, Newton has extremes to follow.
    const double small = 0.05 * map[1].amplitude;
    if (high - low < 1e-9) {
        const auto start = onRow(map.front(), wantedLow);
        if (!start) return std::nullopt;
        return checked(solvedStill(polynomials, model.scaled({start->offset, 0.0}).offset, wantedLow));
    }
    // Row by row of growing amplitude: the first crossing is the solution of least amplitude.
    std::optional<OnRow> before;
    double amplitudeBefore = 0.0;
    for (const auto& row : map) {
        const auto here = onRow(row, wantedLow);
        const double offBefore = before ? before->high - wantedHigh : 0.0, off = here ? here->high - wantedHigh : 0.0;
        std::optional<SineDrive> start;
        if (before && here && offBefore <= 0.0 && off >= 0.0) {
            const double part = off > offBefore ? -offBefore / (off - offBefore) : 0.5;
            start = SineDrive{before->offset + part * (here->offset - before->offset),
                              amplitudeBefore + part * (row.amplitude - amplitudeBefore)};
        } else if (before && !here && offBefore <= 0.0) {
            start = SineDrive{before->offset, amplitudeBefore};  // the curve leaves the border in between
        } else if (!before && here && off >= 0.0) {
            start = SineDrive{here->offset, row.amplitude};
        }
        if (start) {
            start->amplitude = std::max(start->amplitude, small);
            if (auto found = checked(solved(polynomials, measure, model.scaled(*start), wantedLow, wantedHigh)))
                return found;
        }
        before = here;
        amplitudeBefore = row.amplitude;
    }
    // Near a corner no row may cross at all: from the nearest node.
    SineDrive nearest;
    double least = std::numeric_limits<double>::infinity();
    for (const auto& row : map) {
        for (std::size_t c = 0; c < row.low_D.size(); ++c) {
            const double distance = std::hypot(row.low_D[c] - wantedLow, row.high_D[c] - wantedHigh);
            if (distance >= least) continue;
            least = distance;
            const double along = static_cast<double>(c) / static_cast<double>(row.low_D.size() - 1);
            nearest = {row.offsetLow + along * (row.offsetHigh - row.offsetLow), std::max(row.amplitude, small)};
        }
    }
    return checked(solved(polynomials, measure, model.scaled(nearest), wantedLow, wantedHigh));
}

double largestHigh(const ContinuousModel& model, double low, double shift, double slotLength) {
    const double wanted = low - shift;
    const ModelPolynomials polynomials(model);
    const SlotMeasure measure(slotLength);
    const auto made = model.map.empty() ? mapped(model) : std::vector<ContinuousModel::Row>{};
    const auto& map = model.map.empty() ? made : model.map;
    double largest = onRow(map.front(), wanted) ? wanted : -std::numeric_limits<double>::infinity();
    // Drives with this lowest power form a curve that leaves the records' range on the border; `high` grows along it.
    for (const bool right : {false, true}) {
        const auto at = [&](double amplitude) {
            const auto [from, to] = offsetsAt(model, amplitude);
            const SineDrive drive = model.scaled({right ? to : from, amplitude});
            const ModelWave wave = polynomials.at(drive).power;
            return measure(wave, extremes(wave));
        };
        for (std::size_t r = 0; r + 1 < map.size(); ++r) {
            const auto mapLow = [&](const ContinuousModel::Row& row) {
                return (right ? row.low_D.back() : row.low_D.front()) - wanted;
            };
            // The map has extremes; means over slots lie above the lowest by less than this.
            const double slack = slotLength > 0.0 ? 0.5 : 1e-9, one = mapLow(map[r]), other = mapLow(map[r + 1]);
            if (std::min(one, other) > slack || std::max(one, other) < -slack) continue;
            double from = map[r].amplitude, to = map[r + 1].amplitude;
            Extremes e = at(from);
            double offFrom = e.low - wanted, offTo = at(to).low - wanted;
            if (offFrom * offTo > 0.0 || offFrom == offTo) continue;
            // Regula falsi, halving the end that stays (Illinois).
            for (int step = 0; step < 60 && std::abs(e.low - wanted) > 1e-9; ++step) {
                const double middle = (from * offTo - to * offFrom) / (offTo - offFrom);
                e = at(middle);
                const double off = e.low - wanted;
                if (off * offTo < 0.0) {
                    from = to;
                    offFrom = offTo;
                } else {
                    offFrom *= 0.5;
                }
                to = middle;
                offTo = off;
            }
            largest = std::max(largest, e.high);
        }
    }
    return std::isfinite(largest) ? largest + shift : low;
}

}  // namespace ilf
