// Looks of surfaces made from noise: stone, wood, metal, paper, cloth; points are metres in the object's own frame.
#pragma once

#include "noise.h"
#include "scene.h"

namespace ilf::samples {

inline Surface plain(V3 colour, float gloss = 0.0f, float roughness = 0.6f) { return {colour, gloss, roughness}; }

/// Smooth paint under varnish.
inline Surface lacquered(V3 colour) { return {colour, 0.045f, 0.18f}; }

/// White stone with soft grey veins.
inline Surface marble(V3 p) {
    const V3 warped = p * 9.0f + V3{fbm(p * 14.0f, 4), fbm(p * 14.0f + V3{3, 7, 1}, 4), 0.0f} * 2.2f;
    const float vein = 1.0f - std::fabs(2.0f * fbm(warped, 4) - 1.0f);
    const float dark = smoothstep(0.90f, 1.0f, vein) * (0.4f + 0.6f * noise(p * 11.0f));
    const V3 stone = mix(V3{0.60f, 0.57f, 0.52f}, V3{0.53f, 0.50f, 0.45f}, noise(p * 22.0f));
    return {mix(stone, {0.36f, 0.345f, 0.335f}, 0.5f * dark), 0.03f, 0.42f};
}

/// Dark polished stone with light grains.
inline Surface granite(V3 p, V3 colour = {0.075f, 0.078f, 0.085f}) {
    const float grain = smoothstep(0.55f, 0.9f, noise(p * 900.0f)) + 0.4f * smoothstep(0.5f, 0.9f, fbm(p * 260.0f, 2));
    return {colour * (0.8f + 0.5f * fbm(p * 60.0f, 3)) + V3{0.05f, 0.05f, 0.052f} * grain, 0.05f, 0.25f};
}

/// Boards along x: rings cut lengthways, pores, each board its own tone. `board` metres wide along z.
inline Surface wood(V3 p, V3 light, V3 dark, float board, float gloss = 0.03f) {
    const float row = std::floor(p.z / board);
    const float own = hashed(int(row), 3, 9);
    const V3 q{p.x * 1.3f + own * 31.0f, p.y * 9.0f + own * 17.0f, p.z * 9.0f};
    const float rings = q.z * 4.2f + 3.0f * fbm(q * V3{1.1f, 1.0f, 1.0f}, 3) + 0.35f * noise(q * V3{3.0f, 8.0f, 8.0f});
    const float ring = std::pow(0.5f + 0.5f * std::sin(rings * 2.0f * kPi * 0.75f), 1.6f);
    const float pores = smoothstep(0.62f, 0.9f, noise(p * V3{45.0f, 300.0f, 900.0f}));
    V3 colour = mix(light, dark, 0.42f * ring + 0.30f * own + 0.25f * (fbm(q * V3{0.7f, 1.5f, 1.5f}, 3) - 0.5f)) *
                (1.0f - 0.22f * pores);
    const float seam = std::fabs(p.z / board - row - 0.5f);
    colour = colour * (1.0f - 0.55f * smoothstep(0.4935f, 0.4985f, seam));
    return {colour, gloss, 0.42f};
}

/// Steel or brass drawn along x.
inline Surface brushed(V3 p, V3 colour, float roughness = 0.3f) {
    const float hair = noise(p * V3{40.0f, 2200.0f, 2200.0f}) - 0.5f;
    return {colour * (0.92f + 0.25f * hair), 0.62f, roughness, true, V3{0.0f, 0.05f, 0.05f} * hair};
}

/// Bronze with dark patina where it is seldom touched.
inline Surface bronze(V3 p) {
    const float patina = smoothstep(0.40f, 0.68f, fbm(p * 38.0f, 4));
    Surface s = brushed(p, mix(V3{0.62f, 0.40f, 0.19f}, V3{0.22f, 0.20f, 0.15f}, patina), 0.34f);
    s.bump = {};
    return s;
}

/// Painted wall or plinth, barely mottled.
inline Surface plaster(V3 p, V3 colour) { return {colour * (0.90f + 0.2f * fbm(p * 7.0f, 4)), 0.0f, 0.9f}; }

/// Woven cloth with threads `pitch` metres apart along x and y.
inline Surface cloth(V3 p, V3 colour, float pitch) {
    const float weave = std::sin(p.x / pitch * kPi) * std::sin(p.y / pitch * kPi);
    return {colour * (0.9f + 0.12f * weave + 0.15f * (fbm(p * 60.0f, 3) - 0.5f)), 0.0f, 0.95f};
}

}  // namespace ilf::samples
