// How strongly an eye feels a profile of light: weighted by its contrast sensitivity.
#pragma once

#include <vector>

namespace ilf {

/// Contrast sensitivity at `cyclesPerDegree`, its peak (about 8 cycles per degree) counted as 1.
/// A(f) = 2.6 (0.0192 + 0.114 f) exp(-(0.114 f)^1.1), Mannos & Sakrison, IEEE Trans. Inf. Theory 20(4), 1974.
double contrastSensitivity(double cyclesPerDegree);

/// Filters differences from even light, sampled every `step_deg`, by contrast sensitivity. Made once for a border.
class SeamWeighting {
public:
    /// `samples`: of one profile.
    SeamWeighting(double step_deg, int samples);
    /// The largest weighted difference along a profile. Beyond its ends it goes on as there: where a profile was cut
    /// short, the cut is no edge.
    double worst(const std::vector<double>& differences) const;

private:
    std::vector<double> kernel_;  ///< for 0, 1, ... samples to either side
};

}  // namespace ilf
