// Sphere-traces a scene into a picture, the true depth of every pixel and the coverage of every region.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "scene.h"

namespace ilf::samples {

/// All `width` x `height`, row by row from the top.
struct Rendering {
    int width = 0, height = 0;
    std::vector<std::uint8_t> picture;  // sRGB, three bytes a pixel
    std::vector<float> depth;  // metres from the wearer's lens along the view axis, at the pixel's centre; 0: nothing
    std::map<std::string, std::vector<std::uint8_t>> masks;  // region name to coverage 0..255
};

/// `samplesAcross` squared rays where a pixel is not smooth, one elsewhere; the same bytes whatever the thread count.
Rendering rendered(const Scene& scene, int samplesAcross);

}  // namespace ilf::samples
