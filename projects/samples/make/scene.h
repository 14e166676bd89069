// What the sample renderer draws: solids with materials, lights, and a pinhole camera at the wearer's pupil.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "vec.h"

namespace ilf::samples {

/// How a point of a surface takes light; colours are linear sRGB, 0..1.
struct Surface {
    V3 albedo{0.5f, 0.5f, 0.5f};
    float gloss = 0.0f;      // strength of the highlight at normal incidence: 0.04 varnish, 0.5 and more metal
    float roughness = 0.5f;  // 0.05 polished .. 1 matt
    bool metal = false;      // highlight and reflection take the albedo's colour, no diffuse light
    V3 bump{};               // added to the unit normal before it is normalised again
    float glow = 0.0f;       // light of its own, in albedo
};

/// `distance`: metres to the surface from a world point, negative inside, growing by no more than a metre a metre.
/// `surface`: the look at a world point on it.
struct Object {
    std::string region;  // name of the region mask it belongs to; empty: background
    std::function<float(V3)> distance;
    std::function<Surface(V3 point, V3 normal)> surface;
};

/// A round area light of `radius` metres; `power` is the light it gives at 1 m. `towards` and `cone` (cosine of the
/// half angle where it has faded out; -1: everywhere) make a spotlight of it.
struct Light {
    V3 position;
    float radius = 0.05f;
    V3 power{1.0f, 1.0f, 1.0f};
    V3 towards{0.0f, 0.0f, 0.0f};
    float cone = -1.0f;
    bool shadows = true;
};

/// A pinhole at the wearer's pupil, looking from `eye` to `target`. The lens stands kLensToPupil before it, across the
/// same axis, and distances run along that axis from the lens.
inline constexpr float kLensToPupil = 0.020f;  // metres, d_Ee of the default wearer

struct Camera {
    V3 eye{};
    V3 target{0.0f, 0.0f, -1.0f};
    int width = 1280, height = 800;
    float across = kPi / 3.0f;  // radians, the field of view across the picture
};

struct Scene {
    std::string name;
    Camera camera;
    std::vector<Object> objects;
    std::vector<Light> lights;
    V3 boundsLow{-2.0f, -1.0f, -3.0f}, boundsHigh{2.0f, 2.0f, 1.0f};  // nothing is drawn outside
    V3 ambientAbove{0.10f, 0.11f, 0.13f}, ambientBelow{0.05f, 0.04f, 0.035f};
    float occlusionReach = 0.06f;    // metres over which near surfaces darken each other
    V3 panel{-0.55f, 0.75f, 0.35f};  // towards the large soft panel that polished things mirror
    float exposure = 1.0f;
};

}  // namespace ilf::samples
