// Synthetic pictures, the same for every run: text-like black and white, natural noise, point lights.
#pragma once

#include <vector>

#include "core/base/image.h"

namespace ilf::bench {

enum class Texture { text, natural, lights };

/// Linear radiance 0..1 of one channel, row by row. `text`: strokes 1 to 3 px wide in lines and words (the worst case
/// for a blur's error); `natural`: value noise of five octaves with hard-edged shapes; `lights`: single pixels of 1 on
/// black.
std::vector<float> plane(Size size, Texture texture, unsigned seed);

/// All three in colour, in fields of an eighth of the picture's width. Encoded as pictures are (sRGB, 16 bits).
Picture mixedPicture(Size size, unsigned seed);

}  // namespace ilf::bench
