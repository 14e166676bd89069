#include <memory>

#include "materials.h"
#include "scenes.h"
#include "sdf.h"
#include "text.h"

namespace ilf::samples {
namespace {

// World: metres, the wearer's pupil at the origin, y up; the wearer stands and looks down on a bench.
constexpr float kBenchPitch = 0.92f;
constexpr float kBench = -0.49f;

using Shape = std::function<float(V3)>;
using Look = std::function<Surface(V3, V3)>;

const V3 kSteel{0.70f, 0.71f, 0.73f}, kBlackSteel{0.33f, 0.335f, 0.345f};

/// A tool lies along its own x, which points away from the wearer; y is up from the bench.
struct Tool {
    std::string name;
    Frame frame;

    Object part(const Shape& shape, const Look& look) const {
        const Frame f = frame;
        return {name, [f, shape](V3 p) { return 0.9f * shape(f.local(p)); },
                [f, look](V3 p, V3 n) { return look(f.local(p), {dot(n, f.x), dot(n, f.y), dot(n, f.z)}); }};
    }
    Object part(const Shape& shape, const Surface& look) const {
        return part(shape, [look](V3, V3) { return look; });
    }
};

Tool laid(const char* name, float x, float z, float turn) { return {name, placed({x, kBench, z}, kPi / 2 + turn)}; }

/// A flat outline `d` in x and z, made a bar of half thickness `half` about height `y`, edges rounded.
float bar(float d, float y, float half, float rounding) {
    const V2 w{d + rounding, std::fabs(y) - half + rounding};
    return std::min(std::max(w.x, w.y), 0.0f) + length(V2{std::max(w.x, 0.0f), std::max(w.y, 0.0f)}) - rounding;
}

float stroke(V3 p, V2 a, V2 b, float ra, float rb) {
    return taper({p.x, 0.0f, p.z}, {a.x, 0.0f, a.y}, {b.x, 0.0f, b.y}, ra, rb);
}

float disc(V3 p, float x, float z, float radius) { return length(V2{p.x - x, p.z - z}) - radius; }

void addHammer(std::vector<Object>& objects) {
    const Tool t = laid("Hammer", -0.275f, -0.372f, 0.06f);
    objects.push_back(t.part(
        [](V3 p) {
            const V3 q = p - V3{0.0f, 0.0155f, 0.0f};
            const float swell = 0.0112f + 0.0030f * std::sin(clamp01((q.x + 0.14f) / 0.27f) * 5.2f + 1.1f);
            const float along = std::fabs(q.x + 0.005f) - 0.137f;
            const float round = (length(V2{q.y, q.z * 0.92f}) - swell) * 0.9f;
            return common(round, along, 0.008f);
        },
        [](V3 p, V3) {
            Surface s =
                wood({p.x * 1.2f, p.y * 2.0f, p.z * 2.0f}, {0.58f, 0.38f, 0.19f}, {0.38f, 0.21f, 0.09f}, 1.0f, 0.04f);
            if (p.x < -0.105f) s.albedo = {0.42f, 0.05f, 0.035f};  // dipped end
            return s;
        }));
    objects.push_back(t.part(
        [](V3 p) {
            const V3 q = p - V3{0.118f, 0.018f, 0.0f};
            float d = box(q, {0.014f, 0.0155f, 0.019f}, 0.004f);
            const V3 face = turnedX(q - V3{0.0f, 0.0f, 0.040f}, kPi / 2);
            d = join(d, cylinder(turnedX(q - V3{0.0f, 0.0f, 0.024f}, kPi / 2), 0.0105f, 0.014f, 0.002f), 0.006f);
            d = join(d, cylinder(face, 0.0150f, 0.0085f, 0.0025f), 0.005f);
            // The claw bends back towards the handle.
            float claw = 1.0f;
            V3 last{0.0f, 0.0f, -0.012f};
            for (int i = 1; i <= 8; ++i) {
                const float s = float(i) / 8.0f;
                const V3 next{-0.026f * s * s, 0.0f, -0.012f - 0.050f * s};
                const V3 w{q.x, q.y * mix(0.85f, 0.62f, s), q.z};
                claw = std::min(claw, taper(w, last, next, 0.0105f - 0.0075f * (s - 0.125f), 0.0105f - 0.0075f * s));
                last = next;
            }
            const float slot = std::max(std::fabs(q.y) - 0.0018f + 0.08f * (q.z + 0.062f), q.z + 0.030f);
            return join(d, carve(claw, slot, 0.001f), 0.006f);
        },
        [](V3 p, V3) {
            Surface s = brushed({p.z, p.y, p.x}, p.z > 0.046f ? kSteel : kBlackSteel * 1.5f, 0.32f);
            return s;
        }));
}

void addPliers(std::vector<Object>& objects) {
    const Tool t = laid("Pliers", -0.168f, -0.376f, -0.03f);
    const auto handle = [](V3 p, float side) {
        const V3 q{p.x, 0.0f, p.z * side};
        float d = stroke(q, {0.020f, 0.006f}, {-0.020f, 0.021f}, 0.0075f, 0.0078f);
        d = join(d, stroke(q, {-0.020f, 0.021f}, {-0.070f, 0.026f}, 0.0078f, 0.0082f), 0.012f);
        return join(d, stroke(q, {-0.070f, 0.026f}, {-0.115f, 0.019f}, 0.0082f, 0.0075f), 0.012f);
    };
    objects.push_back(t.part(
        [handle](V3 p) {
            const float y = p.y - 0.010f;
            const float d = std::min(handle(p, 1.0f), handle(p, -1.0f));
            return std::max(bar(d, y, 0.0085f, 0.0065f), p.x + 0.004f);
        },
        [](V3 p, V3) {
            Surface s = plain({0.46f, 0.045f, 0.03f}, 0.04f, 0.35f);
            s.albedo = s.albedo *
                       (0.9f + 0.2f * (std::sin(p.x * 900.0f) > 0.2f && p.x < -0.03f && p.x > -0.10f ? 0.0f : 1.0f));
            return s;
        }));
    objects.push_back(t.part(
        [handle](V3 p) {
            const float y = p.y - 0.0095f;
            const float arms = bar(std::min(handle(p, 1.0f), handle(p, -1.0f)) + 0.0018f, y, 0.0058f, 0.002f);
            float joint = bar(disc(p, 0.026f, 0.0f, 0.0175f), y, 0.0075f, 0.002f);
            const V3 m{p.x, 0.0f, std::fabs(p.z)};
            const float jaw = std::max(stroke(m, {0.028f, 0.008f}, {0.098f, 0.0028f}, 0.0105f, 0.0046f), 0.0007f - m.z);
            joint = join(joint, bar(jaw, y, 0.0068f - 0.02f * std::max(p.x - 0.05f, 0.0f), 0.0018f), 0.003f);
            const float cutter = disc(m, 0.046f, 0.0f, 0.004f);
            joint = std::max(joint, -cutter);
            const float rivet = bar(disc(p, 0.026f, 0.0f, 0.0065f), y, 0.0092f, 0.002f);
            return std::min({arms, joint, rivet});
        },
        [](V3 p, V3) {
            Surface s = brushed(p, length(V2{p.x - 0.026f, p.z}) < 0.007f ? kSteel : kSteel * 0.72f, 0.3f);
            if (p.x > 0.056f && std::fabs(p.z) < 0.005f && std::sin(p.x * 3200.0f) > 0.0f) s.albedo = s.albedo * 0.5f;
            return s;
        }));
}

void addScrewdriver(std::vector<Object>& objects) {
    const Tool t = laid("Screwdriver", -0.062f, -0.372f, 0.02f);
    objects.push_back(t.part(
        [](V3 p) {
            const V3 q = p - V3{-0.072f, 0.0165f, 0.0f};
            const float x = clamp01((q.x + 0.062f) / 0.115f);
            float radius = 0.0155f - 0.004f * smoothstep(0.62f, 0.85f, x) + 0.002f * smoothstep(0.9f, 1.0f, x);
            radius *= std::sqrt(clamp01(1.0f - std::pow(smoothstep(0.22f, 0.0f, x), 2.5f)));
            const float turn = std::atan2(q.y, q.z);
            const float flutes =
                0.0011f * (std::cos(turn * 8.0f)) * smoothstep(0.10f, 0.2f, x) * smoothstep(0.66f, 0.56f, x);
            const float round = (length(V2{q.y, q.z}) - radius + flutes) * 0.75f;
            return std::max(round, std::fabs(q.x) - 0.062f + 0.0f * x);
        },
        [](V3 p, V3 n) {
            const float x = p.x + 0.072f;
            if (x > 0.020f && x < 0.034f) return lacquered({0.02f, 0.02f, 0.022f});
            // Amber acetate: light passes, so the edge glows.
            Surface s{mix(V3{0.72f, 0.30f, 0.03f}, V3{0.95f, 0.52f, 0.08f},
                          clamp01(0.5f - 0.5f * n.y + 0.4f * std::fabs(n.z))),
                      0.06f, 0.14f};
            s.glow = 0.05f;
            return s;
        }));
    objects.push_back(t.part(
        [](V3 p) {
            const V3 q = p - V3{0.0f, 0.0165f, 0.0f};
            float d = capsule(q, {-0.02f, 0.0f, 0.0f}, {0.118f, 0.0f, 0.0f}, 0.0034f);
            const float flat = std::max({std::fabs(q.x - 0.123f) - 0.012f,
                                         std::fabs(q.z) - 0.0048f + 0.05f * std::max(0.118f - q.x, 0.0f),
                                         std::fabs(q.y) - 0.0034f + 0.16f * std::max(q.x - 0.113f, 0.0f)});
            d = join(d, flat, 0.004f);
            return std::min(d, cylinder(turnedZ(q - V3{-0.012f, 0.0f, 0.0f}, kPi / 2), 0.0062f, 0.006f, 0.001f));
        },
        [](V3 p, V3) { return brushed(p, p.x > 0.108f ? kBlackSteel : kSteel, 0.24f); }));
}

void addSpanner(std::vector<Object>& objects) {
    const Tool t = laid("Spanner", 0.038f, -0.372f, -0.04f);
    const auto stamp = std::make_shared<TypePicture>(
        typeset(640, 72, 8.0f, 10.0f, {{"13  CHROME VANADIUM  13", Face::sans, 47.0f, 1.0f, TypeLine::Set::centre}}));
    objects.push_back(t.part(
        [](V3 p) {
            const float y = p.y - 0.0065f;
            // The shank is hollowed on its broad side.
            float shank = bar(stroke(p, {-0.085f, 0.0f}, {0.085f, 0.0f}, 0.0072f, 0.0085f), y, 0.0038f, 0.0022f);
            const float hollow = ellipsoid(p - V3{0.0f, 0.0125f, 0.0f}, {0.070f, 0.0031f, 0.0045f});
            shank = carve(shank, hollow, 0.001f);
            float ring = bar(disc(p, -0.098f, 0.0f, 0.0165f), y, 0.0055f, 0.002f);
            const float a = std::atan2(p.z, p.x + 0.098f);
            ring = carve(ring, disc(p, -0.098f, 0.0f, 0.0098f + 0.0009f * std::cos(a * 12.0f)), 0.001f);
            float jaw = bar(disc({p.x, 0.0f, p.z * 0.93f}, 0.103f, 0.0f, 0.0205f), y, 0.0048f, 0.002f);
            const V3 q = turnedY(p - V3{0.103f, 0.0f, 0.0f}, 0.26f);
            const float mouth =
                std::max(std::fabs(q.z) - 0.0092f, 0.006f - q.x - 0.006f * smoothstep(0.008f, 0.0f, std::fabs(q.z)));
            jaw = carve(jaw, mouth, 0.001f);
            return join(join(shank, ring, 0.012f), jaw, 0.014f);
        },
        [stamp](V3 p, V3 n) {
            Surface s{{0.78f, 0.79f, 0.81f}, 0.75f, 0.22f, true};
            if (n.y > 0.8f)
                s.albedo = mix(s.albedo, {0.14f, 0.14f, 0.15f}, stamp->at(0.5f + p.x / 0.130f, 0.5f + p.z / 0.0146f));
            return s;
        }));
}

void addTape(std::vector<Object>& objects) {
    const Tool t = laid("Tape measure", 0.148f, -0.385f, -0.10f);
    objects.push_back(t.part(
        [](V3 p) {
            const V3 q = p - V3{-0.04f, 0.0165f, 0.0f};
            float d = box(q, {0.034f, 0.0165f, 0.033f}, 0.0055f);
            d = std::max(d, cylinder(q - V3{-0.006f, 0.0f, 0.0f}, 0.0405f, 0.02f, 0.004f));
            d = join(d, box(q - V3{0.022f, 0.0f, 0.020f}, {0.013f, 0.013f, 0.013f}, 0.003f), 0.003f);
            return carve(d, cylinder(q - V3{-0.004f, 0.0165f, 0.0f}, 0.022f, 0.0012f), 0.001f);
        },
        [dial = std::make_shared<TypePicture>(
             typeset(300, 300, 0.0f, 66.0f,
                     {{"5 m", Face::serifBold, 104.0f, 1.0f, TypeLine::Set::centre},
                      {"steel", Face::serifItalic, 52.0f, 1.0f, TypeLine::Set::centre}}))](V3 p, V3 n) {
            const float x = p.x + 0.044f, r = length(V2{x, p.z});
            if (n.y > 0.7f && r < 0.0225f) {
                const float ink = dial->at(0.5f + p.z / 0.044f, 0.5f - x / 0.044f);
                const bool rim = r > 0.0198f && r < 0.0208f;
                return lacquered(mix(V3{0.70f, 0.68f, 0.60f}, {0.03f, 0.03f, 0.03f}, rim ? 1.0f : ink));
            }
            const bool grip = r > 0.0365f || (x > 0.018f && p.z > 0.006f);
            return grip ? plain({0.022f, 0.022f, 0.024f}, 0.03f, 0.5f) : lacquered({0.72f, 0.44f, 0.02f});
        }));
    // The blade, drawn out along the bench, with centimetres.
    std::vector<TypeLine> none;
    auto scale = std::make_shared<TypePicture>(typeset(1400, 150, 0.0f, 0.0f, none));
    for (int mm = 0; mm <= 140; ++mm) {
        const float x = float(mm) * 10.0f, tall = mm % 10 == 0 ? 70.0f : mm % 5 == 0 ? 52.0f : 34.0f;
        scale->stroke({x, 0.0f}, {x, tall}, 2.6f);
    }
    for (int cm = 1; cm < 14; ++cm) {
        const TypePicture digits =
            typeset(100, 70, 0.0f, 0.0f, {{std::to_string(14 - cm), Face::sans, 62.0f, 1.0f, TypeLine::Set::centre}});
        for (int y = 0; y < 70; ++y)
            for (int x = 0; x < 100; ++x)
                scale->mark(cm * 100 - 50 + x, 76 + y, digits.ink[std::size_t(y * 100 + x)]);
    }
    objects.push_back(t.part(
        [](V3 p) {
            // A slight hollow keeps it straight.
            const V3 q = p - V3{0.058f, 0.0032f + 14.0f * (p.z - 0.020f) * (p.z - 0.020f), 0.020f};
            const float strip = box(q, {0.066f, 0.0004f, 0.0085f}) * 0.85f;
            return std::min(strip, box(p - V3{0.125f, 0.004f, 0.020f}, {0.0012f, 0.0045f, 0.0085f}, 0.0005f));
        },
        [scale](V3 p, V3) {
            if (p.x > 0.1225f) return brushed(p, kSteel, 0.3f);
            const float ink = scale->at((p.x + 0.0165f) / 0.14f, 0.5f + (p.z - 0.020f) / 0.0168f);
            return lacquered(mix(V3{0.76f, 0.60f, 0.10f}, {0.02f, 0.02f, 0.02f}, ink));
        }));
}

void addBrush(std::vector<Object>& objects) {
    const Tool t = laid("Brush", 0.262f, -0.372f, -0.05f);
    objects.push_back(t.part(
        [](V3 p) {
            const V3 q = p - V3{0.0f, 0.009f, 0.0f};
            float d = stroke(q, {-0.118f, 0.0f}, {-0.055f, 0.0f}, 0.0085f, 0.0115f);
            d = join(d, stroke(q, {-0.055f, 0.0f}, {-0.010f, 0.0f}, 0.0105f, 0.0085f), 0.013f);
            d = join(d, std::max(box({q.x - 0.022f, 0.0f, q.z}, {0.024f, 1.0f, 0.024f}, 0.012f), -1.0f), 0.02f);
            d = std::max(d, -disc(q, -0.110f, 0.0f, 0.0042f));
            return bar(d, q.y, 0.0078f, 0.006f);
        },
        [](V3 p, V3) {
            Surface s = wood({p.x * 1.5f, p.y, p.z * 1.6f}, {0.50f, 0.22f, 0.10f}, {0.30f, 0.10f, 0.045f}, 1.0f, 0.05f);
            s.roughness = 0.22f;
            return s;
        }));
    objects.push_back(
        t.part([](V3 p) { return box(p - V3{0.054f, 0.0095f, 0.0f}, {0.014f, 0.0092f, 0.0262f}, 0.004f); },
               [](V3 p, V3) {
                   Surface s = brushed({p.z, p.y, p.x}, {0.66f, 0.55f, 0.36f}, 0.3f);
                   const float x = std::fabs(p.x - 0.054f);
                   if (x > 0.0085f && x < 0.0098f) s.albedo = s.albedo * 0.45f;
                   const float dot = length(V2{p.x - 0.054f, std::fabs(p.z) - 0.016f});
                   if (dot < 0.0022f) s.albedo = s.albedo * 0.5f;
                   return s;
               }));
    objects.push_back(t.part(
        [](V3 p) {
            const float s = clamp01((p.x - 0.065f) / 0.055f);
            const V3 q = p - V3{0.093f, 0.0095f - 0.003f * s, 0.0f};
            const float hairs = 0.0009f * std::sin(p.z * 4200.0f + 3.0f * noise(p * 300.0f));
            const float ragged = 0.003f * noise({p.z * 900.0f, p.y * 900.0f, 0.0f}) + 7.0f * p.z * p.z;
            return 0.5f * box(q, {0.030f - ragged, 0.0078f - 0.0045f * s + hairs, 0.0248f + 0.002f * s}, 0.0025f);
        },
        [](V3 p, V3) {
            const float strand = noise({p.x * 60.0f, p.y * 900.0f, p.z * 2600.0f});
            const float tip = smoothstep(0.095f, 0.118f, p.x);
            return plain(mix(V3{0.17f, 0.115f, 0.065f}, V3{0.42f, 0.32f, 0.20f}, strand) * mix(1.0f, 1.35f, tip), 0.02f,
                         0.6f);
        }));
}

void addScrews(std::vector<Object>& objects) {
    const V3 where[5] = {{-0.115f, 0.4f, -0.205f},
                         {-0.088f, 2.1f, -0.222f},
                         {-0.010f, 4.0f, -0.200f},
                         {0.085f, 5.2f, -0.212f},
                         {0.105f, 1.0f, -0.190f}};
    for (const V3& w : where) {
        const Frame f = placed({w.x, kBench + 0.0035f, w.z}, w.y);
        objects.push_back(
            {"",
             [f](V3 p) {
                 const V3 q = f.local(p);
                 const float thread = 0.0003f * std::sin(q.x * 3200.0f + std::atan2(q.y, q.z));
                 const float shaft =
                     taper(q, {-0.010f, 0.0f, 0.0f}, {0.0115f, -0.0015f, 0.0f}, 0.0019f, 0.0009f) - thread;
                 const float head = cylinder(turnedZ(q - V3{-0.0115f, 0.0f, 0.0f}, kPi / 2), 0.0038f, 0.0012f, 0.0004f);
                 const float slot = box(q - V3{-0.0130f, 0.0f, 0.0f}, {0.0012f, 0.0005f, 0.005f});
                 return 0.6f * std::min(shaft, std::max(head, -slot));
             },
             [f](V3 p, V3) { return brushed(f.local(p), {0.85f, 0.68f, 0.36f}, 0.36f); }});
    }
}

}  // namespace

Scene tutorialRecording() {
    Scene scene;
    scene.name = "tutorial-recording";
    scene.camera.target = {0.0f, -std::sin(kBenchPitch), -std::cos(kBenchPitch)};
    scene.boundsLow = {-0.8f, -0.55f, -1.0f};
    scene.boundsHigh = {0.8f, 0.9f, 0.3f};
    scene.occlusionReach = 0.03f;
    scene.ambientAbove = {0.20f, 0.20f, 0.21f};
    scene.panel = {-0.35f, 0.80f, -0.50f};
    addHammer(scene.objects);
    addPliers(scene.objects);
    addScrewdriver(scene.objects);
    addSpanner(scene.objects);
    addTape(scene.objects);
    addBrush(scene.objects);
    addScrews(scene.objects);
    scene.objects.push_back(
        {"", [](V3 p) { return p.y - kBench; },
         [](V3 p, V3) {
             Surface s = wood(V3{p.x * 1.2f, p.y, p.z + 0.055f} * 1.9f, {0.120f, 0.071f, 0.039f},
                              {0.062f, 0.035f, 0.020f}, 0.34f, 0.03f);
             // Years of work: dents, a ring left by a tin, a pencil line.
             const float stain = std::fabs(length(V2{p.x - 0.20f, p.z + 0.60f}) - 0.045f) + 0.004f * noise(p * 160.0f);
             s.albedo = s.albedo * (1.0f - 0.35f * smoothstep(0.006f, 0.003f, stain) * noise(p * 45.0f));
             s.albedo = s.albedo * (0.82f + 0.36f * fbm(p * 13.0f, 3));
             return s;
         }});
    scene.lights = {
        {{-0.55f, 0.25f, -0.75f}, 0.07f, V3{1.0f, 0.91f, 0.78f} * 1.35f},
        {{0.65f, 0.35f, -0.10f}, 0.25f, V3{0.78f, 0.87f, 1.0f} * 0.42f},
    };
    return scene;
}

}  // namespace ilf::samples
