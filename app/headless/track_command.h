// `track`: follows regions through recorded or emulated pictures and says, picture by picture, where they are.
#pragma once

#include <string>

namespace ilf::app {

struct TrackOptions {
    std::string source;   ///< folder of pictures, video file, or emulated:WORDS with a marker
    std::string project;  ///< whose regions follow something; empty: one region, by `marker` or `patch`
    std::string marker;   ///< "7" (AprilTag 36h11) or "6X6_250:7", learnt in the first picture
    std::string patch;    ///< "X0,Y0,X1,Y1" of a flat thing in the first picture
    std::string whenLost = "neutral";
    double rate_Hz = 30.0;   ///< pictures a second; of a folder and the emulated scene
    double seconds = 5.0;    ///< of the emulated scene
    double ahead_ms = 30.0;  ///< from a picture's arrival to the sweep that shows what was made of it
    double hold_ms = 500.0, fade_ms = 500.0;
    bool json = false;
};

/// Exit codes: 0 done, 1 not usable.
int trackCommand(const TrackOptions& options);

}  // namespace ilf::app
