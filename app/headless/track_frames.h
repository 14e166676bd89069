// Where `track` gets its pictures from.
#pragma once

#include <functional>
#include <optional>

#include "app/headless/track_command.h"
#include "core/base/result.h"
#include "core/track/quad.h"
#include "devices/camera/frame.h"

namespace ilf::app {

struct TrackFrames {
    /// In the order of time, from 0 s on; nothing: that was the last one.
    std::function<Result<std::optional<devices::Frame>>()> next;
    /// Corners of the emulated marker; empty: nobody knows.
    std::function<Quad(Second)> truth;
};

/// Refused: no such file or folder, a folder without pictures, words that the emulated scene does not know.
Result<TrackFrames> trackFrames(const TrackOptions& options);

}  // namespace ilf::app
