// A window whose pictures are swapped in whole, at the display's vertical sync where the server has one.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>

#include "devices/rig/video_output.h"
#include "devices/video/x_connection.h"

namespace ilf::devices {

/// A picture was swapped in.
struct Swapped {
    std::chrono::nanoseconds at{0};  ///< the machine's monotonic clock: the server's time of it, else when it was told
    std::optional<std::int64_t> frame;  ///< the server's number of that vertical sync
};

/// OpenGL on a window of 8 bits a channel. All calls from one thread.
class SwapWindow {
public:
    static Result<std::unique_ptr<SwapWindow>> open(XConnection& x, Size size);
    virtual ~SwapWindow() = default;

    virtual void showAt(int left, int top) = 0;
    virtual void hide() = 0;
    virtual bool shown() const = 0;
    /// Handles what the server has to say; true if displays came, went or changed.
    virtual bool displaysChanged() = 0;
    /// Draws `frame` pixel by pixel, swaps it in and returns when that is done. `checked`: what was drawn is read back
    /// first, and the frame refused (`device`) if any value changed on its way.
    virtual Result<Swapped> swap(const VideoFrame& frame, bool checked) = 0;
};

}  // namespace ilf::devices
