// What a stage asks of the projector's board: patterns, plain video, its own white, and how it is.
#pragma once

#include <string>

#include "devices/dlpc350/lightcrafter.h"

namespace ilf::devices {

/// `brief`: one attempt, which a silent device cannot make last longer than about 0.2 s. `patient`: three,
/// about a second.
enum class Waiting { brief, patient };

/// Calls come from one thread. An error of `start` may leave the board dark, with its patterns stopped: `showVideo`
/// or `showOwnWhite` must follow.
class StageProjector {
public:
    virtual ~StageProjector() = default;

    /// Shows the bit planes of video as patterns, from then on at every frame.
    virtual Result<void> start(const dlpc350::PatternSequence& sequence) = 0;
    /// Plain video, every pixel all the time.
    virtual Result<void> showVideo(Waiting waiting) = 0;
    /// White that it makes itself, without any video, every pixel all the time.
    virtual Result<void> showOwnWhite(Waiting waiting) = 0;
    /// Whether video comes in, while it is shown; waits for it for some tenths of a second.
    virtual Result<bool> seesVideo() = 0;
    /// How it is; may be up to a second old.
    virtual Result<dlpc350::Watched> watch() = 0;
    virtual std::string name() const = 0;
};

/// The real one.
class LightCrafterProjector : public StageProjector {
public:
    explicit LightCrafterProjector(std::unique_ptr<dlpc350::LightCrafter> board) : board_(std::move(board)) {}

    Result<void> start(const dlpc350::PatternSequence& sequence) override;
    Result<void> showVideo(Waiting waiting) override;
    Result<void> showOwnWhite(Waiting waiting) override;
    Result<bool> seesVideo() override;
    Result<dlpc350::Watched> watch() override { return board_->watch(); }
    std::string name() const override { return "LightCrafter 4500 at USB " + board_->identity().path; }

private:
    std::unique_ptr<dlpc350::LightCrafter> board_;
};

}  // namespace ilf::devices
