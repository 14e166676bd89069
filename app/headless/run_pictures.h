// The pictures of a headless run: scene, overlay, views and slots, as intended and as received.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "app/headless/received_light.h"
#include "core/compile/compile.h"

namespace ilf::app {

struct WrittenPictures {
    std::vector<std::string> names;
};

/// Every view and every slot's image, as PNG; with `sweep` also what was received of them, the view of each eye
/// through the same engine. `views` gets each perceived one's counters, and for a received one its PSNR against the
/// intended.
Result<WrittenPictures> writePictures(const Compiled& compiled, const ReceivedSweep* sweep,
                                      const std::filesystem::path& directory, nlohmann::json& views);

}  // namespace ilf::app
