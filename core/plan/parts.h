// What a plan worked out on the way and the next one can take over: the wave it chose and the schedules it made.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "core/plan/schedule.h"

namespace ilf {

struct PlanParts {
    WaveWish wish;
    WaveChoice choice;
    std::string unshaped;  ///< why a continuous wave stands in for the shaped one that was asked for; empty: none does
    std::vector<std::pair<std::vector<LevelWish>, Schedule>> schedules;  ///< of the chosen wave, by what was asked
};

}  // namespace ilf
