// The paper's evaluation (section 5) on the simulated system: what its observers measure in rendered pictures.
#pragma once

#include <string>
#include <vector>

#include "core/base/image.h"
#include "core/base/quantity.h"
#include "core/base/result.h"

namespace ilf::app {

/// Everything below is simulated. `quick`: fewer cases, rays and observers, for tests.
struct EvaluateOptions {
    bool quick = false;
};

/// How the lens gets to a power: held there, swept by an exact sine, or by the wave that the paper's rule chooses from
/// the 2485 recorded on the lens emulator.
struct BlurCase {
    double distance_mm = 0.0, power_D = 0.0;
    double model_px = 0.0;  ///< closed form, lens as aperture stop; not used by any observer
    double fixed_px = 0.0, sine_px = 0.0, wave_px = 0.0;  ///< mean radius of the nine fitted circles
    double middle_px = 0.0;  ///< of the middle one alone, lens held: nothing cuts its light
};
struct MeanSpread {
    double mean = 0.0, spread = 0.0;  ///< spread: standard deviation of a sample
};
MeanSpread meanSpread(const std::vector<double>& values);

struct BlurSizes {
    std::vector<BlurCase> cases;
    /// Swept less fixed radius over all cases with a sweep; `absolute` of its size.
    MeanSpread sine, wave, waveAbsolute;
    double worstModelShare = 0.0;  ///< largest |middle / model - 1| where the model gives more than 15 px
    Image<std::uint8_t> picture;   ///< one of the swept pictures
};
/// Nine dots pictured by a camera behind the lens (24 mm F1.4, 8.4 um pixels, 20 mm behind it, the lens 16 mm wide),
/// lit for 1 ms.
Result<BlurSizes> blurSizes(const EvaluateOptions& options);

struct BorderCase {
    double distance_mm = 0.0;
    /// Of the observers: the largest power of the paper's 0.2 D steps through which more than three of six rings were
    /// read, and the border found by bisection with 24 rings.
    MeanSpread steps_D, border_D;
};
struct BlurRange {
    std::vector<BorderCase> cases;
    int observers = 0;
    double slope = 0.0, offset_D = 0.0;  ///< of border = slope / distance + offset, least squares
    double worstOff_D = 0.0;             ///< from 1 / distance + its mean offset
};
/// Rings of one arcmin read through a lens at rest.
BlurRange blurRange(const EvaluateOptions& options);

struct ObjectSeen {
    std::string name;
    double distance_mm = 0.0;
    bool toBlur = false;
    double detail = 0.0;   ///< share of its fine detail left when it is looked at
    bool blurred = false;  ///< to the observer: less than half
};
struct FourObjects {
    std::string condition;
    double pS_D = 0.0, high_D = 0.0;
    std::vector<ObjectSeen> objects;
    Image<std::uint8_t> picture;  ///< looking at the first sharp object
};
Result<std::vector<FourObjects>> fourObjects(const EvaluateOptions& options);

struct SeamCase {
    std::string texture;
    bool blurredInside = false;  ///< the blurred side lies nearer the optical centre
    double power_D = 0.0;
    double before = 0.0, paper = 0.0, after = 0.0;  ///< Weber contrast; hard masks, the paper's ramps, closed form
    Image<std::uint8_t> beforePicture, paperPicture, afterPicture;
};
/// Two textures, and a white sheet on which nothing but light shows.
Result<std::vector<SeamCase>> seams(const EvaluateOptions& options);

struct Evaluation {
    BlurSizes sizes;
    BlurRange range;
    std::vector<FourObjects> objects;
    std::vector<SeamCase> seams;
};
Result<Evaluation> evaluated(const EvaluateOptions& options);

}  // namespace ilf::app
