// Deterministic noise for procedural materials: the same on every machine, since it hashes integers.
#pragma once

#include <cstdint>

#include "vec.h"

namespace ilf::samples {

/// 0..1, the same for the same cell.
inline float hashed(int x, int y, int z) {
    auto h = std::uint32_t(x) * 0x8da6b343u ^ std::uint32_t(y) * 0xd8163841u ^ std::uint32_t(z) * 0xcb1ab31fu;
    h ^= h >> 16;
    h *= 0x7feb352du;
    h ^= h >> 15;
    h *= 0x846ca68bu;
    h ^= h >> 16;
    return float(h >> 8) * (1.0f / 16777216.0f);
}

/// Smooth value noise, 0..1, one feature a unit.
inline float noise(V3 p) {
    const float fx = std::floor(p.x), fy = std::floor(p.y), fz = std::floor(p.z);
    const int x = int(fx), y = int(fy), z = int(fz);
    const auto fade = [](float t) { return t * t * t * (t * (t * 6.0f - 15.0f) + 10.0f); };
    const float u = fade(p.x - fx), v = fade(p.y - fy), w = fade(p.z - fz);
    const auto row = [&](int j, int k) { return mix(hashed(x, y + j, z + k), hashed(x + 1, y + j, z + k), u); };
    return mix(mix(row(0, 0), row(1, 0), v), mix(row(0, 1), row(1, 1), v), w);
}

/// Octaves of noise, about 0..1, mean a half.
inline float fbm(V3 p, int octaves) {
    float sum = 0.0f, weight = 0.5f;
    for (int i = 0; i < octaves; ++i, weight *= 0.5f) {
        sum += weight * noise(p);
        p = p * 2.03f + V3{17.3f, -5.1f, 9.7f};
    }
    return sum + weight;
}

}  // namespace ilf::samples
