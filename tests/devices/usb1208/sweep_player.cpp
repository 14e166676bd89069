#include "devices/usb1208/sweep_player.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "devices/usb/usb_link.h"
#include "tests/support/law.h"

namespace ilf::devices {
namespace {

Ampere mA(double value) { return Ampere::fromSi(value * 1e-3); }

LensChannels channels(double left_mA = 20.0, double right_mA = -10.0) {
    LensChannels all;
    all.left.rest = mA(left_mA);
    all.right.rest = mA(right_mA);
    return all;
}

/// A cosine about `middle`, in milliamperes; `turn` in sweeps.
SweepSamples cosine(double amplitude, double middle = 0.0, double turn = 0.0, std::size_t samples = 800) {
    SweepSamples wave;
    for (std::size_t i = 0; i < samples; ++i) {
        const double x = 2.0 * std::numbers::pi * (static_cast<double>(i) / static_cast<double>(samples) - turn);
        wave.left.push_back(1e-3 * (middle + amplitude * std::cos(x)));
        wave.right.push_back(1e-3 * (middle - amplitude * std::cos(x)));
    }
    return wave;
}

/// Left and right in milliamperes, decoded by hand: 2.5 V is 0, 10 mV a milliampere, 4096 codes for 5 V.
struct Heard {
    std::vector<double> left, right;
};
Heard heard(SweepPlayer& player, std::size_t frames) {
    Bytes bytes(frames * 4);
    player.fill(bytes);
    Heard all;
    for (std::size_t i = 0; i < frames; ++i) {
        const auto milliamperes = [&](std::size_t at) {
            return ((bytes[at] + 256 * bytes[at + 1]) * 5.0 / 4096.0 - 2.5) / 0.01;
        };
        all.left.push_back(milliamperes(4 * i));
        all.right.push_back(milliamperes(4 * i + 2));
    }
    return all;
}

constexpr double kCodeMilliamperes = 0.123;
// 1000 A/s.
constexpr double kMostStepMilliamperes = 1000.0 / 48.0 + kCodeMilliamperes;

double steepest(const std::vector<double>& wave) {
    double most = 0.0;
    for (std::size_t i = 1; i < wave.size(); ++i)
        most = std::max(most, std::abs(wave[i] - wave[i - 1]));
    return most;
}

Waveform driven(double amplitude_mA, Hertz rate = 60.0_Hz) {
    Waveform wave = idealSine(0.0_D, 0.0_D, 2.0_D, rate, 0.0_s);
    wave.unit = DriveUnit::ampere;
    wave.drive.c = {0.0, amplitude_mA * 1e-3};
    return wave;
}

}  // namespace

TEST_CASE("sweep player: told to rest, it goes there evenly from wherever it is and stays, whatever else is told") {
    for (const bool fading : {false, true}) {
        SweepPlayer player(channels(), 800);
        REQUIRE(player.swap(cosine(200.0)));
        auto before = heard(player, 4000);
        if (fading) {
            REQUIRE(player.swap(cosine(200.0, 0.0, 0.5)));
            before = heard(player, 100);
        }
        CHECK_FALSE(player.restsSince());
        const auto from = player.frames();
        player.rest(1920);
        const auto after = heard(player, 3000);
        const double first = before.left.back();
        REQUIRE(std::abs(first - 20.0) > 50.0);
        for (std::size_t i = 0; i < 1920; ++i) {
            const double share = static_cast<double>(i + 1) / 1920.0;
            CHECK(std::abs(after.left[i] - (first + share * (20.0 - first))) <= 2.0 * kCodeMilliamperes);
        }
        CHECK(player.restsSince() == from + 1919);
        (void)player.swap(cosine(100.0));
        player.slip(1);
        player.rest(10);
        const auto later = heard(player, 3000);
        for (std::size_t i = 0; i < later.left.size(); ++i) {
            CHECK(std::abs(later.left[i] - 20.0) <= kCodeMilliamperes);
            CHECK(std::abs(later.right[i] + 10.0) <= kCodeMilliamperes);
        }
        CHECK(player.restsSince() == from + 1919);
    }
    // From full current in one frame is more than an amplifier may: as fast as it may.
    SweepPlayer hurried(channels(), 800);
    REQUIRE(hurried.swap(cosine(200.0)));
    (void)heard(hurried, 2400);
    hurried.rest(1);
    CHECK(steepest(heard(hurried, 100).left) <= kMostStepMilliamperes);
    CHECK(hurried.restsSince());
}

TEST_CASE("sweep player: it plays rest until it is told otherwise") {
    SweepPlayer player(channels(), 800);
    const auto rest = heard(player, 2000);
    for (const double left : rest.left)
        CHECK(std::abs(left - 20.0) <= kCodeMilliamperes);
    for (const double right : rest.right)
        CHECK(std::abs(right + 10.0) <= kCodeMilliamperes);
}

TEST_CASE("sweep player: blocks of any size give the same samples") {
    SweepPlayer one(channels(), 800), other(channels(), 800);
    const auto play = [](SweepPlayer& player) { REQUIRE(player.swap(cosine(200.0))); };
    play(one);
    play(other);
    one.slip(2);
    other.slip(2);
    const auto whole = heard(one, 10'000);
    std::vector<double> pieces;
    for (std::size_t size = 1; pieces.size() < whole.left.size(); size = size * 7 % 479 + 1) {
        const auto piece = heard(other, std::min(size, whole.left.size() - pieces.size()));
        pieces.insert(pieces.end(), piece.left.begin(), piece.left.end());
    }
    CHECK(pieces == whole.left);
}

TEST_CASE("sweep player: a new wave begins at sample 0 of a sweep, and no step is steeper than allowed") {
    law("any wave after any other, told at any time", [] {
        SweepPlayer player(channels(), 800);
        std::vector<double> left;
        const auto play = [&](std::size_t frames) {
            const auto some = heard(player, frames);
            left.insert(left.end(), some.left.begin(), some.left.end());
        };
        for (int i = 0; i < 4; ++i) {
            play(*rc::gen::inRange<std::size_t>(1, 2000));
            const double middle = *rc::gen::inRange(-100, 101);
            const auto wave = cosine(*rc::gen::inRange(0, 150), middle, *rc::gen::inRange(0, 8) / 8.0);
            const auto change = player.swap(wave);
            RC_ASSERT(change.has_value());
            RC_ASSERT(change->startsAt >= player.frames());
            RC_ASSERT(change->startsAt % 800 == 0);
            RC_ASSERT(change->completeAt == change->startsAt + std::int64_t{800} * change->fadeSweeps);
            play(static_cast<std::size_t>(change->completeAt - player.frames()) + 801);
            const auto at = static_cast<std::size_t>(change->completeAt);
            for (std::size_t s = 0; s < 800; ++s)
                RC_ASSERT(std::abs(left[at + s] - wave.left[s] * 1e3) <= kCodeMilliamperes);
        }
        RC_ASSERT(steepest(left) <= kMostStepMilliamperes);
    });
}

TEST_CASE("sweep player: a wave that starts where the other ends follows it directly") {
    SweepPlayer player(channels(), 800);
    REQUIRE(player.swap(cosine(100.0, 20.0, 0.25)));
    heard(player, 4000);
    const auto change = player.swap(cosine(120.0, 20.0, 0.25));
    REQUIRE(change);
    CHECK(change->fadeSweeps == 0);
    CHECK(change->completeAt == change->startsAt);
}

TEST_CASE("sweep player: a change while another one fades is refused, one that waits is replaced") {
    SweepPlayer player(channels(), 800);
    heard(player, 10);
    REQUIRE(player.swap(cosine(200.0)));
    const auto instead = player.swap(cosine(-200.0));
    REQUIRE(instead);
    CHECK(instead->startsAt == 800);
    CHECK(instead->fadeSweeps == 1);
    heard(player, 1000);
    CHECK(player.swap(cosine(10.0)).error().fault == Fault::device);
    heard(player, 590);
    const auto wave = heard(player, 1);
    CHECK(wave.left[0] == doctest::Approx(-200.0).epsilon(1e-3));
    CHECK(player.swap(cosine(10.0)));
    CHECK(player.swap(cosine(10.0, 0.0, 0.0, 960)).error().fault == Fault::unsupported);
}

TEST_CASE("sweep player: slips make single sweeps one sample longer or shorter and nothing else") {
    law("the wave goes on as before, moved by the slips", [] {
        SweepPlayer player(channels(), 800);
        const auto wave = cosine(200.0);
        const auto change = player.swap(wave);
        RC_ASSERT(change.has_value());
        heard(player, static_cast<std::size_t>(change->completeAt));
        const int slips = *rc::gen::inRange(-5, 6);
        player.slip(slips);
        const auto frames = std::size_t{800} * 6 + static_cast<std::size_t>(slips);
        const auto slipped = heard(player, frames);
        const auto after = heard(player, 800);
        for (std::size_t s = 0; s < 800; ++s)
            RC_ASSERT(std::abs(after.left[s] - wave.left[s] * 1e3) <= kCodeMilliamperes);
        // 200 mA at 60 Hz: 1.57 mA a sample at most; a slip is at the flattest place.
        RC_ASSERT(steepest(slipped.left) <= 1.58 + 2.0 * kCodeMilliamperes);
        const auto place = player.placeOf(static_cast<double>(change->completeAt) + static_cast<double>(frames) + 3.25);
        RC_ASSERT(place.has_value());
        RC_ASSERT(std::abs(place->offset - 3.25) < 1e-9);
        RC_ASSERT(place->moved == slips);
    });
}

TEST_CASE("sweep player: a shift moves the sweep's start without a jump") {
    law("shifted", [] {
        SweepPlayer player(channels(), 800);
        const auto wave = cosine(200.0);
        heard(player, static_cast<std::size_t>(player.swap(wave)->completeAt) + *rc::gen::inRange<std::size_t>(1, 800));
        const int by = *rc::gen::inRange(-400, 401);
        const auto before = player.frames();
        const auto change = player.shift(by);
        RC_ASSERT(change.has_value());
        RC_ASSERT(change->completeAt > before);
        const auto fade = heard(player, static_cast<std::size_t>(change->completeAt - before) + 1600);
        RC_ASSERT(steepest(fade.left) <= kMostStepMilliamperes);
        // Two sweeps later the wave starts `by` samples after where it would have.
        const auto after = heard(player, 2400);
        const auto at = static_cast<double>(player.frames()) - 800.0;
        const auto place = player.placeOf(at);
        RC_ASSERT(place.has_value());
        RC_ASSERT((place->moved - by) % 800 == 0);
        const double old = at - static_cast<double>(change->startsAt);
        RC_ASSERT(std::abs(std::remainder(old - by - place->offset, 800.0)) < 1e-9);
        const auto sample = static_cast<std::size_t>(std::lround(place->offset + 800.0)) % 800;
        RC_ASSERT(std::abs(after.left[1600] - wave.left[sample] * 1e3) <= kCodeMilliamperes);
    });
}

TEST_CASE("sweep player: waves that would have to be clipped are refused with what would help") {
    CHECK(sampled(channels(), driven(200.0), driven(200.0))->size() == 800);
    const auto tooMuch = sampled(channels(), driven(200.0), driven(260.0));
    CHECK(tooMuch.error().fault == Fault::unsafe);
    CHECK(tooMuch.error().what == "The wave of the right lens needs 260 mA and its amplifier may give 250 mA. Choose a "
                                  "smaller sweep, or check the "
                                  "amplifier in the rig.");
    auto slow = channels();
    slow.left.amplifier.slew = AmperePerSecond::fromSi(50.0);
    const auto tooSteep = sampled(slow, driven(200.0), driven(200.0));
    CHECK(tooSteep.error().fault == Fault::unsafe);
    CHECK(tooSteep.error().what.find("changes faster") != std::string::npos);
    CHECK(sampled(channels(), driven(1.0), driven(1.0, 50.0_Hz)).error().fault == Fault::unsupported);
    CHECK(sampled(channels(), driven(1.0, 59.94_Hz), driven(1.0, 59.94_Hz)).error().fault == Fault::unsupported);
    Waveform none = driven(1.0);
    none.drive.c.clear();
    CHECK(sampled(channels(), none, driven(1.0)).error().fault == Fault::unsupported);
    none.drive.c = {std::nan("")};
    CHECK(sampled(channels(), none, driven(1.0)).error().fault == Fault::badFile);
}

TEST_CASE("sweep player: drives in volts are those at the amplifier's input, sample for sample") {
    Waveform wave = driven(0.0);
    wave.unit = DriveUnit::volt;
    wave.drive.c = {0.01, {0.02, -0.03}, {0.0, 0.005}};
    const auto samples = sampled(channels(), wave, wave);
    REQUIRE(samples);
    for (std::size_t i = 0; i < 800; ++i)
        CHECK(samples->left[i] == doctest::Approx(wave.drive.at(static_cast<double>(i) / 800.0) / 0.28));
}

}  // namespace ilf::devices
