// A display that is not there: keeps what it was sent, at the frames of a clock.
#pragma once

#include <optional>

#include "devices/clock.h"
#include "devices/rig/video_output.h"

namespace ilf::devices {

/// For tests and rehearsals without a display. `show` waits for the clock's next frame.
class MemoryVideoOutput : public VideoOutput {
public:
    MemoryVideoOutput(VideoMode mode, Clock clock, DisplayIdentity display = {"memory", "", "", ""});

    Result<ScannedOut> show(const VideoFrame& frame) override;
    Result<VideoMode> mode() override;
    const DisplayIdentity& display() const override { return display_; }

    /// Pulls the cable: what was shown is gone.
    void lose();
    void giveBack() { lost_ = false; }
    /// As if somebody set another mode.
    void change(const VideoMode& mode) { mode_ = mode; }
    /// What is scanned out, over and over; empty before the first frame and after a loss.
    const VideoFrame& shown() const { return shown_; }
    std::int64_t framesShown() const { return frames_; }

private:
    tl::unexpected<Error> gone() const;

    VideoMode mode_;
    Clock clock_;
    DisplayIdentity display_;
    bool lost_ = false;
    VideoFrame shown_;
    std::int64_t frames_ = 0;
};

}  // namespace ilf::devices
