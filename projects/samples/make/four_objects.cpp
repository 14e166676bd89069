#include <memory>

#include "materials.h"
#include "scenes.h"
#include "sdf.h"
#include "text.h"

namespace ilf::samples {
namespace {

// World: metres, the wearer's pupil at the origin, y up. The view looks down on a long table by kPosterPitch.
constexpr float kPosterPitch = 0.205f;
constexpr float kTable = -0.130f;

/// Where a toy stands so that its point `height` above the table lies `distance` from the lens along the view axis.
V3 standing(float distance, float x, float height) {
    const float y = kTable + height;
    return {x, kTable, -(distance + kLensToPupil + y * std::sin(kPosterPitch)) / std::cos(kPosterPitch)};
}

using Shape = std::function<float(V3)>;

/// Everything of one toy is modelled at its own place, in units of `size` metres, front to +z.
struct Toy {
    std::string name;
    Frame frame;
    float size;

    Object part(const Shape& shape, const Surface& look) const {
        return part(shape, [look](V3, V3) { return look; });
    }
    Object part(const Shape& shape, const std::function<Surface(V3, V3)>& look) const {
        const Frame f = frame;
        const float s = size;
        return {name, [f, s, shape](V3 p) { return 0.9f * s * shape(f.local(p) / s); },
                [f, s, look](V3 p, V3 n) { return look(f.local(p) / s, {dot(n, f.x), dot(n, f.y), dot(n, f.z)}); }};
    }
};

/// A toy block of edge 1 standing on the ground, its letter on the front and the sides.
void addBlock(std::vector<Object>& objects, const Toy& toy, V3 paint) {
    const auto letter = std::make_shared<TypePicture>(
        typeset(256, 256, 0.0f, -4.0f, {{toy.name, Face::serifBold, 226.0f, 1.0f, TypeLine::Set::centre}}));
    objects.push_back(toy.part([](V3 q) { return box(q - V3{0.0f, 0.5f, 0.0f}, {0.5f, 0.5f, 0.5f}, 0.06f); },
                               [letter, paint](V3 q, V3 n) {
                                   Surface s =
                                       wood(q * 0.22f, {0.62f, 0.43f, 0.23f}, {0.45f, 0.28f, 0.13f}, 2.0f, 0.03f);
                                   const bool front = std::fabs(n.z) > 0.8f, side = std::fabs(n.x) > 0.8f;
                                   if (!front && !side) return s;
                                   const float u = front ? q.x : -q.z * (n.x > 0.0f ? 1.0f : -1.0f), v = q.y - 0.5f;
                                   const float rim = std::max(std::fabs(u), std::fabs(v));
                                   if (rim > 0.36f && rim < 0.42f) s.albedo = paint;
                                   s.albedo = mix(s.albedo, paint, letter->at(0.5f + u / 0.86f, 0.5f - v / 0.86f));
                                   return s;
                               }));
}

void addDuck(std::vector<Object>& objects, const Toy& toy) {
    const V3 up{0.0f, 1.0f, 0.0f};  // stands on its block
    objects.push_back(toy.part(
        [up](V3 q) {
            const V3 p = q - up;
            float d = ellipsoid(p - V3{-0.05f, 0.42f, 0.0f}, {0.58f, 0.38f, 0.36f});
            d = join(d, ellipsoid(turnedZ(p - V3{-0.55f, 0.62f, 0.0f}, 0.7f), {0.26f, 0.12f, 0.2f}), 0.16f);
            d = join(d, sphere(p - V3{0.36f, 0.98f, 0.0f}, 0.285f), 0.20f);
            const V3 w{p.x, p.y, std::fabs(p.z)};
            d = join(d, ellipsoid(turnedZ(w - V3{-0.14f, 0.48f, 0.32f}, 0.22f), {0.34f, 0.20f, 0.075f}), 0.05f);
            d = carve(d, sphere(w - V3{0.46f, 1.06f, 0.262f}, 0.055f), 0.01f);
            return std::max(d, -p.y);
        },
        lacquered({0.88f, 0.58f, 0.06f})));
    objects.push_back(toy.part(
        [up](V3 q) {
            const V3 p = q - up - V3{0.66f, 0.93f, 0.0f};
            return join(ellipsoid(p - V3{0.0f, 0.035f, 0.0f}, {0.17f, 0.050f, 0.13f}),
                        ellipsoid(p - V3{-0.02f, -0.03f, 0.0f}, {0.13f, 0.040f, 0.11f}), 0.02f);
        },
        lacquered({0.80f, 0.22f, 0.03f})));
    objects.push_back(toy.part(
        [up](V3 q) {
            const V3 p = q - up;
            return sphere(V3{p.x, p.y, std::fabs(p.z)} - V3{0.46f, 1.06f, 0.245f}, 0.05f);
        },
        lacquered({0.01f, 0.01f, 0.012f})));
}

void addRobot(std::vector<Object>& objects, const Toy& toy) {
    const V3 up{0.0f, 1.0f, 0.0f};
    objects.push_back(toy.part(
        [up](V3 q) {
            const V3 p = q - up, m = mirrorX(p);
            float d = box(p - V3{0.0f, 0.92f, 0.0f}, {0.40f, 0.42f, 0.24f}, 0.06f);
            d = std::min(d, box(p - V3{0.0f, 1.68f, 0.0f}, {0.31f, 0.25f, 0.23f}, 0.07f));
            d = std::min(d, box(m - V3{0.19f, 0.28f, 0.0f}, {0.13f, 0.28f, 0.15f}, 0.03f));
            return std::min(d, capsule(m, {0.53f, 1.18f, 0.0f}, {0.60f, 0.72f, 0.10f}, 0.095f));
        },
        [](V3 q, V3) { return lacquered(mix(V3{0.045f, 0.20f, 0.25f}, V3{0.055f, 0.23f, 0.28f}, noise(q * 3.0f))); }));
    objects.push_back(toy.part(
        [up](V3 q) {
            const V3 p = q - up, m = mirrorX(p);
            float d = cylinder(p - V3{0.0f, 1.39f, 0.0f}, 0.13f, 0.07f, 0.01f);
            d = std::min(d, box(m - V3{0.19f, 0.055f, 0.05f}, {0.17f, 0.055f, 0.24f}, 0.03f));
            d = std::min(d, sphere(m - V3{0.51f, 1.20f, 0.0f}, 0.135f));
            d = std::min(d, carve(sphere(m - V3{0.61f, 0.62f, 0.13f}, 0.135f),
                                  box(m - V3{0.61f, 0.52f, 0.16f}, {0.05f, 0.12f, 0.3f}), 0.02f));
            d = std::min(d, capsule(p, {0.0f, 1.9f, 0.0f}, {0.0f, 2.12f, 0.0f}, 0.022f));
            return std::min(d, cylinder(turnedZ(m - V3{0.335f, 1.68f, 0.0f}, kPi / 2), 0.10f, 0.04f, 0.01f));
        },
        [](V3 q, V3) { return brushed(q * 0.03f, {0.62f, 0.61f, 0.58f}, 0.26f); }));
    objects.push_back(toy.part(
        [up](V3 q) {
            const V3 p = q - up;
            float d = sphere(p - V3{0.0f, 2.15f, 0.0f}, 0.065f);
            d = std::min(d, sphere(p - V3{0.20f, 0.74f, 0.235f}, 0.055f));
            d = std::min(d, sphere(p - V3{-0.20f, 0.74f, 0.235f}, 0.055f));
            return std::min(d, sphere(p - V3{0.0f, 0.74f, 0.235f}, 0.055f));
        },
        lacquered({0.75f, 0.06f, 0.04f})));
    objects.push_back(toy.part([up](V3 q) { return sphere(mirrorX(q - up) - V3{0.125f, 1.74f, 0.205f}, 0.085f); },
                               Surface{{1.0f, 0.80f, 0.32f}, 0.05f, 0.1f, false, {}, 0.55f}));
    objects.push_back(toy.part(
        [up](V3 q) {
            const V3 p = q - up;
            const float grille = box(p - V3{0.0f, 1.535f, 0.225f}, {0.15f, 0.045f, 0.02f}, 0.01f);
            return std::min(grille, cylinder(turnedX(p - V3{0.0f, 1.05f, 0.235f}, kPi / 2), 0.19f, 0.02f, 0.01f));
        },
        [](V3 q, V3) {
            const V3 p = q - V3{0.0f, 2.05f, 0.0f};  // the dial on the chest
            const float r = length(V2{p.x, p.y}), a = std::atan2(p.x, p.y);
            if (r > 0.2f)
                return plain(std::sin(q.x * 150.0f) > 0.0f ? V3{0.55f, 0.53f, 0.5f} : V3{0.03f, 0.03f, 0.03f});
            const bool tick = r > 0.125f && r < 0.165f && std::cos(a * 12.0f) > 0.8f;
            const bool hand =
                std::fabs(p.x * 0.8f - p.y * 0.6f) < 0.014f && p.x * 0.6f + p.y * 0.8f > -0.02f && r < 0.13f;
            return plain(hand   ? V3{0.7f, 0.05f, 0.03f}
                         : tick ? V3{0.02f, 0.02f, 0.02f}
                                : V3{0.78f, 0.75f, 0.66f},
                         0.04f, 0.2f);
        }));
}

void addRings(std::vector<Object>& objects, const Toy& toy) {
    const V3 colours[5] = {{0.55f, 0.045f, 0.04f},
                           {0.72f, 0.25f, 0.03f},
                           {0.75f, 0.52f, 0.06f},
                           {0.10f, 0.36f, 0.12f},
                           {0.06f, 0.17f, 0.45f}};
    objects.push_back(
        toy.part([](V3 q) { return cylinder(q - V3{0.0f, 1.07f, 0.0f}, 0.66f, 0.075f, 0.04f); },
                 [](V3 q, V3) { return wood(q * 0.2f, {0.60f, 0.42f, 0.22f}, {0.44f, 0.27f, 0.12f}, 2.0f); }));
    float y = 1.15f;
    for (int i = 0; i < 5; ++i) {
        const float tube = 0.185f - 0.014f * float(i), ring = 0.42f - 0.065f * float(i);
        y += tube;
        const V3 centre{0.012f * float(i % 3 - 1), y, 0.01f * float(i % 2)};
        objects.push_back(
            toy.part([centre, ring, tube](V3 q) { return torus(q - centre, ring, tube); }, lacquered(colours[4 - i])));
        y += 0.96f * tube;
    }
    const V3 top{0.0f, y + 0.10f, 0.0f};
    objects.push_back(toy.part([top](V3 q) { return sphere(q - top, 0.17f); }, lacquered({0.55f, 0.045f, 0.04f})));
}

void addRocket(std::vector<Object>& objects, const Toy& toy) {
    const V3 up{0.0f, 1.0f, 0.0f};
    objects.push_back(toy.part(
        [up](V3 q) {
            const V3 p = q - up - V3{0.0f, 0.28f, 0.0f};
            const float t = clamp01(p.y / 1.9f),
                        r = 0.46f * std::sqrt(std::max(std::sin(kPi * (0.24f + 0.76f * t)), 0.0f)) + 0.01f;
            const float d = std::max((length(V2{p.x, p.z}) - r) * 0.78f, std::fabs(p.y - 0.95f) - 0.95f);
            return carve(d, sphere(p - V3{0.0f, 1.12f, 0.46f}, 0.16f), 0.03f);
        },
        [](V3 q, V3) {
            const float y = q.y - 1.28f;
            if (y > 1.48f || (y > 0.16f && y < 0.30f)) return lacquered({0.62f, 0.05f, 0.035f});
            return lacquered({0.72f, 0.70f, 0.66f});
        }));
    objects.push_back(toy.part(
        [up](V3 q) {
            const V3 p = q - up;
            float d = 9.0f;
            for (int i = 0; i < 4; ++i) {
                const V3 f = turnedY(p, kPi / 2 * float(i) + kPi / 4);
                const float out = f.x - 0.28f;
                const float edge =
                    std::max(f.y - (0.95f - 1.05f * out), (0.02f + 0.9f * std::max(0.30f - out, 0.0f)) * 0.6f - f.y);
                const float fin = std::max({edge * 0.7f, std::fabs(f.z) - 0.04f, out - 0.42f, -out});
                d = std::min(d, fin);
            }
            return d - 0.015f;
        },
        lacquered({0.06f, 0.17f, 0.42f})));
    objects.push_back(toy.part(
        [up](V3 q) { return torus(turnedX(q - up - V3{0.0f, 1.40f, 0.425f}, kPi / 2 - 0.05f), 0.165f, 0.032f); },
        [](V3 q, V3) { return brushed(q * 0.05f, {0.70f, 0.52f, 0.22f}, 0.25f); }));
    objects.push_back(toy.part([up](V3 q) { return sphere(q - up - V3{0.0f, 1.40f, 0.33f}, 0.145f); },
                               Surface{{0.10f, 0.22f, 0.30f}, 0.08f, 0.06f}));
    objects.push_back(toy.part([up](V3 q) { return cylinder(q - up - V3{0.0f, 0.20f, 0.0f}, 0.24f, 0.12f, 0.02f); },
                               [](V3 q, V3) { return brushed(q * 0.05f, {0.45f, 0.44f, 0.42f}, 0.3f); }));
}

}  // namespace

Scene fourObjects() {
    Scene scene;
    scene.name = "four-objects";
    scene.camera.target = {0.0f, -std::sin(kPosterPitch), -std::cos(kPosterPitch)};
    scene.boundsLow = {-1.7f, -0.6f, -2.1f};
    scene.boundsHigh = {1.7f, 1.7f, 0.4f};
    scene.occlusionReach = 0.045f;
    scene.ambientAbove = {0.13f, 0.13f, 0.14f};

    const Toy a{"A", placed(standing(0.25f, -0.092f, 0.030f), 0.30f), 0.036f};
    const Toy b{"B", placed(standing(0.50f, -0.066f, 0.070f), 0.22f), 0.050f};
    const Toy c{"C", placed(standing(0.50f, 0.150f, 0.060f), -0.25f), 0.052f};
    const Toy d{"D", placed(standing(1.30f, 0.115f, 0.120f), -0.20f), 0.092f};
    addBlock(scene.objects, a, {0.55f, 0.05f, 0.04f});
    addDuck(scene.objects, a);
    addBlock(scene.objects, b, {0.05f, 0.16f, 0.42f});
    addRobot(scene.objects, b);
    addBlock(scene.objects, c, {0.08f, 0.30f, 0.11f});
    addRings(scene.objects, c);
    addBlock(scene.objects, d, {0.60f, 0.24f, 0.03f});
    addRocket(scene.objects, d);

    scene.objects.push_back({"", [](V3 p) { return std::max(p.y - kTable, kTable - 0.05f - p.y); },
                             [](V3 p, V3) {
                                 return wood(V3{p.z, p.y, p.x + 0.03f} * 1.7f, {0.20f, 0.115f, 0.058f},
                                             {0.105f, 0.055f, 0.028f}, 0.17f, 0.035f);
                             }});
    scene.objects.push_back(
        {"", [](V3 p) { return p.z + 2.0f; },
         [](V3 p, V3) {
             // Wallpaper: broad stripes with a small sprig.
             const float stripe = smoothstep(-0.12f, 0.12f, std::sin(p.x * 2.0f * kPi / 0.24f));
             V3 colour = mix(V3{0.20f, 0.27f, 0.27f}, V3{0.25f, 0.32f, 0.31f}, stripe);
             const float gx = p.x / 0.12f + 0.25f, gy = p.y / 0.16f + (int(std::floor(gx)) % 2 != 0 ? 0.5f : 0.0f);
             const float sx = (gx - std::floor(gx) - 0.5f) * 0.12f, sy = (gy - std::floor(gy) - 0.5f) * 0.16f;
             const float petals = length(V2{sx, sy}) - 0.014f * (0.7f + 0.3f * std::cos(5.0f * std::atan2(sy, sx)));
             colour = mix(colour, {0.40f, 0.38f, 0.28f}, smoothstep(0.001f, -0.001f, petals));
             return plaster(p, colour);
         }});
    scene.lights = {
        {{-0.75f, 0.95f, -0.10f}, 0.09f, V3{1.0f, 0.90f, 0.76f} * 1.6f},
        {{0.9f, 0.8f, 0.1f}, 0.25f, V3{0.75f, 0.86f, 1.0f} * 0.35f},
        {{-0.5f, 1.5f, -1.25f}, 0.12f, V3{1.0f, 0.90f, 0.76f} * 1.6f},
    };
    return scene;
}

}  // namespace ilf::samples
