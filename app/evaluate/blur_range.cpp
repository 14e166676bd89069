// The far border by a ring reader's staircase (paper, section 5.3).
#include <algorithm>
#include <cmath>
#include <random>

#include "app/evaluate/evaluate.h"
#include "app/evaluate/observers.h"
#include "app/evaluate/traced_camera.h"
#include "core/base/parallel.h"
#include "core/optics/eye.h"

namespace ilf::app {
namespace {

constexpr Metre kLensToPupil = 20.0_mm;
constexpr Size kReceptors{32, 32};
/// Receptors lie half an arcmin apart in the fovea (about 2.4 um on the retina).
constexpr double kReceptor_arcmin = 0.5;

/// One participant. Assumed: pupils of 3.3 to 4.7 mm, young eyes, noise for which rings of 0.35 to 0.7 arcmin are just
/// read in focus.
struct Participant {
    Metre pupil;
    double noise;
    std::uint64_t seed;
};

/// Whether two thirds of the rings at `distance` are read through a lens at `power`: four of six, as the paper asks.
bool reads(const Participant& who, double distance, double power, int rays, int rings) {
    const Metre pitch = Metre::fromSi(kReceptor_arcmin * kArcmin / 60.0), w = Metre::fromSi(distance);
    const Dioptre lens = Dioptre::fromSi(power);
    const TracedCamera eye = accommodatedEye(who.pupil, kLensToPupil, 10.0_D, pitch, w, lens);
    // A minute of arc from the lens, as the paper has it; what it looks like from the pupil is what is remembered.
    const Metre gap = Metre::fromSi(kArcmin * distance);
    const double gapSeen = distance / (distance + kLensToPupil.si()) / kReceptor_arcmin;
    const auto place = static_cast<std::uint64_t>(std::lround(1e4 * distance + 1e3 * power));
    RingReader reader(kReceptors, gapSeen, who.noise, 1000003 * who.seed + 17 * place);
    std::mt19937_64 shuffled(999983 * who.seed + place);
    int right = 0;
    for (int ring = 0; ring < rings; ++ring) {
        const int direction = 2 * static_cast<int>(shuffled() % 4);
        const auto light = picturedRing(eye, {w, gap, direction}, heldPower(lens), kReceptors, rays);
        right += reader.read(light) == direction ? 1 : 0;
    }
    return 3 * right >= 2 * rings;
}

struct Border {
    double step = 0.0, exact = 0.0;
};

Border borderOf(const Participant& who, double distance, const EvaluateOptions& options) {
    const int rays = options.quick ? 64 : 128;
    Border border;
    // Up the paper's staircase to 2.4 D, until two steps in a row fail: later ones would be luck.
    constexpr int kSteps = 13, kRings = 6;
    int last = 0;
    for (int i = 0; i < kSteps && i <= last + 2; ++i) {
        if (reads(who, distance, 0.2 * i, rays, kRings)) last = i;
    }
    border.step = 0.2 * last;
    // Then, with more rings, halve what lies around that step, the border being in it; its last piece is 0.0125 D long.
    constexpr int kManyRings = 24;
    double low = std::max(0.0, border.step - 0.2), high = border.step + 0.2;
    for (int i = 0; i < 5; ++i) {
        const double middle = 0.5 * (low + high);
        (reads(who, distance, middle, rays, kManyRings) ? low : high) = middle;
    }
    border.exact = 0.5 * (low + high);
    return border;
}

}  // namespace

BlurRange blurRange(const EvaluateOptions& options) {
    BlurRange range;
    range.observers = options.quick ? 2 : 8;
    const double step = options.quick ? 1000.0 : 250.0;
    for (double mm = 500.0; mm <= 2500.0; mm += step)
        range.cases.push_back({mm, {}, {}});
    const int count = static_cast<int>(range.cases.size()) * range.observers;
    std::vector<Border> borders(static_cast<std::size_t>(count));
    parallelFor(count, [&](int i) {
        const int who = i % range.observers;
        const double distance = 1e-3 * range.cases[static_cast<std::size_t>(i / range.observers)].distance_mm;
        const double share = range.observers > 1 ? static_cast<double>(who) / (range.observers - 1) : 0.5;
        const Participant participant{Metre::fromSi(3.3e-3 + 1.4e-3 * share),
                                      0.1 + 0.5 * std::fmod(0.5 + 3 * share, 1.0), static_cast<std::uint64_t>(who + 1)};
        borders[static_cast<std::size_t>(i)] = borderOf(participant, distance, options);
    });
    double n = 0.0, sx = 0.0, sy = 0.0, sxx = 0.0, sxy = 0.0;
    for (std::size_t k = 0; k < range.cases.size(); ++k) {
        std::vector<double> steps, exact;
        for (int who = 0; who < range.observers; ++who) {
            const Border& border =
                borders[k * static_cast<std::size_t>(range.observers) + static_cast<std::size_t>(who)];
            steps.push_back(border.step);
            exact.push_back(border.exact);
        }
        BorderCase& one = range.cases[k];
        one.steps_D = meanSpread(steps);
        one.border_D = meanSpread(exact);
        const double x = 1e3 / one.distance_mm, y = one.border_D.mean;
        n += 1.0;
        sx += x;
        sy += y;
        sxx += x * x;
        sxy += x * y;
    }
    range.slope = (n * sxy - sx * sy) / (n * sxx - sx * sx);
    range.offset_D = (sy - range.slope * sx) / n;
    const double meanOffset = (sy - sx) / n;
    for (const BorderCase& one : range.cases)
        range.worstOff_D = std::max(range.worstOff_D, std::abs(one.border_D.mean - 1e3 / one.distance_mm - meanOffset));
    return range;
}

}  // namespace ilf::app
