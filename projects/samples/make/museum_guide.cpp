#include <memory>

#include "bust.h"
#include "materials.h"
#include "scenes.h"
#include "sdf.h"
#include "text.h"

namespace ilf::samples {
namespace {

// World: metres, the wearer's pupil at the origin, y up, the view along -z.
const Frame kStatue = placed({0.02f, -0.246f, -1.20f}, -0.20f);
const Frame kBase = placed({0.02f, -0.246f, -1.20f}, -0.10f);

float baseShape(V3 world) {
    const V3 p = kBase.local(world);
    float d = box(p - V3{0.0f, -0.014f, 0.02f}, {0.225f, 0.0145f, 0.170f}, 0.003f);
    d = join(d, box(p - V3{0.0f, -0.080f, 0.02f}, {0.205f, 0.058f, 0.150f}, 0.002f), 0.006f);
    return join(d, box(p - V3{0.0f, -0.150f, 0.02f}, {0.235f, 0.018f, 0.180f}, 0.004f), 0.010f);
}

float plaqueShape(V3 world) {
    const V3 p = kBase.local(world) - V3{0.0f, -0.073f, 0.1715f};
    return box(p, {0.135f, 0.047f, 0.0035f}, 0.0015f);
}

Surface plaqueSurface(const TypePicture& words, V3 world) {
    const V3 p = kBase.local(world) - V3{0.0f, -0.073f, 0.0f};
    const auto ink = [&](float x, float y) { return words.at(0.5f + x / 0.27f, 0.5f - y / 0.094f); };
    const float here = ink(p.x, p.y);
    // Lacquered brass: satin, so it shows light from anywhere.
    const V3 brass = mix(V3{0.46f, 0.32f, 0.13f}, V3{0.58f, 0.42f, 0.19f}, noise(p * V3{30.0f, 1500.0f, 10.0f}));
    Surface s{brass, 0.16f, 0.45f};
    const float frame = std::max(std::fabs(p.x) / 0.135f, std::fabs(p.y) / 0.047f + 0.05f);
    s.albedo = mix(s.albedo, {0.05f, 0.04f, 0.03f}, 0.93f * here);
    s.gloss = mix(s.gloss, 0.05f, here);
    if (frame > 0.955f && frame < 0.972f) s.albedo = s.albedo * 0.35f;
    return s;
}

float wallShape(V3 p) {
    float d = p.z + 2.5f;
    d = std::min(d, box(p - V3{0.0f, -0.62f, -2.49f}, {3.0f, 0.018f, 0.025f}, 0.006f));  // dado rail
    return d;
}

float frameShape(V3 p) {
    const V3 q = p - V3{-0.98f, 0.14f, -2.485f};
    const float outer = box(q, {0.335f, 0.42f, 0.03f}, 0.008f), inner = box(q, {0.275f, 0.36f, 0.2f});
    return std::max(outer, -inner);
}

Surface canvasSurface(V3 p) {
    // A quiet landscape: sky, hills, water.
    const float x = p.x + 0.98f, y = p.y - 0.14f;
    const float far = 0.05f + 0.05f * std::sin(x * 9.0f) + 0.06f * (fbm({x * 7.0f, 2.0f, 0.0f}, 4) - 0.5f);
    const float near = -0.10f + 0.05f * std::sin(x * 6.0f + 2.0f) + 0.07f * (fbm({x * 11.0f, 8.0f, 0.0f}, 4) - 0.5f);
    V3 colour = mix(V3{0.62f, 0.46f, 0.28f}, V3{0.20f, 0.26f, 0.34f},
                    smoothstep(0.0f, 0.36f, y + 0.1f * fbm({x * 6.0f, y * 14.0f, 0.0f}, 4)));
    colour = mix(colour, {0.16f, 0.20f, 0.20f}, smoothstep(far + 0.004f, far - 0.004f, y));
    colour = mix(colour, {0.07f, 0.085f, 0.05f}, smoothstep(near + 0.004f, near - 0.004f, y));
    const float strokes = fbm({x * 40.0f, y * 120.0f, 1.0f}, 3);
    return plain(colour * (0.75f + 0.5f * strokes), 0.02f, 0.5f);
}

}  // namespace

Scene museumGuide() {
    Scene scene;
    scene.name = "museum-guide";
    scene.camera.eye = {0.0f, 0.0f, 0.0f};
    scene.camera.target = {0.0f, -0.008f, -1.0f};
    scene.boundsLow = {-2.2f, -1.0f, -2.6f};
    scene.boundsHigh = {2.2f, 2.0f, 0.6f};
    scene.occlusionReach = 0.055f;

    const auto words = std::make_shared<TypePicture>(
        typeset(1080, 376, 20.0f, 34.0f,
                {{"THE OFFERING", Face::serifBold, 104.0f, 1.12f, TypeLine::Set::centre},
                 {"Woman with a vessel", Face::serifItalic, 72.0f, 1.20f, TypeLine::Set::centre},
                 {"marble and bronze", Face::serif, 62.0f, 1.2f, TypeLine::Set::centre}}));

    const auto statue = [](float (*shape)(V3)) { return [shape](V3 p) { return shape(kStatue.local(p)); }; };
    const auto stone = [](V3 p, V3) { return marble(kStatue.local(p)); };
    scene.objects = {
        {"Face", statue(bust::head), stone},
        {"Body", statue(bust::body), stone},
        {"Hands", statue(bust::hands), stone},
        {"Hands", statue(bust::vessel), [](V3 p, V3) { return bronze(kStatue.local(p)); }},
        {"Base", baseShape, [](V3 p, V3) { return granite(kBase.local(p)); }},
        {"Base", plaqueShape, [words](V3 p, V3) { return plaqueSurface(*words, p); }},
        {"", wallShape, [](V3 p, V3) { return plaster(p, {0.115f, 0.125f, 0.145f}); }},
        {"", frameShape,
         [](V3 p, V3) { return wood({p.y, p.x, p.z}, {0.40f, 0.28f, 0.12f}, {0.22f, 0.14f, 0.05f}, 0.5f, 0.2f); }},
        {"", [](V3 p) { return box(p - V3{-0.98f, 0.14f, -2.492f}, {0.28f, 0.365f, 0.012f}); },
         [](V3 p, V3) { return canvasSurface(p); }},
        {"", [](V3 p) { return box(p - V3{0.02f, -0.71f, -1.18f}, {0.30f, 0.278f, 0.26f}, 0.006f); },
         [](V3 p, V3) { return plaster(p, {0.13f, 0.135f, 0.145f}); }},
    };
    scene.lights = {
        {{-0.95f, 1.15f, -0.15f}, 0.10f, V3{1.0f, 0.88f, 0.72f} * 5.6f, {0.0f, 0.02f, -1.1f}, 0.86f},
        {{1.30f, 0.75f, -1.75f}, 0.12f, V3{0.55f, 0.72f, 1.0f} * 2.2f, {0.0f, 0.1f, -1.1f}, 0.80f},
        {{0.55f, 0.10f, 0.25f}, 0.30f, V3{0.80f, 0.85f, 1.0f} * 0.42f},
        {{-0.15f, -0.45f, -0.25f}, 0.20f, V3{1.0f, 0.90f, 0.76f} * 0.13f, {0.02f, -0.34f, -1.0f}, 0.93f},
        {{-1.15f, 1.5f, -1.75f}, 0.10f, V3{1.0f, 0.86f, 0.68f} * 2.1f, {-0.95f, 0.1f, -2.5f}, 0.80f},
        {{0.9f, 1.7f, -1.9f}, 0.15f, V3{0.9f, 0.9f, 1.0f} * 1.5f, {0.8f, 0.2f, -2.5f}, 0.55f},
    };
    return scene;
}

}  // namespace ilf::samples
