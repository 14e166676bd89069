#include <memory>

#include "book.h"
#include "materials.h"
#include "scenes.h"
#include "sdf.h"
#include "text.h"

namespace ilf::samples {
namespace {

// World: metres, the wearer's pupil at the origin, y up; the wearer sits and looks down on a desk.
constexpr float kPitch = 0.785f;
constexpr float kDesk = -0.40f;

using Shape = std::function<float(V3)>;
using Look = std::function<Surface(V3, V3)>;

Object placedAt(const char* region, const Frame& f, const Shape& shape, const Look& look) {
    return {region, [f, shape](V3 p) { return 0.92f * shape(f.local(p)); },
            [f, look](V3 p, V3 n) { return look(f.local(p), {dot(n, f.x), dot(n, f.y), dot(n, f.z)}); }};
}

Frame onDesk(float x, float z, float yaw) { return placed({x, kDesk, z}, yaw); }

void addMug(std::vector<Object>& objects) {
    const Frame f = onDesk(-0.288f, -0.550f, 0.5f);
    objects.push_back(placedAt(
        "Clutter", f,
        [](V3 p) {
            const V3 q = p - V3{0.0f, 0.045f, 0.0f};
            float d = cylinder(q, 0.040f - 0.004f * smoothstep(-0.025f, -0.045f, q.y), 0.045f, 0.004f);
            const V3 h = turnedX(q - V3{0.044f, 0.001f, 0.0f}, kPi / 2);
            d = join(d, torus({h.x, h.y, h.z * 0.82f}, 0.024f, 0.0052f), 0.006f);
            return carve(d, cylinder(q - V3{0.0f, 0.012f, 0.0f}, 0.0362f, 0.045f, 0.006f), 0.002f);
        },
        [](V3 p, V3) {
            const bool inside = length(V2{p.x, p.z}) < 0.0372f;
            const V3 glaze = inside ? V3{0.62f, 0.58f, 0.50f}
                                    : mix(V3{0.055f, 0.15f, 0.20f}, V3{0.10f, 0.24f, 0.28f}, fbm(p * 60.0f, 3));
            const float dip = p.y + 0.004f * std::sin(std::atan2(p.z, p.x) * 5.0f);
            return lacquered(inside || dip > 0.022f ? glaze : V3{0.45f, 0.33f, 0.22f});
        }));
    objects.push_back(placedAt(
        "Clutter", f, [](V3 p) { return cylinder(p - V3{0.0f, 0.068f, 0.0f}, 0.0366f, 0.002f); },
        [](V3, V3) { return plain({0.055f, 0.026f, 0.012f}, 0.05f, 0.08f); }));
}

void addPencils(std::vector<Object>& objects) {
    const Frame f = onDesk(0.020f, -0.540f, 0.0f);
    objects.push_back(placedAt(
        "Clutter", f,
        [](V3 p) {
            const V3 q = p - V3{0.0f, 0.040f, 0.0f};
            return carve(cylinder(q, 0.034f, 0.040f, 0.002f), cylinder(q - V3{0.0f, 0.006f, 0.0f}, 0.0315f, 0.042f),
                         0.001f);
        },
        [](V3 p, V3) { return brushed({p.y, std::atan2(p.x, p.z) * 0.034f, 0.0f}, {0.72f, 0.72f, 0.74f}, 0.32f); }));
    const V3 paints[6] = {{0.75f, 0.45f, 0.04f}, {0.50f, 0.05f, 0.04f},  {0.06f, 0.18f, 0.45f},
                          {0.08f, 0.30f, 0.14f}, {0.02f, 0.02f, 0.025f}, {0.62f, 0.24f, 0.05f}};
    for (int i = 0; i < 6; ++i) {
        const float turn = 1.05f * float(i) + 0.3f, lean = 0.15f + 0.05f * float(i % 3),
                    tall = 0.108f + 0.010f * float((i * 5) % 4);
        const V3 foot{-0.016f * std::cos(turn), 0.004f, -0.016f * std::sin(turn)};
        const V3 axis = normalized({std::cos(turn) * lean, 1.0f, std::sin(turn) * lean});
        const V3 side = normalized(cross(axis, {0.0f, 0.0f, 1.0f}));
        const Frame own{f.world(foot), side, axis, cross(side, axis)};
        const V3 paint = paints[i];
        objects.push_back(placedAt(
            "Clutter", own,
            [tall](V3 p) {
                const V3 a = absolute(p);
                const float hexagon = std::max(a.x * 0.866f + a.z * 0.5f, a.z) - 0.0036f;
                const float cone = (length(V2{p.x, p.z}) - 0.30f * (tall - p.y)) * 0.95f;
                return std::max({hexagon, cone, -p.y, p.y - tall});
            },
            [tall, paint](V3 p, V3) {
                const float tip = tall - p.y;
                const float scallop = 0.0130f + 0.0012f * std::cos(6.0f * std::atan2(p.x, p.z));
                if (tip < 0.0045f) return plain(paint * 0.6f);
                return tip < scallop ? plain({0.62f, 0.45f, 0.28f}) : lacquered(paint);
            }));
    }
}

void addPhone(std::vector<Object>& objects) {
    const Frame f = onDesk(0.185f, -0.236f, -0.32f);
    const auto clock =
        std::make_shared<TypePicture>(typeset(360, 700, 0.0f, 120.0f,
                                              {{"10:24", Face::sans, 128.0f, 1.15f, TypeLine::Set::centre},
                                               {"Thursday", Face::sans, 48.0f, 1.2f, TypeLine::Set::centre}}));
    objects.push_back(placedAt(
        "Clutter", f, [](V3 p) { return box(p - V3{0.0f, 0.0042f, 0.0f}, {0.035f, 0.0042f, 0.072f}, 0.0035f); },
        [clock](V3 p, V3 n) {
            const V2 q{std::fabs(p.x) - 0.0315f + 0.006f, std::fabs(p.z) - 0.0685f + 0.006f};
            const float rim = length(V2{std::max(q.x, 0.0f), std::max(q.y, 0.0f)}) - 0.006f;
            if (n.y < 0.8f || rim > 0.0f) return Surface{{0.02f, 0.02f, 0.022f}, 0.06f, 0.2f};
            const float ink = clock->at(0.5f + p.x / 0.063f, 0.5f + p.z / 0.137f);
            const float hills = smoothstep(0.0f, 0.004f, p.z - 0.02f - 0.012f * std::sin(p.x * 90.0f));
            const V3 sky = mix(V3{0.10f, 0.16f, 0.30f}, V3{0.45f, 0.28f, 0.26f}, clamp01(0.55f + p.z * 7.0f));
            Surface s{mix(mix(sky, {0.05f, 0.08f, 0.13f}, hills), {0.85f, 0.87f, 0.9f}, ink), 0.05f, 0.06f};
            s.glow = 0.40f;
            return s;
        }));
}

void addPaperBall(std::vector<Object>& objects, V3 at, float radius, float turn) {
    const Frame f = placed(at, turn, 0.6f * turn);
    objects.push_back(placedAt(
        "Clutter", f,
        [radius](V3 p) {
            if (length(p) > 1.5f * radius) return length(p) - 1.3f * radius;
            // Facets: the nearest of many random planes, then creases between them.
            float out = -1.0f, second = -1.0f;
            for (int i = 0; i < 30; ++i) {
                const float z = 2.0f * hashed(i, 1, 4) - 1.0f, a = 2.0f * kPi * hashed(i, 2, 4),
                            r = std::sqrt(1.0f - z * z);
                const float d =
                    dot(p, V3{r * std::cos(a), z, r * std::sin(a)}) - radius * (0.72f + 0.30f * hashed(i, 3, 4));
                if (d > out) {
                    second = out;
                    out = d;
                } else {
                    second = std::max(second, d);
                }
            }
            const float crease = smoothstep(0.005f, 0.0f, out - second);
            return 0.6f * (out - 0.0022f * crease + 0.005f * (fbm(p * 130.0f, 2) - 0.5f));
        },
        [](V3, V3) { return plain({0.68f, 0.66f, 0.60f}); }));
}

void addPlant(std::vector<Object>& objects) {
    const Frame f = onDesk(0.292f, -0.555f, 0.3f);
    objects.push_back(placedAt(
        "Clutter", f,
        [](V3 p) {
            const V3 q = p - V3{0.0f, 0.030f, 0.0f};
            float d = (length(V2{p.x, p.z}) - (0.030f + 0.22f * p.y)) * 0.95f;
            d = std::max(d, std::fabs(q.y) - 0.030f);
            d = std::min(d, cylinder(p - V3{0.0f, 0.056f, 0.0f}, 0.0465f, 0.008f, 0.002f));
            return carve(d, cylinder(p - V3{0.0f, 0.064f, 0.0f}, 0.041f, 0.010f), 0.001f);
        },
        [](V3 p, V3) {
            return plain(mix(V3{0.46f, 0.19f, 0.10f}, V3{0.38f, 0.15f, 0.08f}, fbm(p * 60.0f, 3)), 0.0f, 0.9f);
        }));
    objects.push_back(placedAt(
        "Clutter", f,
        [](V3 p) { return cylinder(p - V3{0.0f, 0.052f, 0.0f}, 0.041f, 0.004f) + 0.002f * noise(p * 400.0f); },
        [](V3 p, V3) { return plain(V3{0.05f, 0.035f, 0.025f} * (0.6f + noise(p * 500.0f))); }));
    // A rosette of fleshy leaves, the outer ones lower and longer.
    for (int ring = 0; ring < 3; ++ring) {
        const int leaves = 9 - 2 * ring;
        for (int i = 0; i < leaves; ++i) {
            const float turn = 2.0f * kPi * (float(i) + 0.5f * float(ring)) / float(leaves) + 0.2f * hashed(i, ring, 2);
            const float rise = 0.32f + 0.38f * float(ring) + 0.12f * hashed(i, ring, 7),
                        size = 0.058f - 0.010f * float(ring);
            const Frame own = placed(f.world({0.0f, 0.060f + 0.004f * float(ring), 0.0f}), turn, -rise);
            objects.push_back(placedAt(
                "Clutter", own,
                [size](V3 p) {
                    const float away = length(p - V3{0.0f, 0.0f, 0.5f * size}) - 0.75f * size;
                    if (away > 0.02f) return away;
                    const float s = p.z / size;
                    const V3 q{p.x, p.y - 0.010f * s * s + 7.0f * p.x * p.x, p.z - 0.52f * size};
                    const float taperTo = 0.014f * (1.15f - 0.35f * s);
                    return 0.7f * ellipsoid(q, {taperTo, 0.0042f, 0.55f * size});
                },
                [size](V3 p, V3) {
                    const float s = clamp01(p.z / size);
                    V3 leaf = mix(V3{0.10f, 0.22f, 0.11f}, V3{0.20f, 0.36f, 0.20f}, s);
                    leaf = mix(leaf, {0.45f, 0.16f, 0.15f}, smoothstep(0.88f, 1.08f, s));
                    return plain(leaf * (0.9f + 0.2f * noise(p * 300.0f)), 0.03f, 0.4f);
                }));
        }
    }
}

void addCable(std::vector<Object>& objects, const std::vector<V2>& path, V3 colour) {
    std::vector<V3> points;
    for (std::size_t i = 1; i + 2 < path.size(); ++i)
        for (int k = 0; k < 6; ++k) {
            // Catmull-Rom through the given places.
            const float t = float(k) / 6.0f;
            const auto along = [t](float a, float b, float c, float d) {
                return 0.5f * (2.0f * b + (c - a) * t + (2.0f * a - 5.0f * b + 4.0f * c - d) * t * t +
                               (3.0f * b - a - 3.0f * c + d) * t * t * t);
            };
            points.push_back({along(path[i - 1].x, path[i].x, path[i + 1].x, path[i + 2].x), kDesk + 0.0024f,
                              along(path[i - 1].y, path[i].y, path[i + 1].y, path[i + 2].y)});
        }
    objects.push_back({"Clutter",
                       [points](V3 p) {
                           float d = 9.0f;
                           for (std::size_t i = 0; i + 1 < points.size(); ++i)
                               d = std::min(d, capsule(p, points[i], points[i + 1], 0.0024f));
                           return d;
                       },
                       [colour](V3, V3) { return plain(colour, 0.04f, 0.35f); }});
}

void addNotebook(std::vector<Object>& objects) {
    const Frame f = onDesk(-0.135f, -0.575f, 0.22f);
    std::vector<TypeLine> lines;
    const char* notes[] = {"Thursday",         "- ask for the 16 mm lens", "- read chapter 3 again",
                           "- pencils, paper", "- call Mira at five",      "blur = pupil x dioptres"};
    for (const char* note : notes)
        lines.push_back({note, Face::serifItalic, 50.0f, 1.52f, TypeLine::Set::left});
    const auto page = std::make_shared<TypePicture>(typeset(660, 880, 84.0f, 76.0f, lines));
    objects.push_back(placedAt(
        "Clutter", f, [](V3 p) { return box(p - V3{0.0f, 0.005f, 0.0f}, {0.066f, 0.005f, 0.088f}, 0.0015f); },
        [page](V3 p, V3 n) {
            if (n.y < 0.7f) return plain(V3{0.60f, 0.58f, 0.52f} * (std::sin(p.y * 9000.0f) > 0.0f ? 0.8f : 1.0f));
            const float u = 0.5f + p.x / 0.132f, v = 0.5f + p.z / 0.176f;
            V3 paper{0.70f, 0.68f, 0.58f};
            const float rule = std::fabs(v * 880.0f - 76.0f - 76.0f * std::round((v * 880.0f - 76.0f) / 76.0f) + 14.0f);
            paper = mix(paper, {0.36f, 0.47f, 0.58f}, 0.5f * smoothstep(2.6f, 1.2f, rule));
            return plain(mix(paper, {0.05f, 0.07f, 0.22f}, 0.9f * page->at(u, v)));
        }));
    objects.push_back(placedAt(
        "Clutter", f,
        [](V3 p) {
            // Wire rings along the far edge.
            const float step = 0.0095f, i = std::clamp(std::round(p.x / step), -6.0f, 6.0f);
            const V3 q = turnedZ(p - V3{i * step, 0.006f, -0.086f}, kPi / 2);
            return torus(q, 0.0072f, 0.0009f);
        },
        [](V3, V3) { return Surface{{0.6f, 0.6f, 0.62f}, 0.6f, 0.25f, true}; }));
}

void addGlasses(std::vector<Object>& objects) {
    const Frame f = onDesk(-0.165f, -0.228f, 0.35f);
    objects.push_back(placedAt(
        "Clutter", f,
        [](V3 p) {
            const V3 m = mirrorX(p) - V3{0.0f, 0.021f, 0.0f};
            const V3 q = turnedX(m - V3{0.034f, 0.0f, 0.0f}, kPi / 2);
            float d = torus({q.x * 0.92f, q.y, q.z * 1.08f}, 0.0225f, 0.0019f);
            d = std::min(d, capsule(m, {0.0f, 0.008f, 0.003f}, {0.0115f, 0.004f, 0.0f}, 0.0018f));
            d = std::min(d, capsule(m, {0.058f, 0.006f, 0.0f}, {0.064f, 0.007f, -0.006f}, 0.0022f));
            d = std::min(d, capsule(m, {0.064f, 0.007f, -0.006f}, {0.062f, -0.012f, -0.085f}, 0.0019f));
            return std::min(d, capsule(m, {0.062f, -0.012f, -0.085f}, {0.060f, -0.019f, -0.112f}, 0.0023f));
        },
        [](V3 p, V3) {
            return lacquered(
                mix(V3{0.10f, 0.045f, 0.02f}, V3{0.28f, 0.13f, 0.05f}, smoothstep(0.45f, 0.65f, fbm(p * 130.0f, 3))));
        }));
}

}  // namespace

Scene studyDesk() {
    Scene scene;
    scene.name = "study-desk";
    scene.camera.target = {0.0f, -std::sin(kPitch), -std::cos(kPitch)};
    scene.boundsLow = {-0.9f, -0.45f, -1.3f};
    scene.boundsHigh = {0.9f, 0.8f, 0.3f};
    scene.occlusionReach = 0.035f;
    scene.ambientAbove = {0.105f, 0.107f, 0.118f};
    scene.panel = {-0.35f, 0.80f, -0.50f};

    addBook(scene.objects, "Left book", onDesk(-0.128f, -0.362f, 0.09f), opticsChapter());
    addBook(scene.objects, "Right book", onDesk(0.158f, -0.408f, -0.12f), galleryChapter());
    addMug(scene.objects);
    addPencils(scene.objects);
    addPhone(scene.objects);
    addPaperBall(scene.objects, {0.150f, kDesk + 0.024f, -0.585f}, 0.030f, 0.7f);
    addPaperBall(scene.objects, {0.215f, kDesk + 0.019f, -0.630f}, 0.024f, 2.1f);
    addPlant(scene.objects);
    addNotebook(scene.objects);
    addGlasses(scene.objects);
    addCable(scene.objects,
             {{0.19f, -0.32f},
              {0.209f, -0.309f},
              {0.26f, -0.285f},
              {0.315f, -0.31f},
              {0.345f, -0.40f},
              {0.40f, -0.46f},
              {0.52f, -0.47f},
              {0.6f, -0.5f}},
             {0.55f, 0.54f, 0.52f});
    addCable(scene.objects,
             {{-0.7f, -0.60f},
              {-0.60f, -0.66f},
              {-0.40f, -0.70f},
              {-0.22f, -0.73f},
              {0.0f, -0.69f},
              {0.12f, -0.735f},
              {0.35f, -0.67f},
              {0.60f, -0.74f},
              {0.8f, -0.7f}},
             {0.03f, 0.03f, 0.034f});

    scene.objects.push_back({"Desk", [](V3 p) { return p.y - kDesk; },
                             [](V3 p, V3) {
                                 Surface s = wood(V3{p.x, p.y, p.z} * 1.5f, {0.255f, 0.135f, 0.068f},
                                                  {0.135f, 0.062f, 0.030f}, 0.30f, 0.04f);
                                 s.albedo = s.albedo * (0.85f + 0.3f * fbm(p * 9.0f, 3));
                                 return s;
                             }});
    scene.lights = {
        {{-0.62f, 0.22f, -0.70f}, 0.07f, V3{1.0f, 0.87f, 0.68f} * 0.68f},
        {{0.60f, 0.40f, 0.05f}, 0.25f, V3{0.72f, 0.84f, 1.0f} * 0.20f},
    };
    return scene;
}

Scene scannedDesk() {
    Scene scene = studyDesk();
    scene.name = "scanned-desk";
    scene.camera.width = 640;
    scene.camera.height = 400;
    return scene;
}

}  // namespace ilf::samples
