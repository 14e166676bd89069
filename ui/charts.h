// What the three charts show, as plain records: computed first, drawn later.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/perceived/seam_profile.h"
#include "core/plan/plan.h"

namespace ilf::ui {

struct ChartPoint {
    double x = 0.0, y = 0.0;
    bool operator==(const ChartPoint&) const = default;
};
struct ChartRange {
    double low = 0.0, high = 1.0;
    bool operator==(const ChartRange&) const = default;
    double at(double share) const { return low + (high - low) * share; }
    double shareOf(double value) const { return high > low ? (value - low) / (high - low) : 0.5; }
};

/// "When is what lit, and how wrong is the power there?" One sweep: milliseconds against dioptres.
struct SweepChart {
    ChartRange time_ms, power_D;
    std::vector<ChartPoint> curve;  ///< lens power
    struct Bar {
        int slot = 0;
        double start_ms = 0.0, end_ms = 0.0;
        double power_D = 0.0;           ///< mean while lit
        std::optional<LevelKind> kind;  ///< none: dark
        double error_D = 0.0;           ///< from its level
    };
    std::vector<Bar> bars;
    struct Line {
        LevelKind kind = LevelKind::focus;
        double power_D = 0.0, rmsError_D = 0.0;
    };
    std::vector<Line> levels;
};
SweepChart sweepChart(const Plan& plan);

/// "Who drives the sweep, and what would happen if I moved it?" Distance against lens power: above the far border an
/// object is blurred whatever the eye does, between the borders it can be seen sharp.
struct BlurRangeChart {
    ChartRange distance_m;  ///< drawn logarithmically
    ChartRange power_D;
    std::vector<ChartPoint> farBorder, nearBorder;  ///< metres, dioptres
    struct Object {
        RegionId id;
        std::string name;
        Look look = Look::focus;
        double nearest_m = 1.0, farthest_m = 1.0;
        double power_D = 0.0;  ///< at which it is lit; neutral: the focus power
        std::optional<double> pMin_D;
        bool drives = false;
    };
    std::vector<Object> objects;
    std::optional<double> pS_D;
    double top_D = 0.0;  ///< end of the sweep
};
BlurRangeChart blurRangeChart(const Plan& plan, const Wearer& wearer);

/// "Will anybody see the border?" Millimetres across the border against light, 1 = a region's own light.
struct SeamChart {
    ChartRange across_mm, light;
    std::vector<ChartPoint> leftBefore, leftAfter, rightBefore, rightAfter;
    double worstBefore = 0.0, worstAfter = 0.0;  ///< of both eyes
};
SeamChart seamChart(const SeamProfile& profile);

/// Round steps of 1, 2 or 5 times a power of ten that give at most `most` ticks over the range.
std::vector<double> ticks(ChartRange range, int most);
/// The value of a curve at `x` by linear interpolation; nothing outside it.
std::optional<double> valueAt(const std::vector<ChartPoint>& curve, double x);

}  // namespace ilf::ui
