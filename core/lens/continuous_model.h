// A lens between its records: each harmonic of its power as a polynomial of the drive's offset and amplitude, inverted.
#pragma once

#include <complex>
#include <span>
#include <vector>

#include "core/lens/record.h"

namespace ilf {

/// P_k(o, a) for u(x) = o + a sin(2 pi x), k = 0..16, total degree 4 or 5 (scheduling 1.4). Odd symmetry in a is built
/// in: P_k(o, -a) is P_k(o, a) delayed by half a period.
struct ContinuousModel {
    Hertz rate = 60.0_Hz;
    DriveUnit unit = DriveUnit::volt;
    int degree = 4;
    double offsetScale = 1.0, amplitudeScale = 1.0;  ///< polynomials are of o / offsetScale, a / amplitudeScale
    double offsetMiddle = 0.0;
    std::vector<std::vector<std::complex<double>>> terms;  ///< [harmonic][term]
    double driveLow = 0.0, driveHigh = 0.0;                ///< drives outside the records' range are not asked of it
    double rmsFit_D = 0.0, largestFit_D = 0.0;             ///< against the records it was fitted to, noise included
    double temperature_C = 30.0;
    Provenance provenance = Provenance::simulated;

    Harmonics power(double offset, double amplitude) const;
};

/// Needs records of family sine of one rate; refuses too few for a polynomial of degree 3 with one sentence.
Result<ContinuousModel> fitted(std::span<const LensRecord> records);

/// The drives to record for a fit: `count` (offset, amplitude) pairs that cover [driveLow, driveHigh] as a
/// space-filling design, the borders included. Deterministic.
struct SineDrive {
    double offset = 0.0, amplitude = 0.0;
};
std::vector<SineDrive> drivesToRecord(double driveLow, double driveHigh, std::size_t count);

/// The drive whose predicted extremes are `low` and `high` to 1e-9 D; none when it lies outside the records' range.
struct Inverted {
    SineDrive drive;
    Harmonics power;  ///< at the model's temperature plus `shift`
};
std::optional<Inverted> inverted(const ContinuousModel& model, double low, double high, double shift);

/// The largest `high` that `inverted` reaches with this `low`, to 1 mD.
double largestHigh(const ContinuousModel& model, double low, double shift);

}  // namespace ilf
