// A LightCrafter 4500 that shows the bit planes of live video as the slots of a sweep.
#pragma once

#include <chrono>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/base/geometry.h"
#include "devices/clock.h"
#include "devices/dlpc350/conversation.h"
#include "devices/dlpc350/input_source.h"
#include "devices/dlpc350/sequence.h"

namespace ilf::devices::dlpc350 {

/// What documents leave open, to be settled at first light.
struct BringUp {
    bool swapAtFrame = true;                 ///< see lutOf
    bool readTableBack = true;               ///< TI's code does; community drivers never tried
    Size raster{912, 1140};                  ///< only this is shown pixel by pixel; video of another size is refused
    std::optional<TriggerOut1> triggerOut1;  ///< absent: left as the board has it
    std::optional<TriggerOut2> triggerOut2;
};

/// What a board is and how it is, for a doctor.
struct Findings {
    Version version;
    std::string firmwareTag;
    Display display = Display::video;
    PatternRun run = PatternRun::stopped;
    Source source = Source::parallel;   ///< of plain video
    VideoSignal video;                  ///< means nothing while `display` is pattern or another source is shown
    std::vector<std::string> troubles;  ///< what is wrong, and what would help
    std::vector<std::string> remarks;   ///< what is worth knowing
};

/// What a start found out.
struct Started {
    VideoSignal video;
    std::vector<std::string> remarks;  ///< of the board's check of the pattern table
};

/// What the watch saw last.
struct Watched {
    Display display = Display::video;
    PatternRun run = PatternRun::stopped;
    Source source = Source::parallel;   ///< what it shows while `display` is video
    bool seesVideo = true;              ///< false: it is to show video that comes in, and there is none
    bool playing = false;               ///< patterns run, and nothing is wrong with them
    int flips = 0;                      ///< how often the board left pattern mode by itself
    std::vector<std::string> troubles;  ///< what is wrong, and what would help
};

/// How long the board is waited for.
struct Patience {
    Milliseconds answer{2000};  ///< to each message
    int polls = 20;             ///< of 100 ms, until it has done what it was told
};
/// On the way to safe light: a board that is silent costs about 0.2 s.
inline constexpr Patience kBrief{Milliseconds(200), 3};

/// Calls come from one thread. The board keeps doing what it was told when this object goes away. Order of operations,
/// double start, pauses and poll rate: TI's programmer's guide (DLPU010, table 4-2) and its users' drivers.
class LightCrafter {
public:
    static constexpr std::uint16_t kVendor = 0x0451, kProduct = 0x6401;
    static constexpr int kInterface = 0;

    static Result<std::unique_ptr<LightCrafter>> open(std::unique_ptr<UsbLink> link, Clock clock,
                                                      const BringUp& bringUp = {});

    /// Reads only. Asking disturbs running patterns, so not during a show (see watch).
    Result<Findings> findings();

    /// The video that arrives, locked and of the raster's size, or why it cannot be used. In pattern mode the board
    /// cannot tell, so that what was measured last is returned; if nothing was, patterns are stopped and the board is
    /// switched to video to measure. A board that shows a picture of its own is switched to what comes in.
    Result<VideoSignal> measuredVideo();
    /// The video may be another one now (the output was unplugged or its mode changed): measure it again next time.
    void forgetVideo() { video_.reset(); }

    /// Stops what runs, sets everything up, reads it back, and runs `sequence` from then on at every frame. Refusals
    /// before the first change leave the board as it is; after any later error patterns are stopped.
    Result<Started> start(const PatternSequence& sequence);
    /// Returns once the board says that no pattern runs.
    Result<void> stop(const Patience& patience = {});
    /// Patterns stopped and plain video shown, every pixel of it all the time: what steady white light needs of the
    /// board. Firmware 4 was seen to hang when switched to and fro some dozen times, so never in a loop.
    Result<void> showVideo(const Patience& patience = {});
    /// Patterns stopped and the board's own test pattern shown, white everywhere: needs no video. Settings that are so
    /// already are left, so that it may be told again and again.
    Result<void> showOwnWhite(const Patience& patience = {});
    /// Whether video comes in, while it is shown; waited for as long as `patience` polls.
    Result<bool> seesVideo(const Patience& patience = {});

    /// Asks the board at most once a second, since asking disturbs patterns; in between, what it saw last. A board that
    /// is silent for half a second is an error.
    Result<Watched> watch();

    const std::string& name() const { return board_.name(); }
    const UsbIdentity& identity() const { return board_.identity(); }

private:
    LightCrafter(Conversation board, Clock clock, const BringUp& bringUp)
        : board_(std::move(board)), clock_(std::move(clock)), bringUp_(bringUp) {}

    /// Tells a setting and compares what the board then says it is.
    template <class T>
    Result<void> set(const T& value);
    /// The same, where the board does not say that it is so already.
    template <class T>
    Result<void> madeSure(const T& value);
    Result<void> setDisplay(Display display, const Patience& patience = {});
    Result<VideoSignal> usableVideo(const VideoSignal& video) const;
    Result<VideoSignal> videoAfterSwitching();
    Result<VideoSignal> lockedVideo();
    Result<void> chooseVideo();
    Result<void> watchInput(Watched& seen);
    Result<Started> arranged(const PatternSequence& sequence, const VideoSignal& video);
    Result<void> setTimes(const PatternSequence& sequence);
    Result<void> setTable(const PatternSequence& sequence);
    Result<void> comparedTable(const std::vector<LutEntry>& told);
    Result<void> setTriggers();
    Result<std::vector<std::string>> checkedByBoard();
    Result<void> startedTwice();
    Result<void> confirmedRunning();
    Error stoppedAfter(const Error& error);
    Error about(const std::string& what) const { return {Fault::device, name() + " " + what}; }
    void wait(Second time) { clock_.wait(std::chrono::nanoseconds(std::llround(time.in(1e-9 * 1.0_s)))); }
    Second twoFrames() const;

    Conversation board_;
    Clock clock_;
    BringUp bringUp_;
    std::optional<VideoSignal> video_;  ///< as measured last
    bool toldToRun_ = false;
    Watched watched_;
    std::optional<std::chrono::nanoseconds> askedAt_;
};

}  // namespace ilf::devices::dlpc350
