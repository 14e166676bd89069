// The endless stream of samples for both lenses: sweeps that follow each other, swap, slip, shift and rest without a
// jump.
#pragma once

#include <complex>
#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "core/base/result.h"
#include "core/lens/waveform.h"
#include "devices/usb1208/amplifier.h"

namespace ilf::devices {

/// One eye's amplifier and where its lens rests.
struct LensChannel {
    Amplifier amplifier;
    /// Through the lens at its working temperature, from a calibration; 0 only where nothing else is known.
    Ampere rest;
};
struct LensChannels {
    LensChannel left, right;  ///< AO0, AO1
};

/// One sweep of currents for both lenses, in amperes, equally spaced; sample 0 is where slot 0's light begins.
struct SweepSamples {
    std::vector<double> left, right;
    bool operator==(const SweepSamples&) const = default;
    std::size_t size() const { return left.size(); }
};

/// Refused, with what would help: drives that are missing or not finite, of different rates, beyond the amplifier's
/// current or slope (at their worst sample, the step to the next sweep included), or of a rate that 48 kS/s cannot play
/// (`samplesPerSweep`). Nothing is clipped: a clipped wave would be another lens movement than was planned.
Result<SweepSamples> sampled(const LensChannels& channels, const Waveform& left, const Waveform& right);
/// Both lenses at rest.
SweepSamples resting(const LensChannels& channels, std::size_t samples);

/// From which frame on a change is complete. Frames count from 0 when the player was made.
struct Change {
    std::int64_t startsAt = 0;  ///< always sample 0 of a sweep
    /// Between the two the old wave fades into the new one. Slips that are told later move it.
    std::int64_t completeAt = 0;
    int fadeSweeps = 0;  ///< 0: the new wave follows the old one directly
};

/// Frames of two codes, 48000 a second. Every sample passes `limited`. Not thread-safe.
class SweepPlayer {
public:
    /// Plays rest, in sweeps of `samples`.
    SweepPlayer(const LensChannels& channels, std::size_t samples);

    /// The next `frames.size() / 4` frames, as the device takes them.
    void fill(std::span<std::uint8_t> frames);
    std::size_t samples() const { return now_.size(); }
    /// What was made last.
    Ampere lastLeft() const { return left_; }
    Ampere lastRight() const { return right_; }

    /// `next` begins at sample 0 of a sweep. If the step to it would be steeper than the amplifiers allow, whole sweeps
    /// of cross-fade come first, as few as keep the slope inside; none is asked to hold light in that time. Replaces a
    /// change that has not begun. Refused: another number of samples, and a change while another one fades.
    Result<Change> swap(SweepSamples next);
    /// The sweep after the one being made is one sample longer (+1) or shorter (-1), at the flattest place of its wave.
    /// Slips add up; each sweep takes one.
    void slip(int samples);
    /// Moves the sweep's start by so many samples (later is positive) by fading into the moved wave. For aligning
    /// before light is slotted; refused like a swap.
    Result<Change> shift(int samples);
    /// From the next frame on both lenses go to rest, evenly over so many frames, and stay there whatever else is told.
    void rest(std::int64_t frames);
    /// The first frame from which on both play rest because of `rest`; none: not yet.
    std::optional<std::int64_t> restsSince() const { return restsSince_; }

    std::int64_t frames() const { return made_; }
    /// What AO0 plays over and over, for hearing where it stands.
    struct Tone {
        /// Volts: Re(fundamental e^(2 pi i x)) is its part of one period, x in sweeps. 0 while waves change.
        std::complex<double> fundamental;
        std::int64_t since = 0;  ///< the frame from which it plays alone
    };
    Tone leftTone() const;
    /// Where a frame is: how many samples after (or, below 0, before) the nearest start of a sweep, and by how many
    /// samples slips and shifts had moved that start. None before the first, or more than two seconds ago.
    struct Place {
        double offset = 0.0;
        std::int64_t moved = 0;
    };
    std::optional<Place> placeOf(double frame) const;

private:
    struct Start {
        std::int64_t frame = 0, moved = 0;
    };
    std::pair<double, double> sweepSample() const;
    void nextSample();
    void beginSweep();
    void finishFade();
    Result<Change> planned(SweepSamples next, int fadesAtLeast);

    LensChannels channels_;
    SweepSamples now_;
    std::optional<SweepSamples> next_;
    int fadeSweeps_ = 0, fadedSweeps_ = 0;
    bool fading_ = false;
    std::size_t shiftBy_ = 0;  ///< by how much the change going on moves the sweep's start
    std::size_t sample_ = 0, slipAt_ = 0;
    int slipNow_ = 0, slipsWaiting_ = 0;
    bool repeating_ = false;
    std::int64_t made_ = 0, moved_ = 0, alone_ = 0;
    Ampere left_, right_;
    struct WayToRest {
        std::int64_t begins = 0, frames = 0;
        Ampere left, right;  ///< where from
    };
    std::optional<WayToRest> toRest_;
    std::optional<std::int64_t> restsSince_;
    std::deque<Start> starts_;
};

}  // namespace ilf::devices
