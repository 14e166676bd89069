#include "core/lens/continuous_model.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <opencv2/core.hpp>

#include "core/lens/sine_record.h"

namespace ilf {
namespace {

constexpr int kLeastDegree = 3;
/// Tried for ContinuousModel::amplitudeBend.
constexpr double kBends[] = {0.0, 0.5, 0.2, 0.1, 0.05};
/// Amplitudes to record are spaced as for this bend.
constexpr double kRecordedBend = 0.25;

/// A survey is made for its model, but a database may hold waves to the ends of the lens. Polynomials that need not
/// follow those follow the rest better (dirty lens, paper's waves: 0.06 D to 0.006 D), so where this many records stay
/// within what glasses sweep through, the others are left out.
constexpr std::size_t kPlenty = 100;
constexpr double kSwept_D[] = {-5.0, 9.0};
bool swept(const LensRecord& record) {
    const auto [low, high] = std::ranges::minmax(record.power_D);
    return low >= kSwept_D[0] && high <= kSwept_D[1];
}

double bent(double a, double bend) { return bend > 0.0 ? std::asinh(a / bend) / std::asinh(1.0 / bend) : a; }
double unbent(double bentA, double bend) {
    return bend > 0.0 ? bend * std::sinh(bentA * std::asinh(1.0 / bend)) : bentA;
}

double power(double base, int exponent) {
    double value = 1.0;
    for (; exponent > 0; --exponent)
        value *= base;
    return value;
}

/// Records as points of the scaled drives, with what was measured there.
struct Points {
    std::vector<double> offset, amplitude;
    std::vector<Harmonics> power;
    std::size_t size() const { return offset.size(); }
};

/// Harmonics with the same terms are fitted at once.
struct Fit {
    std::vector<std::vector<std::complex<double>>> terms;  ///< [harmonic][term]
    double press = 0.0;  ///< sum over the records of the mean square error of each, predicted from the others
};

/// None when the records do not determine the terms.
std::optional<Fit> fit(const Points& points, int degree, double bend) {
    Fit result;
    result.terms.resize(kRecordHarmonics + 1);
    const int n = static_cast<int>(points.size());
    for (const int first : {0, 1, 2}) {
        std::vector<std::size_t> harmonics;
        for (std::size_t k = static_cast<std::size_t>(first); k <= kRecordHarmonics; k += first == 0 ? 99 : 2)
            harmonics.push_back(k);
        const auto terms = modelTerms(degree, first);
        cv::Mat1d a(n, static_cast<int>(terms.size())), b(n, static_cast<int>(2 * harmonics.size()));
        for (int r = 0; r < n; ++r) {
            const auto row = static_cast<std::size_t>(r);
            for (std::size_t t = 0; t < terms.size(); ++t) {
                a(r, static_cast<int>(t)) =
                    power(points.offset[row], terms[t].i) * power(bent(points.amplitude[row], bend), terms[t].j);
            }
            for (std::size_t h = 0; h < harmonics.size(); ++h) {
                const auto& c = points.power[row].c;
                const std::complex<double> value = harmonics[h] < c.size() ? c[harmonics[h]] : 0.0;
                b(r, static_cast<int>(2 * h)) = value.real();
                b(r, static_cast<int>(2 * h + 1)) = first == 0 ? 0.0 : value.imag();
            }
        }
        cv::Mat1d w, u, vt;
        cv::SVD::compute(a, w, u, vt);
        if (w(w.rows - 1) < 1e-6 * w(0)) return std::nullopt;
        cv::Mat1d scaled(u.t() * b);
        for (int t = 0; t < scaled.rows; ++t)
            scaled.row(t) /= w(t);
        const cv::Mat1d x(vt.t() * scaled), residual(b - a * x);
        for (std::size_t h = 0; h < harmonics.size(); ++h) {
            auto& out = result.terms[harmonics[h]];
            for (int t = 0; t < x.rows; ++t)
                out.emplace_back(x(t, static_cast<int>(2 * h)), x(t, static_cast<int>(2 * h + 1)));
        }
        // Leaving record r out changes its residual by 1 / (1 - h_rr), h the projection onto the terms.
        for (int r = 0; r < n; ++r) {
            const double leverage = u.row(r).dot(u.row(r));
            const double kept = std::max(1.0 - leverage, 1e-6);
            result.press += (first == 0 ? 1.0 : 0.5) * residual.row(r).dot(residual.row(r)) / (kept * kept);
        }
    }
    return result;
}

/// Andrew's monotone chain; points on an edge to within rounding are left out.
std::vector<SineDrive> hull(std::vector<SineDrive> points, double areaScale) {
    std::ranges::sort(points, [](const SineDrive& p, const SineDrive& q) {
        return std::pair(p.offset, p.amplitude) < std::pair(q.offset, q.amplitude);
    });
    const auto area = [](const SineDrive& o, const SineDrive& p, const SineDrive& q) {
        return (p.offset - o.offset) * (q.amplitude - o.amplitude) -
               (p.amplitude - o.amplitude) * (q.offset - o.offset);
    };
    std::vector<SineDrive> chain;
    const auto add = [&](const SineDrive& p, std::size_t least) {
        while (chain.size() > least && area(chain[chain.size() - 2], chain.back(), p) <= 1e-9 * areaScale)
            chain.pop_back();
        chain.push_back(p);
    };
    for (const SineDrive& p : points)
        add(p, 1);
    const std::size_t lower = chain.size();
    for (auto p = points.rbegin() + 1; p != points.rend(); ++p)
        add(*p, lower);
    chain.pop_back();
    return chain;
}

}  // namespace

std::vector<ModelTerm> modelTerms(int degree, int k) {
    std::vector<ModelTerm> terms;
    for (int j = k == 0 ? 0 : 2 - k % 2; j <= degree; j += 2) {
        for (int i = 0; i + j <= degree; ++i)
            terms.push_back({i, j});
    }
    return terms;
}

SineDrive ContinuousModel::scaled(const SineDrive& drive) const {
    return {(drive.offset - offsetMiddle) / offsetScale, bent(drive.amplitude / amplitudeScale, amplitudeBend)};
}
SineDrive ContinuousModel::unscaled(const SineDrive& scaled) const {
    return {offsetMiddle + scaled.offset * offsetScale, amplitudeScale * unbent(scaled.amplitude, amplitudeBend)};
}

Harmonics ContinuousModel::power(double offset, double amplitude) const {
    const SineDrive at = scaled({offset, amplitude});
    Harmonics out;
    out.c.resize(terms.size());
    for (std::size_t k = 0; k < terms.size(); ++k) {
        const auto exponents = modelTerms(degree, static_cast<int>(k));
        for (std::size_t t = 0; t < exponents.size(); ++t)
            out.c[k] +=
                terms[k][t] * (ilf::power(at.offset, exponents[t].i) * ilf::power(at.amplitude, exponents[t].j));
    }
    return out;
}

Result<ContinuousModel> fitted(std::span<const LensRecord> records, double drift_D_per_C) {
    const std::size_t least = 3 * modelTerms(kLeastDegree, 0).size() / 2;
    const auto tooFew = [&](std::size_t count) {
        return fail(Fault::notFound, "A lens model needs at least " + std::to_string(least) + " recorded waves, not " +
                                         std::to_string(count) + ": record some more, 40 are usual.");
    };
    if (records.size() < least) return tooFew(records.size());
    const auto inside = static_cast<std::size_t>(std::ranges::count_if(
        records, [](const LensRecord& record) { return !record.power_D.empty() && swept(record); }));
    ContinuousModel model;
    model.rate = records.front().rate;
    model.unit = records.front().unit;
    model.provenance = records.front().provenance;
    std::vector<SineRecord> sines;
    std::vector<const LensRecord*> used;
    std::vector<SineDrive> drives;
    for (const LensRecord& record : records) {
        auto sine = sineRecord(record, model.rate);
        if (!sine) return tl::unexpected(sine.error());
        // Where a lens with a loop stands still depends on where it came from: no record of what a sine does.
        if (sine->amplitude == 0.0 || (inside >= kPlenty && !swept(record))) continue;
        if (record.unit != model.unit || record.provenance != model.provenance) {
            return fail(Fault::badFile, "Record " + std::to_string(record.id) +
                                            " differs from the first in its drive's unit or in where it comes from: "
                                            "fit each kind by itself.");
        }
        drives.push_back({sine->offset, sine->amplitude});
        drives.push_back({sine->offset, -sine->amplitude});
        sines.push_back(*std::move(sine));
        used.push_back(&record);
    }
    if (sines.size() < least) return tooFew(sines.size());

    const auto byOffset = [](const SineDrive& p, const SineDrive& q) { return p.offset < q.offset; };
    const auto [leftmost, rightmost] = std::ranges::minmax_element(drives, byOffset);
    const double leftOffset = leftmost->offset, rightOffset = rightmost->offset;
    model.offsetMiddle = 0.5 * (leftOffset + rightOffset);
    model.offsetScale = 0.5 * (rightOffset - leftOffset);
    model.amplitudeScale = 0.0;
    for (const SineDrive& drive : drives)
        model.amplitudeScale = std::max(model.amplitudeScale, drive.amplitude);
    const double areaScale = model.offsetScale * model.amplitudeScale;
    if (areaScale > 0.0) model.border = hull(drives, areaScale);

    const Warmth room = warmth(sines);
    model.temperature_C = room.resting_C;
    Points points;
    model.driveLow = std::numeric_limits<double>::infinity();
    model.driveHigh = -model.driveLow;
    for (std::size_t r = 0; r < sines.size(); ++r) {
        const SineRecord& sine = sines[r];
        points.offset.push_back((sine.offset - model.offsetMiddle) / model.offsetScale);
        points.amplitude.push_back(sine.amplitude / model.amplitudeScale);
        points.power.push_back(lessConstant(sine.power, drift_D_per_C * room.warmerThanThat_C[r]));
        model.driveLow = std::min(model.driveLow, sine.offset - sine.amplitude);
        model.driveHigh = std::max(model.driveHigh, sine.offset + sine.amplitude);
    }
    std::optional<Fit> best;
    for (int degree = kLeastDegree; degree <= kLargestModelDegree && areaScale > 0.0; ++degree) {
        if (2 * sines.size() < 3 * modelTerms(degree, 0).size()) break;
        for (const double bend : kBends) {
            auto tried = fit(points, degree, bend);
            if (!tried || (best && tried->press >= best->press)) continue;
            best = std::move(tried);
            model.degree = degree;
            model.amplitudeBend = bend;
        }
    }
    if (!best || model.border.size() < 3) {
        return fail(Fault::badFile, "The " + std::to_string(records.size()) +
                                        " recorded waves do not differ enough in offset and amplitude to fit a lens "
                                        "model: record several amplitudes at several offsets.");
    }
    model.terms = std::move(best->terms);

    double squares = 0.0;
    std::size_t count = 0;
    for (std::size_t r = 0; r < sines.size(); ++r) {
        const Harmonics predicted = model.power(sines[r].offset, sines[r].amplitude);
        const double warmer = drift_D_per_C * room.warmerThanThat_C[r];
        const auto& samples = used[r]->power_D;
        for (std::size_t i = 0; i < samples.size(); ++i) {
            const double x = static_cast<double>(i) / static_cast<double>(samples.size()) + sines[r].late;
            const double off = std::abs(samples[i] - warmer - predicted.at(x));
            squares += off * off;
            model.largestFit_D = std::max(model.largestFit_D, off);
        }
        count += samples.size();
    }
    model.rmsFit_D = std::sqrt(squares / static_cast<double>(count));
    model.map = mapped(model);
    return model;
}

std::vector<SineDrive> drivesToRecord(double driveLow, double driveHigh, std::size_t count, double largestAmplitude) {
    assert(count >= 9 && driveLow < driveHigh);
    const double middle = 0.5 * (driveLow + driveHigh), half = 0.5 * (driveHigh - driveLow);
    if (largestAmplitude <= 0.0) largestAmplitude = half;
    // A triangle's worth of points: r rows of amplitude hold 1 + 2 + ... + r; what is over goes to the widest rows.
    std::size_t rows = 1;
    while ((rows + 1) * (rows + 2) / 2 <= count)
        ++rows;
    std::size_t over = count - rows * (rows + 1) / 2;
    std::vector<SineDrive> drives;
    for (std::size_t row = 0; row < rows; ++row) {
        // Chebyshev's spacing, in amplitude that of the diamond which the triangle and its mirror image make.
        const double down = static_cast<double>(rows - 1 - row) / static_cast<double>(2 * rows - 1);
        const double tall = unbent(std::cos(std::numbers::pi * down), kRecordedBend);
        const double wide = half * (1.0 - tall);
        std::size_t points = rows - row;
        if (points > 1) {
            const std::size_t more = (over + rows - row - 2) / (rows - row - 1);
            points += std::min(more, over);
            over -= std::min(more, over);
        }
        for (std::size_t p = 0; p < points; ++p) {
            const double along =
                points == 1 ? 0.0
                            : -std::cos(std::numbers::pi * static_cast<double>(p) / static_cast<double>(points - 1));
            drives.push_back({middle + wide * along, largestAmplitude * tall});
        }
    }
    return drives;
}

}  // namespace ilf
