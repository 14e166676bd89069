// The sRGB transfer function, exactly, for single values and for whole pictures.
#pragma once

#include <cstddef>
#include <cstdint>

#include "core/base/image.h"

namespace ilf {

/// Linear light 0..1 of an sRGB-encoded value 0..1 (IEC 61966-2-1).
double linearFromSrgb(double encoded);
/// The way back; values outside 0..1 are clamped.
double srgbFromLinear(double linear);

/// Linear light of a picture, same size and channels; 65535 becomes 1.
Radiance toLinear(const Picture& picture);

/// The sRGB code 0..255 nearest to a linear value; NaN becomes 0.
std::uint8_t srgb8(float linear);
/// Codes of a whole picture of linear light, same size and channels.
Image<std::uint8_t> toSrgb8(const Radiance& radiance);
/// Codes of `count` pixels of three planes of linear light, as RGBA with alpha 255: each as `srgb8` gives it.
void srgb8FromPlanes(const float* red, const float* green, const float* blue, std::size_t count, std::uint8_t* rgba);
/// The upper eight bits of a picture, rounded: v / 257.
Image<std::uint8_t> toBytes(const Picture& picture);
/// The way back: v * 257.
Picture toPicture(const Image<std::uint8_t>& rgb);

}  // namespace ilf
