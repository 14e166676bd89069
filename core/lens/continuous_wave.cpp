#include "core/lens/continuous_wave.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

namespace ilf {
namespace {

constexpr double kTwoPi = 2.0 * std::numbers::pi;
/// Enough that the lowest sample lies beside the lowest extreme: eight for each period of the highest harmonic.
constexpr std::size_t kSamples = 128;

struct Turns {
    std::array<std::array<double, kSamples>, kModelHarmonics> cosine, sine;
    Turns() {
        for (std::size_t k = 0; k < kModelHarmonics; ++k) {
            for (std::size_t i = 0; i < kSamples; ++i) {
                const double x = kTwoPi * static_cast<double>(k * i % kSamples) / double(kSamples);
                cosine[k][i] = std::cos(x);
                sine[k][i] = std::sin(x);
            }
        }
    }
};

/// Newton on the slope, within one sample of `x`.
double refined(const ModelWave& wave, double x) {
    const double from = x - 1.0 / double(kSamples), to = x + 1.0 / double(kSamples);
    for (int step = 0; step < 6; ++step) {
        const double c = std::cos(kTwoPi * x), s = std::sin(kTwoPi * x);
        double zr = 1.0, zi = 0.0, slope = 0.0, curvature = 0.0;
        for (std::size_t k = 1; k < kModelHarmonics; ++k) {
            const double turned = zr * c - zi * s;
            zi = zr * s + zi * c;
            zr = turned;
            const double w = kTwoPi * static_cast<double>(k);
            slope -= w * (wave.re[k] * zi + wave.im[k] * zr);
            curvature -= w * w * (wave.re[k] * zr - wave.im[k] * zi);
        }
        if (curvature == 0.0) break;
        const double next = std::clamp(x - slope / curvature, from, to);
        if (std::abs(next - x) < 1e-13) return next;
        x = next;
    }
    return x;
}

double wrapped(double x) { return x - std::floor(x); }

}  // namespace

double ModelWave::at(double x) const {
    const double c = std::cos(kTwoPi * x), s = std::sin(kTwoPi * x);
    double zr = 1.0, zi = 0.0, sum = re[0];
    for (std::size_t k = 1; k < kModelHarmonics; ++k) {
        const double turned = zr * c - zi * s;
        zi = zr * s + zi * c;
        zr = turned;
        sum += re[k] * zr - im[k] * zi;
    }
    return sum;
}

Extremes extremes(const ModelWave& wave) {
    static const Turns turns;
    std::array<double, kSamples> samples;
    samples.fill(wave.re[0]);
    for (std::size_t k = 1; k < kModelHarmonics; ++k) {
        for (std::size_t i = 0; i < kSamples; ++i)
            samples[i] += wave.re[k] * turns.cosine[k][i] - wave.im[k] * turns.sine[k][i];
    }
    const auto [low, high] = std::ranges::minmax_element(samples);
    Extremes e;
    e.atLow = wrapped(refined(wave, static_cast<double>(low - samples.begin()) / double(kSamples)));
    e.atHigh = wrapped(refined(wave, static_cast<double>(high - samples.begin()) / double(kSamples)));
    e.low = wave.at(e.atLow);
    e.high = wave.at(e.atHigh);
    return e;
}

ModelPolynomials::ModelPolynomials(const ContinuousModel& model) : model_(model) {
    assert(model.degree <= kLargestModelDegree);
    for (std::size_t kind = 0; kind < 3; ++kind) {
        for (const ModelTerm& term : modelTerms(model.degree, static_cast<int>(kind)))
            terms_[kind][count_[kind]++] = term;
    }
}

BentWave ModelPolynomials::at(const SineDrive& scaled) const {
    std::array<double, kMostDegree + 1> op{1.0}, ap{1.0};
    for (std::size_t i = 1; i <= kMostDegree; ++i) {
        op[i] = op[i - 1] * scaled.offset;
        ap[i] = ap[i - 1] * scaled.amplitude;
    }
    BentWave wave;
    for (std::size_t kind = 0; kind < 3; ++kind) {
        std::array<double, kMostTerms> value, byO, byA;
        for (std::size_t t = 0; t < count_[kind]; ++t) {
            const auto i = static_cast<std::size_t>(terms_[kind][t].i), j = static_cast<std::size_t>(terms_[kind][t].j);
            value[t] = op[i] * ap[j];
            byO[t] = i == 0 ? 0.0 : static_cast<double>(i) * op[i - 1] * ap[j];
            byA[t] = j == 0 ? 0.0 : static_cast<double>(j) * op[i] * ap[j - 1];
        }
        for (std::size_t k = kind; k < std::min(kModelHarmonics, model_.terms.size());
             k += kind == 0 ? kModelHarmonics : 2) {
            for (std::size_t t = 0; t < count_[kind]; ++t) {
                const double re = model_.terms[k][t].real(), im = model_.terms[k][t].imag();
                wave.power.re[k] += re * value[t];
                wave.power.im[k] += im * value[t];
                wave.byOffset.re[k] += re * byO[t];
                wave.byOffset.im[k] += im * byO[t];
                wave.byAmplitude.re[k] += re * byA[t];
                wave.byAmplitude.im[k] += im * byA[t];
            }
        }
    }
    return wave;
}

SlotMeasure::SlotMeasure(double slotLength) {
    kept_.fill(1.0);
    for (std::size_t k = 1; k < kModelHarmonics && slotLength > 0.0; ++k) {
        const double half = std::numbers::pi * static_cast<double>(k) * slotLength;
        kept_[k] = std::sin(half) / half;
    }
}

ModelWave SlotMeasure::operator()(const ModelWave& wave) const {
    ModelWave out;
    for (std::size_t k = 0; k < kModelHarmonics; ++k) {
        out.re[k] = wave.re[k] * kept_[k];
        out.im[k] = wave.im[k] * kept_[k];
    }
    return out;
}

Extremes SlotMeasure::operator()(const ModelWave& wave, Extremes e) const {
    const ModelWave mean = (*this)(wave);
    e.low = mean.at(e.atLow);
    e.high = mean.at(e.atHigh);
    return e;
}

}  // namespace ilf
