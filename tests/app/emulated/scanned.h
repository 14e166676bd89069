// `scan` by the program, and what its map and report must say.
#pragma once

#include "tests/support/run_program.h"

namespace ilf {

/// The map goes to map.yml.gz of the folder.
Ran scanned(const TemporaryDirectory& folder, const std::string& options);

/// Of a run with --json and binning=2.
void checkMap(const TemporaryDirectory& folder, const Ran& ran);

}  // namespace ilf
