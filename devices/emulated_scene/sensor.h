// The emulated camera's sensor: light to electrons, with their noise, to 8-bit codes.
#pragma once

#include <cstdint>
#include <vector>

#include "core/base/image.h"
#include "core/base/quantity.h"
#include "devices/emulated_scene/light_transport.h"

namespace ilf::devices::scene {

struct SensorSettings {
    Second exposure = Second::fromSi(2.0 / 60.0);
    double gain = 1.0;
    double gamma = 2.2;           ///< codes are the signal to the power of 1 / gamma
    double fullWell = 10000.0;    ///< electrons of the brightest code at gain 1
    double readNoise = 12.0;      ///< electrons, standard deviation
    double perLuxSecond = 560.0;  ///< electrons of a white surface
    bool noisy = true;
    std::uint64_t seed = 1;  ///< of the noise; every picture its own
};

/// RGB picture of what `LightTransport::shine` gave, of that transport.
Image<std::uint8_t> exposed(const LightTransport& transport, const std::vector<float>& light,
                            const SensorSettings& settings);
/// Of any light; `tint` as LightTransport::tint.
Image<std::uint8_t> exposed(Size size, const std::vector<float>& light, const std::vector<std::uint8_t>& tint,
                            const SensorSettings& settings);

}  // namespace ilf::devices::scene
