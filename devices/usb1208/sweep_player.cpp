#include "devices/usb1208/sweep_player.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <tuple>
#include <utility>

#include "devices/usb1208/messages.h"

namespace ilf::devices {
namespace {

const Second kSampleStep = Second::fromSi(1.0 / usb1208::kSampleRateHz);
// A wave may use so much of the slope that the amplifier allows: the rest is for fading and slipping.
constexpr double kSlopeForWaves = 0.9;
// A fade longer than this would be a fault in the waves, not a change.
constexpr int kMostFadeSweeps = 120;
constexpr std::int64_t kRemembered = 2 * static_cast<std::int64_t>(usb1208::kSampleRateHz);

double mostStep(const Amplifier& amplifier) { return amplifier.slew.si() * kSampleStep.si(); }

double steepest(const std::vector<double>& wave) {
    double most = std::abs(wave.front() - wave.back());
    for (std::size_t i = 1; i < wave.size(); ++i)
        most = std::max(most, std::abs(wave[i] - wave[i - 1]));
    return most;
}

double farthest(const std::vector<double>& one, const std::vector<double>& other) {
    double most = 0.0;
    for (std::size_t i = 0; i < one.size(); ++i)
        most = std::max(most, std::abs(one[i] - other[i]));
    return most;
}

std::string milliamperes(double amperes) {
    return std::to_string(static_cast<int>(std::lround(amperes * 1e3))) + " mA";
}

Result<std::vector<double>> sampledOne(const LensChannel& channel, const Waveform& wave, std::size_t samples,
                                       const std::string& name) {
    const Amplifier& amplifier = channel.amplifier;
    // A lens that stays where it rests needs no drive of its own.
    if (wave.drive.c.empty() && wave.still() && wave.low == wave.rest)
        return std::vector<double>(samples, channel.rest.si());
    if (wave.drive.c.empty())
        return fail(Fault::unsupported,
                    "The plan says what power the " + name +
                        " lens shall have but not how to drive it. Choose a calibrated lens, so that "
                        "the wave comes with its drive.");
    if (!isFinite(wave.drive))
        return fail(Fault::badFile, "The drive of the " + name + " lens is not a number. Calibrate the lens again.");
    auto currents = samplesOf(wave.drive, samples);
    for (double& current : currents)
        current = currentOf(amplifier, current, wave.unit).si();
    double most = 0.0;
    for (const double current : currents)
        most = std::max(most, std::abs(current));
    if (most > amplifier.most.si() * (1.0 + 1e-9))
        return fail(Fault::unsafe, "The wave of the " + name + " lens needs " + milliamperes(most) +
                                       " and its amplifier may "
                                       "give " +
                                       milliamperes(amplifier.most.si()) +
                                       ". Choose a smaller sweep, or check the amplifier in the rig.");
    if (steepest(currents) > kSlopeForWaves * mostStep(amplifier))
        return fail(Fault::unsafe,
                    "The wave of the " + name +
                        " lens changes faster than its amplifier may. Choose a smaller or smoother sweep, or "
                        "check the amplifier's slope in the rig.");
    return currents;
}

}  // namespace

Result<SweepSamples> sampled(const LensChannels& channels, const Waveform& left, const Waveform& right) {
    if (left.rate != right.rate)
        return fail(Fault::unsupported,
                    "Both lenses must sweep at the same rate; the plan has two. Plan both for one.");
    const auto count = usb1208::samplesPerSweep(left.rate);
    if (!count) return tl::unexpected(count.error());
    const auto samples = static_cast<std::size_t>(*count);
    auto l = sampledOne(channels.left, left, samples, "left");
    if (!l) return tl::unexpected(std::move(l.error()));
    auto r = sampledOne(channels.right, right, samples, "right");
    if (!r) return tl::unexpected(std::move(r.error()));
    return SweepSamples{*std::move(l), *std::move(r)};
}

SweepSamples resting(const LensChannels& channels, std::size_t samples) {
    return {std::vector<double>(samples, channels.left.rest.si()),
            std::vector<double>(samples, channels.right.rest.si())};
}

SweepPlayer::SweepPlayer(const LensChannels& channels, std::size_t samples)
    : channels_(channels), now_(resting(channels_, samples)), left_(channels_.left.rest), right_(channels_.right.rest) {
    assert(samples >= 4);
}

void SweepPlayer::fill(std::span<std::uint8_t> frames) {
    const auto& [l, r] = channels_;
    for (std::size_t at = 0; at + usb1208::kBytesPerFrame <= frames.size(); at += usb1208::kBytesPerFrame) {
        double left = l.rest.si(), right = r.rest.si();
        if (toRest_) {
            const double share =
                std::min(1.0, static_cast<double>(made_ - toRest_->begins + 1) / static_cast<double>(toRest_->frames));
            left = std::lerp(toRest_->left.si(), left, share);
            right = std::lerp(toRest_->right.si(), right, share);
        } else {
            if (sample_ == 0 && !repeating_) beginSweep();
            std::tie(left, right) = sweepSample();
        }
        left_ = limited(l.amplifier, left_, Ampere::fromSi(left), kSampleStep);
        right_ = limited(r.amplifier, right_, Ampere::fromSi(right), kSampleStep);
        usb1208::putSample(frames.subspan(at, 2), usb1208::outputCode(voltsFor(l.amplifier, left_)));
        usb1208::putSample(frames.subspan(at + 2, 2), usb1208::outputCode(voltsFor(r.amplifier, right_)));
        if (toRest_ && !restsSince_ && left_ == l.rest && right_ == r.rest) restsSince_ = made_;
        ++made_;
        if (!toRest_) nextSample();
    }
}

std::pair<double, double> SweepPlayer::sweepSample() const {
    double left = now_.left[sample_], right = now_.right[sample_];
    if (!fading_) return {left, right};
    const std::size_t faded = static_cast<std::size_t>(fadedSweeps_) * now_.size() + sample_ + 1;
    const double share =
        static_cast<double>(faded) / (static_cast<double>(fadeSweeps_) * static_cast<double>(now_.size()) + 1.0);
    left += share * (next_->left[sample_] - left);
    right += share * (next_->right[sample_] - right);
    return {left, right};
}

void SweepPlayer::nextSample() {
    repeating_ = slipNow_ > 0 && sample_ == slipAt_;
    if (repeating_) {
        slipNow_ = 0;
        return;
    }
    ++sample_;
    if (slipNow_ < 0 && sample_ == slipAt_) {
        slipNow_ = 0;
        ++sample_;
    }
    if (sample_ == now_.size()) sample_ = 0;
}

void SweepPlayer::rest(std::int64_t frames) {
    if (!toRest_) toRest_ = WayToRest{made_, std::max<std::int64_t>(1, frames), left_, right_};
}

void SweepPlayer::beginSweep() {
    if (fading_ && ++fadedSweeps_ == fadeSweeps_) {
        finishFade();
        if (sample_ != 0) return;  // shifted: the next sweep starts later
    } else if (!fading_ && next_) {
        if (fadeSweeps_ == 0) {
            now_ = *std::exchange(next_, std::nullopt);
            alone_ = made_;
        } else {
            fading_ = true;
            fadedSweeps_ = 0;
        }
    }
    starts_.push_back({made_, moved_});
    while (starts_.size() > 2 && starts_.front().frame < made_ - kRemembered)
        starts_.pop_front();

    slipNow_ = (slipsWaiting_ > 0) - (slipsWaiting_ < 0);
    if (slipNow_ == 0) return;
    slipsWaiting_ -= slipNow_;
    moved_ += slipNow_;
    // Where leaving a sample out, or repeating it, is least of a jump.
    double least = INFINITY;
    for (std::size_t i = 1; i + 1 < now_.size(); ++i) {
        const double jump =
            std::max(std::abs(now_.left[i + 1] - now_.left[i - 1]), std::abs(now_.right[i + 1] - now_.right[i - 1]));
        if (jump < least) {
            least = jump;
            slipAt_ = i;
        }
    }
}

void SweepPlayer::finishFade() {
    now_ = *std::exchange(next_, std::nullopt);
    fading_ = false;
    fadeSweeps_ = 0;
    alone_ = made_;
    if (shiftBy_ == 0) return;
    // The wave was moved by rotating it; from now on its start is what moved.
    const auto turn = [&](std::vector<double>& wave) {
        std::rotate(wave.begin(), wave.begin() + static_cast<std::ptrdiff_t>(shiftBy_), wave.end());
    };
    turn(now_.left);
    turn(now_.right);
    sample_ = now_.size() - shiftBy_;
    const auto back = static_cast<std::int64_t>(sample_);
    const auto later = static_cast<std::int64_t>(std::exchange(shiftBy_, 0));
    moved_ += later;
    starts_.push_back({made_ - back, moved_ - static_cast<std::int64_t>(now_.size())});
}

Result<Change> SweepPlayer::planned(SweepSamples next, int fadesAtLeast) {
    if (next.left.size() != now_.size() || next.right.size() != now_.size())
        return fail(Fault::unsupported, "Another sweep rate can only start from rest. Let the lenses rest first.");
    if (fading_)
        return fail(Fault::device, "The lenses are still fading from one wave into another. Try again in a moment.");
    int fades = fadesAtLeast;
    const auto consider = [&](const Amplifier& amplifier, const std::vector<double>& from,
                              const std::vector<double>& to) {
        const double most = mostStep(amplifier);
        if (fades == 0 && std::abs(to.front() - from.back()) <= kSlopeForWaves * most) return;
        const double spare = most * 0.99 - std::max(steepest(from), steepest(to));
        const double sweeps = std::ceil(farthest(from, to) / (spare * static_cast<double>(from.size())));
        if (!(spare > 0.0) || sweeps > kMostFadeSweeps) {
            fades = kMostFadeSweeps + 1;
        } else {
            fades = std::max({fades, 1, static_cast<int>(sweeps)});
        }
    };
    consider(channels_.left.amplifier, now_.left, next.left);
    consider(channels_.right.amplifier, now_.right, next.right);
    if (fades > kMostFadeSweeps)
        return fail(Fault::unsafe,
                    "The new wave cannot be reached within the slope that the amplifier allows. Choose a "
                    "smaller or smoother sweep.");
    next_ = std::move(next);
    fadeSweeps_ = fades;
    Change change;
    change.fadeSweeps = fades;
    const bool atStart = sample_ == 0 && !repeating_;
    const auto left = static_cast<std::int64_t>(now_.size() - sample_) + slipNow_;
    change.startsAt = made_ + (atStart ? 0 : left);
    const int slips = std::clamp(slipsWaiting_, -fades, fades);
    change.completeAt = change.startsAt + fades * static_cast<std::int64_t>(now_.size()) + slips;
    return change;
}

Result<Change> SweepPlayer::swap(SweepSamples next) {
    auto change = planned(std::move(next), 0);
    if (change) shiftBy_ = 0;
    return change;
}

Result<Change> SweepPlayer::shift(int samples) {
    if (next_ && !fading_) return fail(Fault::device, "A new wave is about to begin. Try again in a moment.");
    const int count = static_cast<int>(now_.size());
    const auto by = static_cast<std::size_t>(((samples % count) + count) % count);
    auto moved = now_;
    const auto turn = [&](std::vector<double>& wave) {
        std::rotate(wave.begin(), wave.end() - static_cast<std::ptrdiff_t>(by), wave.end());
    };
    turn(moved.left);
    turn(moved.right);
    auto change = planned(std::move(moved), 1);
    if (change) shiftBy_ = by;
    return change;
}

void SweepPlayer::slip(int samples) { slipsWaiting_ += samples; }

SweepPlayer::Tone SweepPlayer::leftTone() const {
    Tone tone{0.0, alone_};
    if (next_) return tone;
    const double count = static_cast<double>(now_.size());
    for (std::size_t i = 0; i < now_.size(); ++i) {
        const double volts = voltsFor(channels_.left.amplifier, Ampere::fromSi(now_.left[i])).si();
        tone.fundamental += volts * std::polar(2.0 / count, -2.0 * std::numbers::pi * static_cast<double>(i) / count);
    }
    return tone;
}

std::optional<SweepPlayer::Place> SweepPlayer::placeOf(double frame) const {
    std::optional<Place> nearest;
    for (const auto& start : starts_) {
        const double offset = frame - static_cast<double>(start.frame);
        if (!nearest || std::abs(offset) < std::abs(nearest->offset)) nearest = Place{offset, start.moved};
    }
    if (!nearest || std::abs(nearest->offset) > static_cast<double>(now_.size())) return std::nullopt;
    return nearest;
}

}  // namespace ilf::devices
