#include "bust.h"

#include "noise.h"
#include "sdf.h"

namespace ilf::samples::bust {
namespace {

constexpr float kHeadUnit = 0.111f;  // metres: half the height from chin to crown
constexpr V3 kHeadCentre{0.0f, 0.474f, 0.016f};

// The head is modelled in half head heights about the point between the eyes: chin at -1, crown at +1.

float skull(V3 q, V3 m) {
    float d = ellipsoid(q - V3{0.0f, 0.28f, -0.10f}, {0.69f, 0.72f, 0.88f});
    d = join(d, ellipsoid(q - V3{0.0f, -0.22f, 0.22f}, {0.53f, 0.74f, 0.56f}), 0.22f);
    d = join(d, ellipsoid(q - V3{0.0f, -0.68f, 0.36f}, {0.31f, 0.27f, 0.34f}), 0.18f);
    d = join(d, sphere(q - V3{0.0f, -0.86f, 0.59f}, 0.115f), 0.18f);
    d = join(d, capsule(m, {0.42f, -0.44f, 0.00f}, {0.16f, -0.82f, 0.48f}, 0.09f), 0.24f);
    d = join(d, ellipsoid(m - V3{0.25f, -0.40f, 0.50f}, {0.20f, 0.22f, 0.19f}), 0.16f);  // full cheeks
    return join(d, ellipsoid(m - V3{0.35f, -0.18f, 0.55f}, {0.16f, 0.13f, 0.14f}), 0.22f);
}

float withEyes(float d, V3 m) {
    d = carve(d, ellipsoid(m - V3{0.275f, -0.005f, 0.88f}, {0.19f, 0.125f, 0.19f}), 0.13f);
    float brow = capsule(m, {0.09f, 0.150f, 0.775f}, {0.29f, 0.205f, 0.725f}, 0.050f);
    brow = join(brow, capsule(m, {0.29f, 0.205f, 0.725f}, {0.48f, 0.105f, 0.545f}, 0.045f), 0.05f);
    d = join(d, brow, 0.14f);

    const V3 e = m - V3{0.272f, -0.015f, 0.585f};
    const auto above = [&](float elevation) { return e.z * std::sin(elevation) - e.y * std::cos(elevation); };
    float ball = sphere(e, 0.168f);
    const V3 iris = e - V3{-0.012f, 0.020f, 0.172f};  // a drilled pupil inside a faintly cut ring, as the Romans did
    ball = carve(ball, sphere(iris, 0.034f), 0.02f);
    ball += 0.004f * smoothstep(0.018f, 0.0f, std::fabs(length(V2{iris.x, iris.y}) - 0.070f));
    const float upper = common(sphere(e, 0.192f), above(0.30f), 0.02f);
    const float lower = common(sphere(e, 0.183f), -above(-0.36f), 0.025f);
    d = join(d, ball, 0.012f);
    d = join(d, upper, 0.035f);
    return join(d, lower, 0.045f);
}

float withNose(float d, V3 q, V3 m) {
    d = join(d, taper(q, {0.0f, 0.13f, 0.745f}, {0.0f, -0.27f, 0.925f}, 0.056f, 0.066f), 0.13f);
    d = join(d, ellipsoid(q - V3{0.0f, -0.295f, 0.930f}, {0.076f, 0.070f, 0.088f}), 0.06f);
    d = join(d, ellipsoid(m - V3{0.088f, -0.330f, 0.840f}, {0.052f, 0.052f, 0.080f}), 0.060f);
    return carve(d, ellipsoid(m - V3{0.045f, -0.376f, 0.890f}, {0.022f, 0.025f, 0.035f}), 0.03f);
}

float withMouth(float d, V3 q, V3 m) {
    d = join(d, ellipsoid(q - V3{0.0f, -0.565f, 0.63f}, {0.25f, 0.17f, 0.165f}), 0.16f);
    d = carve(d, capsule(q, {0.0f, -0.42f, 0.890f}, {0.0f, -0.485f, 0.870f}, 0.016f), 0.05f);
    d = join(d, capsule(m, {0.040f, -0.532f, 0.800f}, {0.165f, -0.571f, 0.710f}, 0.052f), 0.045f);
    d = join(d, ellipsoid(q - V3{0.0f, -0.638f, 0.765f}, {0.135f, 0.055f, 0.075f}), 0.055f);
    float line = capsule(m, {0.0f, -0.580f, 0.860f}, {0.09f, -0.586f, 0.830f}, 0.010f);
    line = std::min(line, capsule(m, {0.09f, -0.586f, 0.830f}, {0.190f, -0.572f, 0.745f}, 0.010f));
    d = carve(d, line, 0.04f);
    return carve(d, ellipsoid(q - V3{0.0f, -0.735f, 0.85f}, {0.11f, 0.03f, 0.09f}), 0.11f);
}

float ear(V3 m) {
    const V3 e = turnedX(turnedY(m - V3{0.695f, -0.09f, -0.06f}, 0.35f), -0.15f);
    float d = ellipsoid(e, {0.055f, 0.205f, 0.130f});
    d = carve(d, ellipsoid(e - V3{0.055f, 0.03f, 0.015f}, {0.045f, 0.135f, 0.075f}), 0.03f);
    return join(d, sphere(e - V3{0.01f, -0.165f, 0.035f}, 0.05f), 0.05f);
}

float hair(V3 q) {
    // Locks run from the brow to the knot: meridians about the line between the two, made wavy.
    const V3 pole = normalized({0.0f, 0.62f, 0.78f}), sideways{1.0f, 0.0f, 0.0f}, up = cross(pole, sideways);
    const V3 c = q - V3{0.0f, 0.25f, -0.15f};
    const float along = std::acos(std::clamp(dot(normalized(c), pole), -1.0f, 1.0f));
    const float around = std::atan2(dot(c, sideways), dot(c, up));
    const float fine = smoothstep(0.12f, 0.7f, along) * smoothstep(3.0f, 2.4f, along);
    const float wave = 0.16f * std::sin(along * 7.5f + std::fabs(around) * 2.0f);
    const float lock = std::fabs(std::sin(10.0f * (around + wave * fine)));
    const float strand = std::sin(47.0f * (around + wave * fine) + 3.0f * along);
    float d = ellipsoid(q - V3{0.0f, 0.32f, -0.16f}, {0.775f, 0.785f, 0.94f});
    d = join(d, ellipsoid(mirrorX(q) - V3{0.60f, 0.13f, 0.10f}, {0.17f, 0.30f, 0.36f}), 0.16f);
    d -= fine * (0.045f * lock + 0.010f * strand) - 0.02f;
    const float knotTurn = std::sin(9.0f * std::atan2(q.x, q.y + 0.02f) + 9.0f * length(V2{q.x, q.y + 0.02f}));
    d = join(d, ellipsoid(q - V3{0.0f, -0.02f, -1.12f}, {0.30f, 0.30f, 0.26f}) - 0.02f * knotTurn, 0.08f);
    d = carve(d, ellipsoid(q - V3{0.0f, -0.34f, 0.95f}, {0.60f, 0.93f, 0.74f}), 0.07f);
    d = carve(d, 0.55f + q.y - 0.25f * q.z, 0.2f);
    // A ribbon holds it.
    const V3 band = turnedX(q - V3{0.0f, 0.50f, -0.12f}, 0.42f);
    const float ribbon =
        std::max(std::fabs(band.y) - 0.045f, ellipsoid(q - V3{0.0f, 0.32f, -0.16f}, {0.805f, 0.815f, 0.97f}));
    return std::max(join(d, ribbon, 0.02f), -ellipsoid(q - V3{0.0f, 0.26f, -0.10f}, {0.60f, 0.62f, 0.78f}));
}

float neck(V3 q, V3 m) {
    float d = taper(q, {0.0f, -0.50f, -0.14f}, {0.0f, -1.75f, -0.20f}, 0.31f, 0.38f);
    d = join(d, capsule(m, {0.46f, -0.42f, -0.18f}, {0.10f, -1.58f, 0.16f}, 0.07f), 0.16f);
    return carve(d, sphere(q - V3{0.0f, -1.62f, 0.33f}, 0.07f), 0.12f);
}

/// Cloth that hangs: rounded ridges `wave` metres apart along `u`, sharp valleys between.
float fold(float u, float wave) {
    const float s = std::sin(u * kPi / wave);
    return std::sqrt(s * s + 0.03f);
}

}  // namespace

float head(V3 p) {
    const float away = sphere(p - kHeadCentre - V3{0.0f, -0.03f, 0.0f}, 0.19f);
    if (away > 0.06f) return away;
    // Inclined a little to her right and down, towards what she holds.
    const V3 q = turnedX(turnedZ(turnedY(p - kHeadCentre, 0.10f), -0.05f), -0.10f) / kHeadUnit;
    const V3 m = mirrorX(q);
    float d = skull(q, m);
    d = withEyes(d, m);
    d = withNose(d, q, m);
    d = withMouth(d, q, m);
    d = join(d, ear(m), 0.05f);
    d = join(d, neck(q, m), 0.14f);
    d = join(d, hair(q), 0.03f);
    return 0.72f * d * kHeadUnit;
}

float body(V3 p) {
    const float away = box(p - V3{0.0f, 0.16f, 0.03f}, {0.30f, 0.23f, 0.20f});
    if (away > 0.06f) return away;
    p.x /= 0.90f;
    const V3 m = mirrorX(p);
    float d = ellipsoid(p - V3{0.0f, 0.19f, 0.0f}, {0.138f, 0.190f, 0.092f});
    d = join(d, capsule(m, {0.05f, 0.300f, -0.012f}, {0.148f, 0.278f, -0.012f}, 0.050f), 0.05f);
    d = join(d, taper(m, {0.02f, 0.345f, -0.02f}, {0.12f, 0.300f, -0.015f}, 0.034f, 0.036f), 0.04f);
    for (const float side : {-1.0f, 1.0f})  // both, since they meet in the middle
        d = join(d, ellipsoid(p - V3{side * 0.062f, 0.205f, 0.060f}, {0.056f, 0.056f, 0.048f}), 0.05f);
    d = join(d, ellipsoid(p - V3{0.0f, 0.02f, 0.0f}, {0.190f, 0.150f, 0.125f}), 0.08f);
    d = join(d, taper(m, {0.182f, 0.272f, -0.010f}, {0.222f, 0.130f, 0.010f}, 0.054f, 0.050f), 0.04f);
    float sleeve = taper(m, {0.222f, 0.122f, 0.012f}, {0.108f, 0.140f, 0.150f}, 0.050f, 0.034f);
    const V3 s = turnedY(m - V3{0.165f, 0.082f, 0.085f}, 0.86f);
    sleeve = join(sleeve, ellipsoid(s, {0.092f, 0.085f, 0.026f}), 0.035f);
    d = join(d, sleeve, 0.03f);

    // Folds: bows from shoulder to shoulder over the breast, falling lines below and on the sleeves.
    const float warp = 0.016f * (fbm(p * 17.0f, 2) - 0.5f);
    const float bows = fold(length(V2{0.72f * p.x, p.y - 0.425f}) + warp, 0.0265f);
    const float fall =
        fold(std::atan2(p.x, p.z + 0.16f) * 0.20f + 0.12f * p.y * std::clamp(p.x * 14.0f, -1.0f, 1.0f) + 2.2f * warp,
             0.0175f);
    const float low = smoothstep(0.19f, 0.10f, p.y + 0.5f * std::max(m.x - 0.13f, 0.0f));
    const float outer = smoothstep(0.13f, 0.175f, m.x);
    const float amount = mix(0.0085f * smoothstep(0.35f, 0.27f, p.y), 0.0095f, std::max(low, outer));
    d -= amount * mix(bows, fall, std::max(low, outer)) - 0.004f;

    // The cloak: laid over her left shoulder, drawn across to the other hip.
    const float edge = 0.78f * (p.y - 0.255f) - 0.62f * p.x + 0.02f * std::sin(p.x * 25.0f) + 1.2f * warp;
    const float across = fold(edge, 0.021f);
    const float cloak = d - 0.012f - 0.006f * across;
    const float strip = std::max(std::fabs(edge + 0.030f) - 0.048f, 0.10f - p.y - 0.25f * p.x);
    d = join(d, common(cloak, strip, 0.012f), 0.006f);

    // The neckline: a rolled hem about an open breast.
    const float open = ellipsoid(p - V3{0.0f, 0.365f, 0.055f}, {0.070f, 0.078f, 0.10f});
    d = carve(d, open, 0.02f);
    d = std::max(d, -p.y);
    return 0.52f * d;
}

float vessel(V3 p) {
    const V3 q = p - kVesselCentre;
    const float away = sphere(q, 0.11f);
    if (away > 0.05f) return away;
    float d = ellipsoid(q, {0.053f, 0.068f, 0.053f});
    d = std::max(d, q.y - 0.040f);
    d = join(d, cylinder(q - V3{0.0f, 0.046f, 0.0f}, 0.037f, 0.014f, 0.003f), 0.016f);
    d = join(d, torus(q - V3{0.0f, 0.060f, 0.0f}, 0.040f, 0.0045f), 0.006f);
    d = carve(d, cylinder(q - V3{0.0f, 0.060f, 0.0f}, 0.033f, 0.040f, 0.004f), 0.003f);
    d = join(d, cylinder(q + V3{0.0f, 0.066f, 0.0f}, 0.028f, 0.006f, 0.003f), 0.01f);
    const float ring = torus(q - V3{0.0f, 0.022f, 0.0f}, 0.0505f, 0.0022f);
    return 0.85f * join(d, ring, 0.002f);
}

float hands(V3 p) {
    const V3 m = mirrorX(p - kVesselCentre);
    const float away = box(m - V3{0.06f, 0.0f, -0.005f}, {0.07f, 0.08f, 0.075f});
    if (away > 0.03f) return away;
    // Where a finger of radius r lies on the vessel, at an angle from the front and a height.
    const auto on = [](float angle, float y, float r) {
        const float radius = 0.053f * std::sqrt(std::max(1.0f - y * y / (0.068f * 0.068f), 0.05f)) + 0.75f * r;
        return V3{radius * std::sin(angle), y, radius * std::cos(angle)};
    };
    // Palm and wrist.
    float d = ellipsoid(turnedY(m - V3{0.064f, -0.020f, -0.020f}, 0.25f), {0.016f, 0.042f, 0.036f});
    d = join(d, taper(m, {0.070f, -0.014f, -0.034f}, {0.108f, -0.012f, -0.024f}, 0.020f, 0.024f), 0.03f);
    constexpr float kTop = 0.004f, kApart = 0.0170f;
    const float tips[4] = {0.50f, 0.33f, 0.37f, 0.55f};
    for (int i = 0; i < 4; ++i) {
        const float r = i == 3 ? 0.0072f : 0.0086f, y = kTop - kApart * float(i), low = -0.002f;
        const V3 a = on(1.62f, y + 0.002f, r), b = on(1.18f, y, 1.35f * r),
                 c = on(0.5f * (tips[i] + 1.1f), y + low, 1.1f * r), e = on(tips[i], y + 2.0f * low, r);
        float finger = taper(m, a, b, 1.12f * r, 1.08f * r);
        finger = join(finger, taper(m, b, c, 1.08f * r, r), 0.003f);
        finger = join(finger, taper(m, c, e, r, 0.80f * r), 0.002f);
        d = join(d, finger, i == 0 ? 0.010f : 0.0045f);
    }
    // The thumb lies along the shoulder of the vessel.
    const V3 ball = on(1.75f, 0.006f, 0.012f), knuckle = on(1.18f, 0.024f, 0.013f), tip = on(0.72f, 0.031f, 0.009f);
    float thumb = taper(m, ball, knuckle, 0.0125f, 0.0105f);
    thumb = join(thumb, taper(m, knuckle, tip, 0.0105f, 0.0080f), 0.003f);
    return 0.85f * join(d, thumb, 0.008f);
}

}  // namespace ilf::samples::bust
