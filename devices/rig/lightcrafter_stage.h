// The stage made of a LightCrafter, the display it hangs on and the lenses: who is told what, in which order.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "devices/clock.h"
#include "devices/rig/known_device.h"
#include "devices/rig/lens_side.h"
#include "devices/rig/stage_projector.h"
#include "devices/rig/video_output.h"

namespace ilf::devices {

/// A program as the LightCrafter takes it.
struct PatternFrame {
    VideoFrame picture;
    dlpc350::PatternSequence sequence;
};

/// What a stage is made of. Devices are opened when they are first needed and again after they were lost.
struct LightCrafterRig {
    std::function<Result<std::unique_ptr<StageProjector>>()> openProjector;
    /// Opens the lenses at rest at this power; refuses where no calibration says what current gives it.
    LensSide::Open openLens;
    std::shared_ptr<VideoOutput> video;
    std::function<Result<PatternFrame>(const Program&)> packed;
    Clock clock = Clock::steady();
    std::string name = "LightCrafter 4500 and lenses";  ///< "emulated ..." where that is so
    bool emulated = false;                              ///< the cables lead to emulated devices
    Dioptre rest{};                                     ///< of the lenses until a program says another one
};

/// The order of a start: white video; lenses to their sweep, until they are predicted to be settled; the board's
/// patterns, still showing white in every slot, so that its triggers can be heard; the sweep locked to them; the
/// program's frame. A program with the same wave, rate and delay is one frame of video. Another wave goes through the
/// white frame, and another pattern table through a fresh start of the patterns. The board is dark while it arranges
/// its patterns (about half a second, its documents say no more); that cannot be helped over USB.
///
/// Any error of a device ends in safe light before it is returned, and only a new `load` and `swap` lights slots
/// again. Safe light is white video, or, where the display is lost or the board says that no video comes in, white that
/// the board makes itself. That stays until the next program: going back, the board has to lock on its video first, and
/// is dark for a moment. The lenses go to rest as soon as the light is white, or was asked to be; a silent board keeps
/// them from it for 0.2 s at most, and only where the display is lost as well. A device whose safe state could not be
/// told is let go and opened again, at most once a second, by `heartbeat` and `safeLight`, which then tell it.
class LightCrafterStage : public Stage {
public:
    explicit LightCrafterStage(LightCrafterRig rig);
    ~LightCrafterStage() override;

    Result<void> load(const Program& program) override;
    Result<void> swap() override;
    Result<void> heartbeat() override;
    void safeLight() noexcept override;
    StageReport report() const override;
    std::string name() const override {
        return rig_.name + ", through USB; tested against emulators, never on hardware";
    }

    /// When the first light of the program swapped in last began, in the rig's clock: a frame is shown as patterns one
    /// frame after it was sent.
    std::chrono::nanoseconds lightBegan() const { return lightBegan_; }

private:
    enum class Light { unknown, white, slotted };
    struct Loaded {
        Program program;
        PatternFrame frame;
    };

    Result<void> began();
    /// Returns when the frame's light begins.
    Result<std::chrono::nanoseconds> lit(const VideoFrame& frame);
    Result<void> published(const VideoFrame& frame);
    Result<void> patternsRun(const dlpc350::PatternSequence& sequence);
    Result<void> confirmed();
    Result<void> videoWell();
    Result<void> projectorWell();
    bool playsLikeLoaded() const;
    Result<void> reached(Dioptre rest);
    Result<void> reachedAgain();
    void makeSafe(Waiting waiting);
    Result<void> madeWhite();
    Result<void> boardIsPlain(bool videoIsWhite, Waiting waiting);
    Result<void> backToVideo();
    std::string projectorLine() const;
    std::vector<DeviceLine> deviceLines() const;
    tl::unexpected<Error> faulted(Error error);
    void waitUntil(std::chrono::nanoseconds time);

    LightCrafterRig rig_;
    LensSide lens_;
    std::unique_ptr<StageProjector> projector_;  ///< none: not opened, or lost
    KnownDevice projectorKnown_, displayKnown_;
    bool videoThere_ = false;  ///< took the last frame
    std::optional<std::chrono::nanoseconds> triedAt_;

    Light light_ = Light::unknown;
    bool ownWhite_ = false;             ///< the board was told to show it, whatever became of that
    bool safeTold_ = false;             ///< to all that can be reached, and nothing else since
    std::optional<Error> safeTrouble_;  ///< what first did not listen then
    VideoFrame white_;
    VideoMode mode_;
    std::optional<dlpc350::PatternSequence> running_;  ///< the board's patterns; none: plain video
    std::optional<Loaded> loaded_;
    Hertz sweeps_;  ///< of the program begun last
    std::chrono::nanoseconds lightBegan_{0};
};

}  // namespace ilf::devices
