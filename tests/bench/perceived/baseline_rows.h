// What somebody would write for a whole view with a library at hand, on the same scenes.
#pragma once

#include "tests/bench/perceived/calibration.h"
#include "tests/bench/perceived/scenes.h"
#include "tests/bench/perceived/truth.h"

namespace ilf::bench {

/// Layer by layer with each of `libraryBlurs` (what a nearer one hides by the product of blurred coverage), and one
/// gather by each pixel's own radius without layers. On `threads` threads where the library can.
void addBaselineRows(Table& table, const BenchScene& scene, const Truth* truth, int threads);

}  // namespace ilf::bench
