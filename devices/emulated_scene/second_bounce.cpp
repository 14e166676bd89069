#include "devices/emulated_scene/second_bounce.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

namespace ilf::devices::scene {
namespace {

struct Patch {
    Vec3 at, normal;
    double area = 0.0;
};

}  // namespace

SecondBounce::SecondBounce(const RayTree& tree, const SceneLens& camera, const Placed& cameraAt, double share)
    : size_(camera.size), across_((camera.size.width + kPatch - 1) / kPatch),
      down_((camera.size.height + kPatch - 1) / kPatch) {
    std::vector<std::optional<Patch>> patches;
    for (int j = 0; j < down_; ++j) {
        for (int i = 0; i < across_; ++i) {
            auto& patch = patches.emplace_back();
            const Vec3 along = camera.rayThrough((i + 0.5) * kPatch, (j + 0.5) * kPatch);
            const Vec3 there = cameraAt.turnedToWorld(along);
            const auto met = tree.first(cameraAt.at, there);
            if (!met) continue;
            const Triangle& t = tree.triangle(met->triangle);
            const double a = 1.0 - met->b - met->c;
            Vec3 n = unit(a * t.normal[0] + met->b * t.normal[1] + met->c * t.normal[2]);
            if (dot(n, there) > 0.0) n = -1.0 * n;
            const double slant = std::max(0.1, -dot(n, unit(there)));
            const double pixel = met->distance * met->distance / (camera.focalX * camera.focalY) * length(along);
            patch = Patch{cameraAt.at + met->distance * there, n, kPatch * kPatch * pixel / slant};
        }
    }
    for (std::size_t to = 0; to < patches.size(); ++to) {
        if (!patches[to]) continue;
        for (std::size_t from = 0; from < patches.size(); ++from) {
            if (from == to || !patches[from]) continue;
            const Vec3 d = patches[from]->at - patches[to]->at;
            const double r2 = dot(d, d), facing = dot(d, patches[to]->normal), thrown = -dot(d, patches[from]->normal);
            if (facing <= 1e-6 || thrown <= 1e-6) continue;
            // Patches that touch are not small against what lies between them: the disc's form factor stays below 1.
            const double area = patches[from]->area;
            const double factor = facing * thrown * area / (r2 * (std::numbers::pi * r2 + area));
            if (factor < 1e-5 || tree.blocked(patches[to]->at + 1e-4 * patches[to]->normal, d, 0.999)) continue;
            exchanges_.push_back(
                {static_cast<std::uint16_t>(to), static_cast<std::uint16_t>(from), static_cast<float>(share * factor)});
        }
    }
}

std::vector<float> SecondBounce::fallingOn(const std::vector<float>& sent) const {
    if (exchanges_.empty()) return {};
    const auto count = static_cast<std::size_t>(across_) * static_cast<std::size_t>(down_);
    std::vector<float> mean(count, 0.0F), falling(count, 0.0F);
    for (int j = 0; j < down_; ++j) {
        for (int i = 0; i < across_; ++i) {
            // One pixel in four along each side stands for the others.
            float sum = 0.0F;
            int n = 0;
            for (int y = j * kPatch; y < std::min(size_.height, (j + 1) * kPatch); y += 4) {
                const float* row = sent.data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(size_.width);
                for (int x = i * kPatch; x < std::min(size_.width, (i + 1) * kPatch); x += 4, ++n)
                    sum += row[x];
            }
            mean[static_cast<std::size_t>(j * across_ + i)] = sum / static_cast<float>(std::max(n, 1));
        }
    }
    for (const Exchange& e : exchanges_)
        falling[e.to] += e.factor * mean[e.from];
    return falling;
}

float SecondBounce::at(const std::vector<float>& falling, int x, int y) const {
    const float u = std::clamp((static_cast<float>(x) + 0.5F) / kPatch - 0.5F, 0.0F, static_cast<float>(across_ - 1));
    const float v = std::clamp((static_cast<float>(y) + 0.5F) / kPatch - 0.5F, 0.0F, static_cast<float>(down_ - 1));
    const int i = std::min(static_cast<int>(u), std::max(0, across_ - 2));
    const int j = std::min(static_cast<int>(v), std::max(0, down_ - 2));
    const int right = across_ > 1 ? 1 : 0, below = down_ > 1 ? across_ : 0;
    const float* p = falling.data() + j * across_ + i;
    const float s = u - static_cast<float>(i), t = v - static_cast<float>(j);
    return (1.0F - t) * ((1.0F - s) * p[0] + s * p[right]) + t * ((1.0F - s) * p[below] + s * p[below + right]);
}

}  // namespace ilf::devices::scene
