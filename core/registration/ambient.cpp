#include "core/registration/ambient.h"

#include <algorithm>
#include <array>
#include <cstddef>

#include "core/base/as_text.h"

namespace ilf {

namespace {

template <std::size_t N>
double median(const std::array<int, N>& histogram) {
    int total = 0;
    for (const int count : histogram)
        total += count;
    int below = 0;
    for (std::size_t value = 0; value < N; ++value) {
        below += histogram[value];
        if (2 * below >= total) return static_cast<double>(value);
    }
    return 0.0;
}

std::string percent(double share) { return asText("%.0f %%", 100.0 * share); }

}  // namespace

Result<AmbientCheck> ambientCheck(const Image<std::uint8_t>& white, const Image<std::uint8_t>& black) {
    if (white.empty() || white.size() != black.size() || white.channels() != 1 || black.channels() != 1) {
        return fail(Fault::outOfRange,
                    "The white and the black picture must be grey and of one size: take both in one camera mode.");
    }
    constexpr int kLit = 5;
    std::array<int, 256> contrasts{};
    std::array<int, 1001> shares{};
    int lit = 0, saturated = 0;
    const auto w = white.pixels(), b = black.pixels();
    for (std::size_t n = 0; n < w.size(); ++n) {
        saturated += w[n] == 255;
        const int contrast = w[n] - b[n];
        // At the end of the range the share cannot be told, unless black alone already ends there.
        if (contrast < kLit || (w[n] == 255 && b[n] < 255)) continue;
        ++lit;
        ++contrasts[static_cast<std::size_t>(contrast)];
        ++shares[static_cast<std::size_t>(1000 * contrast / w[n])];
    }
    AmbientCheck check;
    const auto pixels = static_cast<double>(w.size());
    check.lit = lit / pixels;
    check.saturated = saturated / pixels;
    check.contrast = median(contrasts);
    check.projectorShare = median(shares) / 1000.0;
    // Below a third the room is twice as bright as the projector, and its flicker alone hides a bit. Twelve levels are
    // three times what two noisy 8-bit pictures (2 levels each) and a margin of 10 % leave.
    constexpr double kLeastShare = 1.0 / 3.0, kLeastContrast = 12.0, kLeastLit = 0.02, kMostSaturated = 0.1;
    if (check.saturated > kMostSaturated) {
        check.what = percent(check.saturated) +
                     " of the white picture is at the end of the camera's range: shorten the exposure or close the "
                     "aperture.";
    } else if (check.lit < kLeastLit) {
        check.what = "The projector's light reaches only " + percent(check.lit) +
                     " of the picture: see that it shines where the camera looks, and that no other light drowns it.";
    } else if (check.projectorShare < kLeastShare) {
        check.what = "Only " + percent(check.projectorShare) +
                     " of the light is the projector's: dim the room or bring the projector nearer.";
    } else if (check.contrast < kLeastContrast) {
        check.what = "White is only " + asText("%.0f", check.contrast) +
                     " of 255 above black: expose longer, open the aperture, or raise the camera's gain.";
    } else {
        check.go = true;
        check.what = "Go: " + percent(check.projectorShare) + " of the light is the projector's, on " +
                     percent(check.lit) + " of the picture.";
    }
    return check;
}

}  // namespace ilf
