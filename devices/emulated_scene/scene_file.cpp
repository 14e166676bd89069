#include "devices/emulated_scene/scene_file.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "core/base/as_text.h"
#include "devices/emulated_scene/built_in.h"

namespace ilf::devices::scene {
namespace {

/// Of a solid's sides, metres.
constexpr double kSmallest = 0.02, kWidest = 1.0, kHighest = 0.4;
/// Of the middle of a depth map.
constexpr double kNearest = 0.5, kFarthest = 2.5;
/// Below whatever stands there, so that no two surfaces are one.
constexpr double kDesk = -0.002;

SceneReader& reader() {
    static SceneReader one;
    return one;
}

tl::unexpected<Error> refused(const std::string& source, const std::string& why, double byWhat) {
    return fail(Fault::outOfRange, source + " does not fit the emulated rig: " + why +
                                       ". Give a scale, such as scale=" + asText("%.1g", byWhat) + ".");
}

/// The largest box of all its vertices; its own measure, since this shares no code with what is tested by it.
struct Sides {
    Vec3 least{1e30, 1e30, 1e30}, most{-1e30, -1e30, -1e30};
};

Sides sidesOf(const Solid& solid) {
    Sides sides;
    for (const Box<Mesh>& mesh : solid.meshes) {
        for (const auto& triangle : mesh->triangles) {
            for (const std::uint32_t corner : triangle) {
                const auto& p = mesh->positions[corner];
                const Vec3 v{p[0], p[1], p[2]};
                sides.least = {std::min(sides.least.x, v.x), std::min(sides.least.y, v.y),
                               std::min(sides.least.z, v.z)};
                sides.most = {std::max(sides.most.x, v.x), std::max(sides.most.y, v.y), std::max(sides.most.z, v.z)};
            }
        }
    }
    return sides;
}

Result<Things> onDesk(const Solid& solid, double scale) {
    const Sides sides = sidesOf(solid);
    if (!(sides.most.x >= sides.least.x)) return fail(Fault::badFile, solid.source + " has no triangles to be seen.");
    const Vec3 size = scale * (sides.most - sides.least);
    const double widest = std::max(size.x, size.z), largest = std::max(widest, size.y);
    const auto metres = [](double m) { return asText("%.3g m", m); };
    if (largest < kSmallest) {
        return refused(solid.source, "it is " + metres(largest) + " large, and 0.02 m is the least that can be seen",
                       scale * 0.2 / largest);
    }
    if (widest > kWidest || size.y > kHighest) {
        return refused(solid.source,
                       "it is " + metres(widest) + " wide and " + metres(size.y) +
                           " high, and there is room for 1 m and 0.4 m",
                       scale * std::min(0.5 * kWidest / widest, size.y > 0.0 ? 0.5 * kHighest / size.y : 1e30));
    }
    // y up becomes z up; what faced the viewer faces who sits at the desk.
    Placed at;
    at.right = {1, 0, 0};
    at.down = {0, 0, 1};
    at.ahead = {0, -1, 0};
    at.at = {-0.5 * scale * (sides.least.x + sides.most.x), 0.5 * scale * (sides.least.z + sides.most.z),
             -scale * sides.least.y};
    Things things = thingsOf(solid, at, scale);
    Look wood;
    wood.colour = {0.46F, 0.36F, 0.27F};
    const int desk = things.addLook(wood);
    things.addSheet({-0.70, -0.55, kDesk}, {1.40, 0, 0}, {0, 1.20, 0}, desk);
    return things;
}

/// Patches of moderate contrast, for a camera's features; the same on every machine.
Image<float> patches() {
    constexpr int kSide = 48;
    std::vector<float> pixels;
    std::uint32_t state = 20;
    for (int i = 0; i < kSide * kSide; ++i) {
        state = 1664525U * state + 1013904223U;  // Numerical Recipes' generator
        const float level = 0.55F + 0.4F * static_cast<float>(state >> 24) / 255.0F;
        pixels.insert(pixels.end(), 3, level);
    }
    return {{kSide, kSide}, 3, std::move(pixels)};
}

Result<Things> asSeen(const MeasuredDepth& measured, double scale) {
    std::vector<float> metres(measured.metres.pixels().begin(), measured.metres.pixels().end());
    for (float& value : metres)
        value = value > 0.0F ? value * static_cast<float>(scale) : 0.0F;
    std::vector<float> known = metres;
    std::erase(known, 0.0F);
    if (known.empty()) return fail(Fault::badFile, measured.source + " holds no depth.");
    const auto middle = known.begin() + static_cast<std::ptrdiff_t>(known.size() / 2);
    std::ranges::nth_element(known, middle);
    const auto median = static_cast<double>(*middle);
    if (median < kNearest || median > kFarthest) {
        return refused(measured.source,
                       "its middle is " + asText("%.3g m", median) +
                           " away, and the rig sees what is "
                           "0.5 m to 2.5 m away",
                       scale * 1.1 / median);
    }
    const Pinhole& camera = measured.camera;
    SceneLens lens;
    lens.size = camera.size;
    lens.focalX = camera.fx;
    lens.focalY = camera.fy;
    lens.centreX = camera.cx;
    lens.centreY = camera.cy;
    lens.bend = camera.distortion;
    const int grid = std::max(1, (std::max(camera.size.width, camera.size.height) + 639) / 640);
    Things things =
        thingsOfDepth(Image<float>(measured.metres.size(), 1, std::move(metres)), lens, builtInCameraAt(), grid);
    Look printed;
    printed.texture = patches();
    const int look = things.addLook(printed);
    for (Triangle& triangle : things.triangles) {
        triangle.look = look;
        for (std::size_t i = 0; i < 3; ++i) {
            const auto at = lens.rasterOf(builtInCameraAt().fromWorld(triangle.corner[i]));
            if (!at) continue;
            triangle.uv[i] = {static_cast<float>((*at)[0] / camera.size.width),
                              static_cast<float>((*at)[1] / camera.size.height)};
        }
    }
    return things;
}

}  // namespace

void readScenesWith(SceneReader read) { reader() = std::move(read); }

Result<Things> thingsOf(const SceneFile& file, double scale) {
    if (const auto* solid = std::get_if<Box<Solid>>(&file)) return onDesk(**solid, scale);
    return asSeen(*std::get<Box<MeasuredDepth>>(file), scale);
}

Result<Things> sceneThings(const std::filesystem::path& path, double scale) {
    if (!reader()) {
        return fail(Fault::unsupported, "This program puts no files into the emulated scene; leave \"scene=\" out.");
    }
    return reader()(path).and_then([&](const SceneFile& file) { return thingsOf(file, scale); });
}

}  // namespace ilf::devices::scene
