#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <numbers>

#include "core/lens/shaped_model.h"
#include "core/lens/shaped_record.h"

namespace ilf {
namespace {

/// Of the largest allowed drive: strong against the record's noise, weak against every lens that stays within its
/// limits of power under full drive.
constexpr double kProbe = 0.05;
/// No harmonic of the last record is weaker than this part of its strongest: each gain is seen.
constexpr double kFloor = 0.05;

/// `amplitudes` with Schroeder's phases (low crest), harmonic k turned by `turn` of a period times k^2 more.
Harmonics multisine(std::span<const double> amplitudes, double turn) {
    Harmonics f{{0.0}};
    const double count = static_cast<double>(amplitudes.size());
    for (std::size_t i = 0; i < amplitudes.size(); ++i) {
        const double k = static_cast<double>(i + 1);
        f.c.push_back(std::polar(amplitudes[i], std::numbers::pi * (2.0 * turn * k * k - k * (k - 1.0) / count)));
    }
    return f;
}

Harmonics scaledAboutMean(Harmonics f, double factor) {
    for (std::size_t k = 1; k < f.c.size(); ++k)
        f.c[k] *= factor;
    return f;
}

/// The same with its peak and rms at most `part` of the limits; the mean gives way last.
Harmonics within(const Harmonics& f, const DriveLimits& limits, double part) {
    Harmonics g = f;
    g.c[0] = std::clamp(g.c[0].real(), -0.5 * part * limits.peak, 0.5 * part * limits.peak);
    g.c[0] = std::clamp(g.c[0].real(), -0.5 * part * limits.rms, 0.5 * part * limits.rms);
    while (peakOf(g) > part * limits.peak || g.rms() > part * limits.rms)
        g = scaledAboutMean(g, 0.9);
    return g;
}

struct Seen {
    Harmonics drive, power;
    double noise_D = 0.0;
};

/// Best linear response: gains in least squares over all records.
void fitGains(LensResponse& response, std::span<const Seen> seen) {
    for (std::size_t k = 1; k < response.gain.size(); ++k) {
        std::complex<double> both = 0.0;
        double square = 0.0;
        for (const Seen& one : seen) {
            both += one.power.c[k] * std::conj(one.drive.c[k]);
            square += std::norm(one.drive.c[k]);
        }
        response.gain[k] = both / square;
    }
}

/// Harmonics that the wave hardly has are raised to kFloor of its strongest, each with a phase of its own.
Harmonics allSeen(Harmonics drive) {
    double strongest = 0.0;
    for (std::size_t k = 1; k < drive.c.size(); ++k)
        strongest = std::max(strongest, std::abs(drive.c[k]));
    for (std::size_t k = 1; k < drive.c.size(); ++k) {
        if (std::abs(drive.c[k]) < kFloor * strongest)
            drive.c[k] = std::polar(kFloor * strongest, static_cast<double>(k * k));
    }
    return drive;
}

}  // namespace

Result<Identification> identifiedFor(const RecordLens& record, Hertz rate, std::span<const Hold> holds, int harmonics,
                                     const DriveLimits& limits) {
    assert(harmonics >= 1);
    if (const auto fine = checkedHolds(holds); !fine) return tl::unexpected(fine.error());
    if (!(limits.peak > 0.0) || !(limits.rms > 0.0))
        return fail(Fault::outOfRange, "The lens has no drive limits above 0; nothing can be played on it.");
    const auto count = static_cast<std::size_t>(harmonics);
    LensResponse response;
    response.rate = rate;
    response.gain.resize(count + 1);
    std::vector<Seen> seen;
    const auto play = [&](const Harmonics& drive) -> Result<void> {
        const auto got = recordedPower(record, drive, rate, harmonics, limits);
        if (!got) return tl::unexpected(got.error());
        response.unit = got->unit;
        seen.push_back({drive, got->power, got->noise_D});
        return {};
    };

    // Two weak records of different means find the lens's rest, its static gain and roughly the others.
    const double strength = kProbe * std::min(limits.peak, limits.rms);
    const std::vector<double> flat(count, strength);
    const Harmonics first = within(multisine(flat, 0.0), limits, kProbe);
    if (const auto done = play(first); !done) return tl::unexpected(done.error());
    Harmonics second = within(multisine(flat, 0.25), limits, kProbe);
    second.c[0] = strength;
    if (const auto done = play(second); !done) return tl::unexpected(done.error());
    response.gain[0] = (seen[1].power.mean() - seen[0].power.mean()) / strength;
    response.bias_D = seen[0].power.mean();
    fitGains(response, seen);
    const double moved = lessConstant(seen[0].power, seen[0].power.mean()).rms();
    if (!(std::abs(response.gain[0]) > 0.0) || moved <= 4.0 * seen[0].noise_D)
        return fail(Fault::device, "The lens did not move when it was driven; check its cable and amplifier.");

    // The third is the wave these gains ask for: a lens that is not linear is identified where it will be used.
    const auto plain = designed(response, holds, harmonics, limits);
    if (!plain) return tl::unexpected(plain.error());
    const Harmonics third = within(allSeen(plain->drive), limits, 1.0);
    if (const auto done = play(third); !done) return tl::unexpected(done.error());
    fitGains(response, seen);
    const double shift = third.mean();
    if (std::abs(shift) > 0.1 * strength) {
        // The static gain is the chord to where the wave will be.
        response.gain[0] = (seen[2].power.mean() - seen[0].power.mean()) / shift;
    }
    response.bias_D = seen[2].power.mean() - response.gain[0].real() * shift;
    return Identification{response, third, seen[2].power};
}

Result<LensResponse> identified(const RecordLens& record, Hertz rate, double middle_D, double swing_D, int harmonics,
                                const DriveLimits& limits) {
    const std::array<double, 2> levels{middle_D - 0.5 * swing_D, middle_D + 0.5 * swing_D};
    auto found = identifiedFor(record, rate, holdsFor(levels, 0.3, 0.0), harmonics, limits);
    if (!found) return tl::unexpected(found.error());
    return found->response;
}

}  // namespace ilf
