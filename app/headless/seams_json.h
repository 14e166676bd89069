// What `seams` prints: borders as text or JSON.
#pragma once

#include <iosfwd>
#include <optional>
#include <vector>

#include "core/perceived/seam_border.h"
#include "core/perceived/seam_motion.h"

namespace ilf::app {

/// What a border's motion leaves at one speed, and from which speeds on it shows.
struct BorderMotion {
    double speed_mm_s = 0.0;
    double heldPursued = 0.0, heldPassing = 0.0, ownPursued = 0.0, ownPassing = 0.0;  ///< Weber
    std::optional<double> heldShows_mm_s, ownShows_mm_s;  ///< of the worse way of watching; none: not up to 10 m/s
    double feather_mm = 0.0;                              ///< 2 v T
};

struct SeamsReport {
    const Compiled& compiled;
    std::vector<BorderSeam> seams;
    std::vector<BorderMotion> motions;  ///< one for each seam, or none
    double took_ms = 0.0;
};
void printSeams(std::ostream& out, const SeamsReport& report);
void printSeamsJson(std::ostream& out, const SeamsReport& report);

}  // namespace ilf::app
