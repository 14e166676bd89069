// What was received, as a plan and a program that the view engine takes: what the wearer really sees.
#pragma once

#include "app/headless/received_light.h"
#include "core/compile/compile.h"

namespace ilf::app {

struct ReceivedShow {
    Plan plan;
    Program program;
};

/// Each exposure received becomes a level of its own, lit as long as it was, while the lens of `eye` runs through the
/// powers received; where surfaces are, what they are and what the eye attends stays as planned. The wave is a Fourier
/// series fitted to the received powers. Refuses light of another raster than the program's, or no light at all.
Result<ReceivedShow> receivedShow(const Compiled& intended, const ReceivedSweep& sweep, Eye eye);

}  // namespace ilf::app
