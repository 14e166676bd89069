// Blur circles of dots: fixed lens against swept lens (paper, section 5.2).
#include <algorithm>
#include <cmath>

#include "app/evaluate/evaluate.h"
#include "app/evaluate/observers.h"
#include "app/evaluate/traced_camera.h"
#include "app/lens/record_lens.h"
#include "core/base/parallel.h"
#include "core/lens/wave_table.h"
#include "core/optics/aperture.h"

namespace ilf::app {
namespace {

constexpr Hertz kRate = 60.0_Hz;
constexpr Second kExposure = 1.0_ms;
constexpr Metre kLensToCamera = 20.0_mm, kLensAperture = 16.0_mm, kFocalLength = 24.0_mm, kPitch = 8.4_um;
constexpr double kFNumber = 1.4;
constexpr int kMoments = 16;

/// A sweep from 0 D to `power` and the moment whose light shows `power`.
struct Swept {
    Harmonics power;
    double at = 0.0;  ///< in sweeps
};

Swept sine(double power) { return {Harmonics{{{0.5 * power, 0.0}, {-0.5 * power, 0.0}}}, 0.5}; }

/// Where the recorded power comes nearest to the target: at it, or at the extremes.
Swept looked(const Harmonics& power, double target) {
    Swept swept{power, 0.0};
    double least = HUGE_VAL;
    constexpr int kPhases = 4000;
    for (int i = 0; i < kPhases; ++i) {
        const double x = static_cast<double>(i) / kPhases, off = std::abs(power.at(x) - target);
        if (off >= least) continue;
        least = off;
        swept.at = x;
    }
    return swept;
}

/// The dots look alike from everywhere (as a projector beside the camera throws them): 42.5 mm apart at 500 mm, 0.7
/// mm wide, about one pixel of the paper's projector. Assumed.
DotChart chartAt(Metre distance) {
    const double size = (distance + kLensToCamera) / (0.5_m + kLensToCamera);
    return {distance, size * 42.5_mm, size * 0.35_mm};
}

struct Bench {
    Size sensor{760, 760};
    int rays = 200000;
};

Image<std::uint8_t> pictured(const Bench& bench, Metre distance, std::span<const double> powers, std::uint64_t seed) {
    const TracedCamera camera = focusedCamera(kFocalLength, kFNumber, kPitch, distance, kLensToCamera, kLensAperture);
    return exposed(picturedDots(camera, chartAt(distance), powers, bench.sensor, bench.rays), seed);
}

/// Of the circles found: all of them, and the one in the middle.
struct Radii {
    double mean = 0.0, middle = 0.0;
};
Radii radii(const Image<std::uint8_t>& picture) {
    const auto circles = blurCircles(picture);
    if (circles.empty()) return {};
    Radii out;
    for (const FittedCircle& circle : circles)
        out.mean += circle.radius / static_cast<double>(circles.size());
    out.middle = circles.front().radius;
    return out;
}

double modelRadius(Metre distance, Dioptre power) {
    Wearer wearer;
    wearer.camera = CameraObserver{kFocalLength, kFNumber, distance, kPitch};
    wearer.lensToPupil = kLensToCamera;
    wearer.lensAperture = 1.0_m;  // the camera's own pupil; the lens stops the beam below
    return 0.5 * blurDiameterStopped(eyeOptics(wearer), kLensAperture, distance, power).in(kPitch);
}

void summarise(BlurSizes& sizes) {
    std::vector<double> bySine, byWave, size;
    for (const BlurCase& one : sizes.cases) {
        if (one.model_px > 15.0)
            sizes.worstModelShare = std::max(sizes.worstModelShare, std::abs(one.middle_px / one.model_px - 1.0));
        if (one.power_D == 0.0) continue;
        bySine.push_back(one.sine_px - one.fixed_px);
        byWave.push_back(one.wave_px - one.fixed_px);
        size.push_back(std::abs(byWave.back()));
    }
    sizes.sine = meanSpread(bySine);
    sizes.wave = meanSpread(byWave);
    sizes.waveAbsolute = meanSpread(size);
}

}  // namespace

Result<BlurSizes> blurSizes(const EvaluateOptions& options) {
    const Bench bench = options.quick ? Bench{{560, 560}, 100000} : Bench{};
    const std::vector<double> distances =
        options.quick ? std::vector<double>{500, 900} : std::vector<double>{500, 600, 700, 800, 900};
    const double step = options.quick ? 1.0 : 0.5, highest = options.quick ? 1.0 : 5.0;

    const double slot = kExposure * kRate;
    const auto records = paperWaves({}, kRate);
    if (!records) return tl::unexpected(records.error());
    const auto table = waveTable(*records, 0.0, slot);
    if (!table) return tl::unexpected(table.error());

    BlurSizes sizes;
    std::vector<Swept> waves;
    for (const double distance : distances) {
        for (double power = 0.0; power <= highest; power += step) {
            const auto chosen = narrowestCovering(*table, 0.0, power, 0.0, slot);
            if (!chosen) {
                return fail(Fault::outOfRange, "No recorded wave covers 0 to " + std::to_string(power) +
                                                   " D; the lens emulator's drive does not reach that far.");
            }
            sizes.cases.push_back({distance, power, modelRadius(Metre::fromSi(1e-3 * distance), Dioptre::fromSi(power)),
                                   0.0, 0.0, 0.0, 0.0});
            waves.push_back(looked(table->waves[*chosen].power, power));
        }
    }
    std::vector<Image<std::uint8_t>> shown(sizes.cases.size());
    parallelFor(static_cast<int>(sizes.cases.size()), [&](int i) {
        const auto k = static_cast<std::size_t>(i);
        BlurCase& one = sizes.cases[k];
        const Metre distance = Metre::fromSi(1e-3 * one.distance_mm);
        const auto seed = static_cast<std::uint64_t>(3 * i);
        const Radii fixed = radii(pictured(bench, distance, heldPower(Dioptre::fromSi(one.power_D)), seed + 1));
        one.fixed_px = fixed.mean;
        one.middle_px = fixed.middle;
        // Not swept at 0 D, as in the paper.
        if (one.power_D == 0.0) {
            one.sine_px = one.wave_px = one.fixed_px;
            return;
        }
        const Swept exact = sine(one.power_D);
        one.sine_px =
            radii(pictured(bench, distance, sweptPowers(exact.power, exact.at, slot, kMoments), seed + 2)).mean;
        const Swept& wave = waves[k];
        shown[k] = pictured(bench, distance, sweptPowers(wave.power, wave.at, slot, kMoments), seed + 3);
        one.wave_px = radii(shown[k]).mean;
    });
    summarise(sizes);
    sizes.picture = shown[options.quick ? 1 : 4];  // 500 mm, 1 D or 2 D
    return sizes;
}

}  // namespace ilf::app
