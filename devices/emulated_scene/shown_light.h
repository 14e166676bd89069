// The light that simulated devices or an emulated rig show now, as a camera's exposure gathers it.
#pragma once

#include <cstdint>
#include <deque>
#include <filesystem>
#include <map>
#include <memory>
#include <vector>

#include "core/base/geometry.h"
#include "core/base/quantity.h"
#include "core/base/result.h"
#include "devices/simulated/device_client.h"

namespace ilf::devices {

/// Mean light over an exposure, 1 = full, row by row of the projector's raster.
struct ShownLight {
    Size raster;
    std::vector<float> light;
    bool there = false;  ///< a projector is; else the raster is dark
};

/// Asks the process that has the devices in this runtime directory, over its own cable; changes nothing there. Of an
/// emulated rig it takes whole sweeps, as they were received; of simulated devices what each slot holds, and since
/// when. Colours of a lamp count by their number.
class ShownLightReader {
public:
    explicit ShownLightReader(std::filesystem::path runtimeDirectory);
    ~ShownLightReader();

    /// Of an exposure that ends about now; waits for a part of it where two sweeps have to be seen. Without devices, or
    /// where they do not answer: dark.
    ShownLight during(Second exposure);

private:
    ShownLight ofSimulated(Second exposure);
    ShownLight ofEmulated(Second exposure);
    Result<ShownLight> newestSweep(Second& sweep);
    Result<std::vector<float>> slots(const DeviceState& state);

    struct Since {
        std::int64_t from_ns = 0;
        std::vector<float> light;
    };
    std::filesystem::path directory_;
    std::unique_ptr<DeviceClient> client_;
    Size raster_{1024, 768};  ///< the last one seen; simulated devices tell none in steady light
    std::map<std::uint64_t, std::vector<float>> images_;  ///< of slots on show, by their hash
    std::uint64_t shown_ = 0;                             ///< hash of what was seen last, 0: steady
    std::deque<Since> past_;
};

}  // namespace ilf::devices
