// Whether two pictures show a pattern and its inverse, or one of them what was shown before.
#pragma once

#include <cstdint>

#include "core/base/image.h"

namespace ilf::devices {

/// Of the pixels that white lights clearly. Where both pictures are bright, or both dark, they are no pair: one of them
/// shows something else. Stripes too fine for the camera are between the two in both pictures and say nothing.
struct PairProof {
    double lit = 0.0;   ///< pixels that count, of all
    double same = 0.0;  ///< both bright or both dark, of those
    double told = 0.0;  ///< one bright and one dark, of those
    /// Edges, gloss and inter-reflection leave a few; a picture of the pattern before leaves about half.
    bool holds() const { return lit > 0.0 && same < 0.12; }
};
/// All grey and of one size.
PairProof pairProof(const Image<std::uint8_t>& white, const Image<std::uint8_t>& black,
                    const Image<std::uint8_t>& picture, const Image<std::uint8_t>& inverse);

/// Codes of one pixel: white is told from black well above noise.
bool clearlyLit(int white, int black);
/// And it is not as it was, beyond noise, now that white is shown `again`.
bool looksDifferent(int white, int black, int again);

/// Mean difference of two grey pictures of one size, codes.
double meanDifference(const Image<std::uint8_t>& a, const Image<std::uint8_t>& b);

}  // namespace ilf::devices
