// `render`: views of projects as PNG, TIFF and EXR files, one or whole batches.
#pragma once

#include <string>
#include <vector>

#include "app/lens/rig_choice.h"

namespace CLI {
class App;
}

namespace ilf::app {

struct RenderOptions {
    std::vector<std::string> files;  ///< more than one only with `outDir`
    /// perceived, error, plain, camera, overlay, slots, slot:N
    std::vector<std::string> views{"perceived"};
    std::string eye = "left";    ///< left, right, both
    std::string rung = "rest";   ///< dragging, rest, idle
    std::string attend;          ///< name or id of a region; empty: the nearest focused one
    std::string gaze = "ahead";  ///< ahead, follows, or X,Y in pixels of the picture
    bool chromatic = false, lensField = false;
    double scale = 1.0;
    bool reference = false;  ///< perceived by brute force
    int samples = 256;       ///< rays a pixel, of the reference
    double white = 0.0;      ///< difference that an error map shows white; 0: chosen
    bool half = false;       ///< EXR in 16 bits
    RigChoice rig;
    std::string out;                   ///< one file; its ending chooses the format
    std::string outDir;                ///< or a folder for all of them,
    std::vector<std::string> formats;  ///< in each of png, tif, exr; empty: png
};

/// The command line of `render`; what every command may be told of the lens comes besides.
CLI::App& addRender(CLI::App& app, RenderOptions& options);
int renderCommand(const RenderOptions& options);

}  // namespace ilf::app
