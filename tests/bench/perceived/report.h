// The figures asked for beside what was measured, as text for the README.
#pragma once

#include "tests/bench/perceived/row.h"

namespace ilf::bench {

/// Markdown: figures and whether they are met, then each scene's full frames beside the baselines.
std::string report(const Table& table, double loadBefore);

}  // namespace ilf::bench
