#include "core/lens/shaped_wave.h"

#include <algorithm>

#include "core/lens/shaped_model.h"
#include "core/lens/shaped_record.h"

namespace ilf {
namespace {

/// Of the way to what the last record asks for (scheduling 3.4). A lens that is not linear answers a correction with up
/// to half as much again as predicted; a full step would then swing about the aim.
constexpr double kLearningGain = 0.7;

Harmonics between(const Harmonics& from, const Harmonics& to, double part) {
    Harmonics f = from;
    for (std::size_t k = 0; k < f.c.size(); ++k)
        f.c[k] += part * (to.c[k] - from.c[k]);
    return f;
}

Harmonics difference(const Harmonics& a, const Harmonics& b) {
    Harmonics f = a;
    for (std::size_t k = 0; k < f.c.size() && k < b.c.size(); ++k)
        f.c[k] -= b.c[k];
    return f;
}

}  // namespace

Result<ShapedWave> learnt(const RecordLens& record, Hertz rate, std::span<const Hold> holds, int harmonics,
                          const DriveLimits& limits, int iterations) {
    const auto found = identifiedFor(record, rate, holds, harmonics, limits);
    if (!found) return tl::unexpected(found.error());
    PowerModel model = modelOf(found->response, static_cast<std::size_t>(harmonics));
    moveTo(model, found->drive, found->power);
    auto design = designed(model, holds, limits);
    if (!design) return tl::unexpected(design.error());

    ShapedWave best;
    Harmonics drive = design->drive, driveBefore = found->drive, powerBefore = found->power;
    for (int play = 0;; ++play) {
        const auto got = recordedPower(record, drive, rate, harmonics, limits);
        if (!got) return tl::unexpected(got.error());
        const double error = largestErrorIn(holds, got->power);
        const bool better = best.errors_D.empty() || error < best.largestError_D;
        best.errors_D.push_back(error);
        if (!better) break;
        best.drive = drive;
        best.power = got->power;
        best.largestError_D = error;
        best.temperature_C = got->temperature_C;
        best.provenance = got->provenance;
        best.unit = got->unit;
        if (play == iterations) break;

        // What the model leaves unexplained, other harmonics included, stays as it is for a small change of drive: the
        // design made again about the record is the best that is left to reach.
        correct(model, difference(drive, driveBefore), difference(got->power, powerBefore), got->noise_D);
        moveTo(model, drive, got->power);
        driveBefore = drive;
        powerBefore = got->power;
        design = designed(model, holds, limits);
        if (!design) break;
        drive = between(drive, design->drive, kLearningGain);
    }
    best.rate = rate;
    best.holds.assign(holds.begin(), holds.end());
    return best;
}

}  // namespace ilf
