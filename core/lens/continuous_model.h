// A lens between its records: each harmonic of its power as a polynomial of the drive's offset and amplitude, inverted.
#pragma once

#include <complex>
#include <optional>
#include <span>
#include <vector>

#include "core/lens/record.h"

namespace ilf {

/// u(x) = offset + amplitude sin(2 pi x)
struct SineDrive {
    double offset = 0.0, amplitude = 0.0;
};

/// P_k(o, a) for u(x) = o + a sin(2 pi x), k = 0..16, of a total degree from 3 to 8 (scheduling 1.4). Symmetry in a is
/// built in: P_k(o, -a) is P_k(o, a) delayed by half a period, so harmonic k has only powers of a that are odd or even
/// as k is, and nothing but the mean is left at a = 0.
struct ContinuousModel {
    Hertz rate = 60.0_Hz;
    DriveUnit unit = DriveUnit::volt;
    int degree = 4;
    /// Polynomials are of (o - middle) / scale and of asinh(a / (scale bend)) / asinh(1 / bend), or a / scale where
    /// bend is 0: a lens with a loop changes more between small amplitudes than between large ones.
    double offsetMiddle = 0.0, offsetScale = 1.0, amplitudeScale = 1.0, amplitudeBend = 0.0;
    std::vector<std::vector<std::complex<double>>> terms;  ///< [harmonic][term], terms as `modelTerms` lists them
    double driveLow = 0.0, driveHigh = 0.0;                ///< the least and the largest drive of the records
    /// The records' drives and their mirror images (o, -a) lie inside this convex polygon, counterclockwise. Drives
    /// outside it are not asked of the model.
    std::vector<SineDrive> border;
    double rmsFit_D = 0.0, largestFit_D = 0.0;  ///< against the records it was fitted to, noise included
    /// Of the lens at rest while it was recorded. What a drive itself warms the coil by is part of the model.
    double temperature_C = 30.0;
    Provenance provenance = Provenance::simulated;

    /// Where inversions start: the extremes at the nodes of a coarse grid inside the border, row by row of amplitude.
    struct Row {
        double amplitude = 0.0, offsetLow = 0.0, offsetHigh = 0.0;
        std::vector<double> low_D, high_D;  ///< offsets equally spaced from offsetLow to offsetHigh
    };
    std::vector<Row> map;  ///< what `mapped` gives

    Harmonics power(double offset, double amplitude) const;
    /// What the polynomials are of, and back.
    SineDrive scaled(const SineDrive& drive) const;
    SineDrive unscaled(const SineDrive& scaled) const;
};

inline constexpr int kLargestModelDegree = 8;

/// Exponents of one term o^i a^j.
struct ModelTerm {
    int i = 0, j = 0;
};
/// The terms of harmonic `k`, in the order of ContinuousModel::terms.
std::vector<ModelTerm> modelTerms(int degree, int k);

/// Needs records of family sine of one rate, about 40; refuses too few for a polynomial of degree 3 with one sentence.
/// Degree and bend are those with the least error in predicting each record from the others (PRESS). Records
/// of a lens that stands still are left out, and where there are plenty those beyond -5 and 9 D. Where the room grew
/// warmer while recording, powers are levelled by `drift_D_per_C`.
Result<ContinuousModel> fitted(std::span<const LensRecord> records, double drift_D_per_C = 0.033);
/// The grid of a model's `map`, from everything else in it.
std::vector<ContinuousModel::Row> mapped(const ContinuousModel& model);

/// The drives to record for a fit: `count` (at least 9) pairs with `driveLow` <= offset +- amplitude <= `driveHigh`,
/// the borders included, nearer to each other there, as polynomials need it, and none without amplitude: where a lens
/// with a loop stands still depends on where it came from. `largestAmplitude` stretches or flattens that triangle where
/// a lens answers a sine more or less than a steady drive; 0: half of the range. Deterministic.
std::vector<SineDrive> drivesToRecord(double driveLow, double driveHigh, std::size_t count,
                                      double largestAmplitude = 0.0);

/// The drive of least amplitude whose predicted extremes are `low` and `high` to 1e-9 D; none when it lies outside the
/// records' range or `low` > `high`. With a `slotLength` above 0 (in sweeps) it is the means over slots centred on the
/// extremes that are `low` and `high`: the sweep goes a little farther, and slots lit there err by a third less.
struct Inverted {
    SineDrive drive;
    Harmonics power;    ///< at the model's temperature plus `shift`
    Extremes extremes;  ///< of `power`
};
std::optional<Inverted> inverted(const ContinuousModel& model, double low, double high, double shift,
                                 double slotLength = 0.0);

/// The largest `high` that `inverted` reaches with this `low`, to 1 mD; `low` itself where not even that is reached.
double largestHigh(const ContinuousModel& model, double low, double shift, double slotLength = 0.0);

}  // namespace ilf
