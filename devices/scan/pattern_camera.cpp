#include <algorithm>
#include <cmath>

#include "core/base/as_text.h"
#include "core/base/grey.h"
#include "devices/scan/captured_scan.h"
#include "devices/scan/pair_proof.h"

namespace ilf::devices {
namespace {

using enum Pattern::Kind;

constexpr Pattern kWhite{white, 0, false}, kBlack{black, 0, false};
/// A camera that gives nothing new for this long has stopped.
constexpr Second kSilence = Second::fromSi(3.0);
/// What a camera's own exposure may be where it cannot be set.
constexpr Second kUnknownExposure = Second::fromSi(1.0 / 15.0);
/// Two frames of the same differ by noise alone: so much more than two others did, codes.
constexpr double kNoiseRoom = 0.5, kNoiseFactor = 1.25;
/// Frames until one is like the one before it; a view that flickers never is.
constexpr int kSettling = 10;
/// A share of what is lit that looks different, beyond noise: somebody moved something.
constexpr double kMoved = 0.005;
constexpr const char* kPreviousFrames = "The camera gives previous frames again: what is shown reaches its pictures "
                                        "late, and later than before. Use a camera without a queue, or a machine "
                                        "that has less to do.";
/// Further frames in which a very late camera shows that it is one.
constexpr int kVeryLate = 20;
/// Room enough below the sensor's end, light enough above its noise: mean of the brightest hundredth.
constexpr int kBrightest = 250, kBrightEnough = 90;
constexpr int kMostSweeps = 16;
constexpr int kNothing = 3;
/// Frames in which an automatic exposure finds itself.
constexpr int kAdapting = 10;

/// The code that a hundredth of the pixels reach.
int brightest(const Image<std::uint8_t>& grey) {
    std::array<std::size_t, 256> count{};
    for (const std::uint8_t code : grey.pixels())
        ++count[code];
    std::size_t above = 0;
    for (int code = 255; code > 0; --code) {
        above += count[static_cast<std::size_t>(code)];
        if (100 * above >= grey.pixels().size()) return code;
    }
    return 0;
}

/// The share of pixels that are brighter under white, less those darker, which only noise makes: noise alone gives
/// none.
double shareLit(const Image<std::uint8_t>& white, const Image<std::uint8_t>& black) {
    std::ptrdiff_t lit = 0;
    for (std::size_t i = 0; i < white.pixels().size(); ++i) {
        const int w = white.pixels()[i], b = black.pixels()[i];
        lit += (w >= b + 8 ? 1 : 0) - (b >= w + 8 ? 1 : 0);
    }
    return static_cast<double>(lit) / static_cast<double>(std::max<std::size_t>(1, white.pixels().size()));
}

}  // namespace

PatternCamera::PatternCamera(CameraSource& camera, PatternShow& show, ScanWish wish, ScanWatch watch,
                             std::stop_token stop)
    : camera_(camera), show_(show), wish_(wish), watch_(std::move(watch)), stop_(std::move(stop)) {}

void PatternCamera::tell(ScanProgress::Step step, int done, int all, std::string words) const {
    if (watch_) watch_({step, done, all, std::move(words), newest_});
}

Result<Image<std::uint8_t>> PatternCamera::frame() {
    const Second begun = steadyNow();
    while (true) {
        if (stop_.stop_requested())
            return fail(Fault::device, "The scan was cancelled; the light is steady and white again.");
        auto read = camera_.read();
        if (!read) return tl::unexpected(read.error());
        if (*read) {
            auto grey = greyOf((*read)->rgb);
            if (!newest_.empty() && grey.size() != newest_.size())
                return fail(Fault::device, camera_.name() + " changed the size of its pictures while it was scanning; "
                                                            "leave its settings alone and scan again.");
            frameTime_ = (*read)->time;
            return newest_ = std::move(grey);
        }
        if (steadyNow() - begun > kSilence)
            return fail(Fault::device,
                        camera_.name() + " gives no pictures any more: check its cable, then scan again.");
    }
}

Result<Image<std::uint8_t>> PatternCamera::taken(const Pattern& pattern, int late) {
    const auto lit = show_.show(patternPicture(pattern, show_.projector()));
    if (!lit) return tl::unexpected(lit.error());
    // A frame whose exposure began before first light shows something of what was there before.
    const Second exposure = facts_.exposure > 0.0_s ? facts_.exposure : kUnknownExposure;
    const Second fresh = *lit + exposure + show_.sweep();
    int passed = 0, unsettled = 0;
    Image<std::uint8_t> before;
    while (true) {
        const auto picture = frame();
        if (!picture) return picture;
        // Where there is no light at all there is nothing that could differ.
        const bool repeated = (*picture == last_ || *picture == before) && brightest(*picture) > kNothing;
        if (repeated && frameTime_ - fresh > kSilence) return tl::unexpected(frozen());
        if (frameTime_ < fresh || repeated || passed++ < late) continue;
        const bool settled =
            noise_ == 0.0 || (!before.empty() && meanDifference(*picture, before) < kNoiseFactor * noise_ + kNoiseRoom);
        if (settled) return last_ = *picture;
        before = *picture;
        if (++unsettled > kSettling) {
            return fail(Fault::device,
                        "What the camera sees does not come to rest while one pattern is shown: something "
                        "moves in its view, or other light flickers. Keep the view still, switch the "
                        "other light off, and scan again.");
        }
    }
}

Error PatternCamera::frozen() const {
    return {Fault::device, camera_.name() + " is frozen: it gives the same picture again and again, whatever is "
                                            "shown. Plug it in again, then scan again."};
}

Result<void> PatternCamera::begin() {
    tell(ScanProgress::Step::light, 0, 4, "Setting the exposure under white light");
    if (const auto set = findExposure(); !set) return set;
    tell(ScanProgress::Step::light, 1, 4, "Looking at the room's light");
    if (const auto found = findLateness(); !found) return found;
    tell(ScanProgress::Step::marker, 3, 4, "Looking for a marker, so that no other screen is scanned");
    return seesMarker();
}

Result<void> PatternCamera::findExposure() {
    const Second sweep = show_.sweep();
    int sweeps = wish_.sweeps > 0 ? wish_.sweeps : 2;
    const auto set = [&](int count) {
        const auto exposure = camera_.setExposure(count * sweep);
        if (exposure) facts_.exposure = *exposure;
        return exposure.has_value();
    };
    const bool settable = set(sweeps);
    auto picture = taken(kWhite, kAdapting);
    if (!picture) return tl::unexpected(picture.error());
    if (const auto locked = camera_.lockExposure(true); !locked) facts_.remarks.push_back(locked.error().what);
    if (!settable) {
        facts_.remarks.push_back(camera_.name() +
                                 " does not let its exposure be set to whole sweeps, so pictures may differ in "
                                 "brightness; a scan that fails may need another camera.");
        return {};
    }
    for (int tries = 0; tries < 5 && wish_.sweeps == 0; ++tries) {
        const int code = brightest(*picture);
        int better = sweeps;
        if (code > kBrightest) better = std::max(1, sweeps / 2);
        if (code < kBrightEnough) better = std::min(kMostSweeps, 2 * sweeps);
        if (better == sweeps || !set(better)) break;
        sweeps = better;
        picture = taken(kWhite, wish_.mostLate);
        if (!picture) return tl::unexpected(picture.error());
        if (code > kBrightest && brightest(*picture) < kBrightEnough) break;  // neither is good: the brighter one was
    }
    return {};
}

Error PatternCamera::nothingFollows() const {
    // Where gain makes up for light, a picture is bright with noise: two then differ by a good part of what they show.
    const Image<std::uint8_t> none(white_.size(), 1, std::vector<std::uint8_t>(white_.pixels().size(), 0));
    if (brightest(white_) < 24 || meanDifference(white_, black_) > 0.2 * meanDifference(white_, none)) {
        return {Fault::device, "It is too dark: what is shown can hardly be seen, even in white. Open the lens's "
                               "aperture, allow longer exposures, or move the camera nearer."};
    }
    if (brightest(black_) >= 254) {
        return {Fault::device, "The pictures are saturated even where black is shown, so nothing of the patterns is "
                               "left. Close the lens's aperture or take other light away."};
    }
    return {Fault::device, "What the camera sees does not follow what is shown: the light in its view is another "
                           "screen's, or the patterns are on another display, or the projector is off or covered. "
                           "Check which display is the projector's (Rig) and where the camera looks."};
}

Result<void> PatternCamera::findLateness() {
    auto seen = taken(kWhite, wish_.mostLate);
    if (!seen) return tl::unexpected(seen.error());
    white_ = *seen;
    seen = frame();
    if (!seen) return tl::unexpected(seen.error());
    const double whiteNoise = meanDifference(white_, *seen);
    // From the first frame on whose whole exposure may have been of black, one after the other, until they have long
    // shown the same. `taken` trusts frames a sweep later only; counted from there, a camera seemed to be less late
    // than it is when a frame fell in between.
    const auto lit = show_.show(patternPicture(kBlack, show_.projector()));
    if (!lit) return tl::unexpected(lit.error());
    const Second whole = *lit + (facts_.exposure > 0.0_s ? facts_.exposure : kUnknownExposure);
    std::vector<Image<std::uint8_t>> frames;
    for (int trusted = 0; trusted < wish_.mostLate + 2;) {
        seen = frame();
        if (!seen) return tl::unexpected(seen.error());
        const bool repeated = frames.empty() && *seen == last_ && brightest(*seen) > kNothing;
        if (repeated && frameTime_ - whole > kSilence) return tl::unexpected(frozen());
        if (frameTime_ < whole || repeated) continue;
        frames.push_back(*seen);
        trusted += frameTime_ >= whole + show_.sweep() ? 1 : 0;
    }
    black_ = last_ = frames.back();
    if (const auto follows = somethingFollows(); !follows) return follows;
    const auto ambient = ambientCheck(white_, black_);
    if (!ambient) return tl::unexpected(ambient.error());
    facts_.ambient = *ambient;
    if (!ambient->go && !wish_.anyway) return fail(Fault::device, ambient->what);
    noise_ = std::max(0.01, std::max(whiteNoise, meanDifference(frames[frames.size() - 2], black_)));
    facts_.late = 0;
    for (std::size_t i = 0; i + 1 < frames.size(); ++i) {
        if (meanDifference(frames[i], black_) > kNoiseFactor * noise_ + kNoiseRoom)
            facts_.late = static_cast<int>(i) + 1;
    }
    if (facts_.late > wish_.mostLate) {
        return fail(Fault::device,
                    "The camera's pictures still change " + std::to_string(facts_.late) +
                        " frames after a pattern does: it sees previous frames, or something in its "
                        "view moves or flickers. Use a camera without a queue, and keep the view still.");
    }
    // White once more, to know how far two pictures of the same differ.
    const auto again = taken(kWhite, facts_.late);
    if (!again) return tl::unexpected(again.error());
    restless_ = changed(*again);
    return {};
}

/// The difference of white and black reaches the picture; where it comes much later than it should, says so.
Result<void> PatternCamera::somethingFollows() {
    if (shareLit(white_, black_) >= 0.01) return {};
    for (int i = 0; i < kVeryLate; ++i) {
        const auto later = frame();
        if (!later) return tl::unexpected(later.error());
        if (shareLit(white_, *later) >= 0.01 && brightest(white_) >= 24) {
            return fail(Fault::device, "The camera gives previous frames: what is shown reaches its pictures only " +
                                           std::to_string(wish_.mostLate + 3 + i) +
                                           " frames later. Use a camera without a queue, or fewer buffers.");
        }
    }
    return tl::unexpected(nothingFollows());
}

double PatternCamera::changed(const Image<std::uint8_t>& picture) const {
    std::size_t lit = 0, other = 0;
    for (std::size_t i = 0; i < white_.pixels().size(); ++i) {
        const int white = white_.pixels()[i], black = black_.pixels()[i];
        if (!clearlyLit(white, black)) continue;
        ++lit;
        other += looksDifferent(white, black, picture.pixels()[i]) ? 1 : 0;
    }
    return lit == 0 ? 0.0 : static_cast<double>(other) / static_cast<double>(lit);
}

Result<void> PatternCamera::seesMarker() {
    const Pattern marker{Pattern::Kind::marker, 0, false};
    const auto both = pair(marker);
    if (!both) return tl::unexpected(both.error());
    return {};
}

Result<PatternCamera::Pair> PatternCamera::pair(const Pattern& pattern) {
    Pattern inverse = pattern;
    inverse.inverse = true;
    PairProof proof;
    for (int late = facts_.late; late <= std::max(wish_.mostLate, facts_.late + 1); ++late) {
        auto first = taken(pattern, late);
        if (!first) return tl::unexpected(first.error());
        auto second = taken(inverse, late);
        if (!second) return tl::unexpected(second.error());
        proof = pairProof(white_, black_, *first, *second);
        if (proof.lit == 0.0 || proof.holds()) {
            facts_.late = late;
            return Pair{*std::move(first), *std::move(second)};
        }
        ++facts_.repeated;
    }
    if (const auto still = unmoved(); !still) return tl::unexpected(still.error());
    if (pattern.kind == Pattern::Kind::marker) {
        // Noise can look like light that is enough: then no figure of it holds.
        const Error why = nothingFollows();
        facts_.ambient.go = false;
        facts_.ambient.what = why.what;
        return tl::unexpected(why);
    }
    return fail(Fault::device, "The camera gives previous frames again: a pattern and its inverse are the same on " +
                                   asText("%.0f %%", 100.0 * proof.same) + " of what is lit, even " +
                                   std::to_string(std::max(wish_.mostLate, facts_.late + 1)) +
                                   " frames later. Use a camera without a queue, or a steadier machine.");
}

Result<void> PatternCamera::unmoved() {
    const auto again = taken(kWhite, std::max(facts_.late, 1));
    if (!again) return tl::unexpected(again.error());
    // Where white was clearly lit, it must be as bright as it was.
    const double other = changed(*again);
    if (other <= restless_ + kMoved) return {};
    // What looks as it did after all, only much later, has not moved.
    for (int i = 0; i < kVeryLate; ++i) {
        if (const auto later = frame(); !later) return tl::unexpected(later.error());
        if (changed(newest_) <= restless_ + kMoved) return fail(Fault::device, kPreviousFrames);
    }
    moved_ = *again;
    return fail(Fault::device, "Something moved while it was scanned: " + asText("%.1f %%", 100.0 * other) +
                                   " of what is lit looks different under the same white light than before. Keep "
                                   "camera, projector and things still, hands out of the view, and scan again.");
}

}  // namespace ilf::devices
