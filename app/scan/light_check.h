// Before a scan: is the room dark enough, and does the camera see this projector and no other screen?
#pragma once

#include <stop_token>
#include <string>
#include <vector>

#include "app/scan/scan.h"

namespace ilf::app {

struct LightCheck {
    AmbientCheck ambient;  ///< with `lit` 0: it did not come to that
    Second exposure;       ///< locked; 0: the camera does not tell
    std::vector<std::string> remarks;
    std::string trouble;  ///< why no scan can work: one sentence; empty: it can, as far as the projector goes
};

/// White, black and a marker. Ends in steady white light, as a scan does, and under the same conditions.
Result<LightCheck> lightChecked(ScanOrder order, const devices::ScanWatch& watch, const std::stop_token& stop);

}  // namespace ilf::app
