// Intended against received light of one sweep: slot by slot, pixel by pixel, in numbers and in words.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/base/image.h"
#include "core/base/quantity.h"

namespace ilf::devices {

/// Light of one slot. Times count from the start of its sweep (intended), or from the trigger of the sweep in which it
/// was taken (received).
struct SlotLight {
    Image<std::uint8_t> light;  ///< one channel, linear, 255 = full; the projector's raster
    Second start, length;
    unsigned colours = 7;  ///< of the lamp while it lasted: red 1, green 2, blue 4; all: white
};

/// What became of one intended slot.
struct SlotDifference {
    bool missing = false;  ///< no light was taken while it was due; then all its pixels differ
    std::int64_t differingPixels = 0;
    int largest = 0;      ///< |received - intended|, 0 ... 255
    double mean = 0.0;    ///< of the same, over all pixels
    Second late, longer;  ///< received minus intended: start and length; 0 where missing
    bool operator==(const SlotDifference&) const = default;
};

struct LightComparison {
    std::vector<SlotDifference> slots;  ///< one for each intended slot
    int missing = 0;
    int extra = 0;  ///< lit intervals that belong to no intended slot
    std::int64_t differingPixels = 0;
    /// The slots' `late`, and the most that one departs from it: a constant delay against unsteady light.
    Second offset, jitter;
    bool operator==(const LightComparison&) const = default;

    /// Every pixel of every slot as intended, and nothing besides.
    bool same() const { return differingPixels == 0 && missing == 0 && extra == 0; }
};

/// A received slot belongs to the intended slot whose start is nearest, if that is less than half of that slot away;
/// of several, the nearest. Light of other colours differs in every pixel that is or should be lit. Pictures of
/// different sizes differ in all intended pixels. The projector's quantisation is no difference if `intended` is
/// already quantised.
LightComparison compared(const std::vector<SlotLight>& intended, const std::vector<SlotLight>& received);

/// One line: "24 slots as intended, 0 differing pixels, starts +0.00 ms (+-0.00 ms)".
std::string verdict(const LightComparison& comparison);

}  // namespace ilf::devices
