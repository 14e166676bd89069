// `seams`: how visible each border between sharp and blurred light is, for both eyes, and the paper's seam experiment.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/lens/rig_choice.h"

namespace ilf::app {

struct SeamsOptions {
    std::string file;
    std::vector<std::string> errors;  ///< NAME=VALUE: pupil, registration, gaze, lens in mm; nearer, farther in percent
    std::optional<double> motion_mm_s;
    bool json = false;
    std::string experiment;  ///< set: a folder of textures, and no file
    std::string out;         ///< of the experiment: folder for pictures and seams.csv
    RigChoice rig;
};
int seamsCommand(const SeamsOptions& options);

}  // namespace ilf::app
