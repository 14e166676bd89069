// One period as a lens model predicts it, laid out for the thousands of them that an inversion asks for.
#pragma once

#include <array>
#include <cstddef>

#include "core/lens/continuous_model.h"
#include "core/lens/sine_record.h"

namespace ilf {

inline constexpr std::size_t kModelHarmonics = kRecordHarmonics + 1;

/// Real and imaginary parts apart, so that loops over them vectorise.
struct ModelWave {
    std::array<double, kModelHarmonics> re{}, im{};

    double at(double x) const;
};

/// As of Harmonics, to rounding; without allocations.
Extremes extremes(const ModelWave& wave);

/// A wave at a drive, and how each harmonic changes with offset and amplitude.
struct BentWave {
    ModelWave power, byOffset, byAmplitude;
};

/// The polynomials of a model, which must outlive it.
class ModelPolynomials {
public:
    explicit ModelPolynomials(const ContinuousModel& model);
    /// At a drive in the model's scaled units.
    BentWave at(const SineDrive& scaled) const;

private:
    static constexpr std::size_t kMostTerms = 32, kMostDegree = kLargestModelDegree;
    const ContinuousModel& model_;
    std::array<std::array<ModelTerm, kMostTerms>, 3> terms_{};  ///< of the mean, of odd and of even harmonics
    std::array<std::size_t, 3> count_{};
};

/// What an inversion makes `low` and `high`: the extremes, or the means over slots centred on them.
class SlotMeasure {
public:
    /// In sweeps; 0: the extremes.
    explicit SlotMeasure(double slotLength);
    /// The mean over a slot about each x, as a wave.
    ModelWave operator()(const ModelWave& wave) const;
    /// `e` of `wave`, the extremes replaced by what is measured there.
    Extremes operator()(const ModelWave& wave, Extremes e) const;

private:
    std::array<double, kModelHarmonics> kept_;
};

}  // namespace ilf
