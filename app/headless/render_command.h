// `render`: one view of a project as a PNG.
#pragma once

#include <string>

#include "app/lens/lens_choice.h"

namespace ilf::app {

struct RenderOptions {
    std::string file;
    std::string view = "perceived";  ///< camera, perceived, slot:N, overlay
    std::string eye = "left";
    bool reference = false;  ///< perceived by brute force
    int samples = 256;       ///< points of the pupil a pixel, for the reference
    LensChoice lens;
    std::string out;
};

int renderCommand(const RenderOptions& options);

}  // namespace ilf::app
