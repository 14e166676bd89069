// Seams along whole borders: how strongly light differs from even there, for each eye, nominal and under errors.
#pragma once

#include <algorithm>
#include <array>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "core/compile/compile.h"
#include "core/perceived/seam_robustness.h"

namespace ilf {

/// From here on a seam counts as faint, and as visible. 1 % is the Weber fraction of the eye at its best, with a sharp
/// edge in bright light; 4 % of raw contrast over a feather some millimetres wide is 1 % once weighted by the eye's
/// contrast sensitivity (scheduling 4.3).
inline constexpr double kFaintSeam = 0.01;
inline constexpr double kVisibleSeam = 0.04;
enum class SeamSight { hidden, faint, visible };
SeamSight sight(double weber);

/// The largest |I - 1| somewhere along a border, 1 being the light away from borders.
struct SeamContrast {
    double weber = 0.0;
    double weighted = 0.0;  ///< the largest after weighting by contrast sensitivity, its peak counted as 1
    Point<CameraFrame> at;  ///< where on the painted border the profile with `weber` was taken
    bool gap = false;       ///< darker there; false: brighter
    bool operator==(const SeamContrast&) const = default;
};
using BothEyes = std::array<SeamContrast, 2>;  ///< left, right

/// One place of a border, as it is blended now.
struct BorderPoint {
    Point<CameraFrame> at;
    std::array<double, 2> weber{};  ///< left, right eye
    double worst() const { return weber[0] > weber[1] ? weber[0] : weber[1]; }
};

/// What one error does to the worst place of a border, all else being as planned.
struct SeamUnderError {
    SeamErrorKind kind = SeamErrorKind::pupil;
    std::string what;    ///< "pupil 3 or 5 mm"
    BothEyes eyes;       ///< of both signs the worse
    bool counts = true;  ///< in `combined`; larger ones of the same kind are only shown
};

struct BorderSeam {
    RegionId blurred, other;
    bool depthStep = false;              ///< one surface stands before the other along most of it: not blended
    Metre length;                        ///< across the surface, of what was looked at
    double sampled = 1.0;                ///< share of the border that was looked at
    int profiles = 0;                    ///< lines across it that were worked out
    std::vector<BorderPoint> points;     ///< where they cross it
    std::array<BothEyes, 4> blendings;   ///< by Blending; those that were not asked for are 0
    BothEyes now;                        ///< as compiled
    std::vector<SeamUnderError> errors;  ///< as compiled
    std::array<double, 2> combined{};    ///< `now` and the root of the squares of what counted errors add
    Metre apart;                         ///< the two eyes see this border that far apart, at most
    HidingWidth hiding;
    std::string says;  ///< what two lens axes leave, in one sentence

    double worst() const { return std::max(now[0].weber, now[1].weber); }
};

struct SeamQuestion {
    bool allBlendings = true;  ///< else only as compiled
    bool underErrors = true;
    SeamErrors errors;
    int mostPatches = 400;  ///< stretches looked at, over all borders; beyond, borders are thinned out
};

/// Every border between a region whose light is displaced (blurred, or neutral and so partly lit while the lens is away
/// from rest) and what is lit otherwise; worst first. Even white surfaces, seen by an eye that looks at the surface in
/// question, on lines across the border every few pixels (at most six in a stretch as long as the seam reaches), each
/// gathered over the eye's blur discs; past depth steps on patches with both surfaces (`view::addLight`), without
/// errors. A line ends where a third surface or light begins. Other blendings are compiled anew. Nothing without a
/// sweep, and nothing once `cancelled` says true.
std::vector<BorderSeam> borderSeams(const Compiled& compiled, const SeamQuestion& question = {},
                                    const std::function<bool()>& cancelled = {});

}  // namespace ilf
