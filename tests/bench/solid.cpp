// glTF scenes: what loading and drawing cost, beside what a plain loop over all triangles' boxes costs on one core, and
// how far depth is off rays against all triangles.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "core/base/parallel.h"
#include "core/solid/draw.h"
#include "core/solid/extent.h"
#include "core/solid/pose.h"
#include "projects/gltf_file.h"
#include "tests/core/solid/cast.h"
#include "tests/support/test_data.h"

namespace {

using namespace ilf;

constexpr Size kPicture{1280, 1024};

struct Car {
    std::filesystem::path file;
    Box<Solid> solid;
    Pinhole camera = plainPinhole(kPicture, 1600.0);
    Pose<CameraSpace, ModelSpace> pose;  ///< from 9 cm: the model fills most of the picture
};

const Car* car() {
    static const std::optional<Car> found = []() -> std::optional<Car> {
        const auto file = testData("01_gltf/khronos/ToyCar/glTF/ToyCar.gltf");
        if (!file) return std::nullopt;
        const auto scene = projects::readGltf(*file);
        if (!scene) return std::nullopt;
        Car car;
        car.file = *file;
        car.solid = scene->solid;
        car.pose = lookingAt({0.04, 0.03, 0.065}, {0.0, -0.004, 0.0});
        return car;
    }();
    return found ? &*found : nullptr;
}

/// What a first program would do: every pixel of every triangle's box, floats, one core.
Image<float> plainDepth(const Solid& solid, const Pinhole& camera, const Pose<CameraSpace, ModelSpace>& pose) {
    const int w = camera.size.width, h = camera.size.height;
    std::vector<float> depth(static_cast<std::size_t>(w) * static_cast<std::size_t>(h), 0.0F);
    for (const Box<Mesh>& mesh : solid.meshes) {
        for (const auto& triangle : mesh->triangles) {
            std::array<std::array<float, 3>, 3> p{};  // pixel and 1 / z
            bool before = true;
            for (std::size_t i = 0; i < 3; ++i) {
                const auto& at = mesh->positions[triangle[i]];
                const auto q = pose({at[0], at[1], at[2]});
                before = before && q.z > kNearestDrawn_m;
                p[i] = {static_cast<float>(camera.fx * q.x / q.z + camera.cx),
                        static_cast<float>(camera.fy * q.y / q.z + camera.cy), static_cast<float>(1.0 / q.z)};
            }
            const float area = (p[1][0] - p[0][0]) * (p[2][1] - p[0][1]) - (p[1][1] - p[0][1]) * (p[2][0] - p[0][0]);
            if (!before || area == 0.0F) continue;
            const auto [left, right] = std::minmax({p[0][0], p[1][0], p[2][0]});
            const auto [top, bottom] = std::minmax({p[0][1], p[1][1], p[2][1]});
            const int x0 = std::max(0, static_cast<int>(left)), x1 = std::min(w - 1, static_cast<int>(right) + 1);
            const int y0 = std::max(0, static_cast<int>(top)), y1 = std::min(h - 1, static_cast<int>(bottom) + 1);
            for (int y = y0; y <= y1; ++y) {
                for (int x = x0; x <= x1; ++x) {
                    const float px = static_cast<float>(x) + 0.5F, py = static_cast<float>(y) + 0.5F;
                    std::array<float, 3> share{};
                    bool inside = true;
                    for (std::size_t i = 0; i < 3; ++i) {
                        const auto &a = p[(i + 1) % 3], &b = p[(i + 2) % 3];
                        share[i] = ((b[0] - a[0]) * (py - a[1]) - (b[1] - a[1]) * (px - a[0])) / area;
                        inside = inside && share[i] >= 0.0F;
                    }
                    if (!inside) continue;
                    const float z = 1.0F / (share[0] * p[0][2] + share[1] * p[1][2] + share[2] * p[2][2]);
                    float& there =
                        depth[static_cast<std::size_t>(y) * static_cast<std::size_t>(w) + static_cast<std::size_t>(x)];
                    if (there == 0.0F || z < there) there = z;
                }
            }
        }
    }
    return {camera.size, 1, std::move(depth)};
}

constexpr int kSamples = 400;

std::array<int, 2> sample(int i) { return {(i * 7919 + 13) % kPicture.width, (i * 104729 + 7) % kPicture.height}; }

const std::vector<Cast>& rays(const Car& car) {
    static const std::vector<Cast> truth = [&] {
        std::vector<Cast> found(kSamples);
        parallelFor(kSamples, [&](int i) {
            const auto [x, y] = sample(i);
            found[static_cast<std::size_t>(i)] = cast(*car.solid, car.camera, car.pose, x + 0.5, y + 0.5);
        });
        return found;
    }();
    return truth;
}

/// Over sample pixels that no outline comes nearer than a hundredth of a pixel: the worst difference in micrometres,
/// and how many see another thing.
void judge(benchmark::State& state, const Image<float>& depth, const Car& car) {
    const std::vector<Cast>& truth = rays(car);
    double worst = 0.0;
    int other = 0, compared = 0, hit = 0;
    for (int i = 0; i < kSamples; ++i) {
        const Cast& one = truth[static_cast<std::size_t>(i)];
        if (one.margin < 0.01) continue;
        const double got = static_cast<double>(depth.at(sample(i)[0], sample(i)[1]));
        ++compared;
        hit += one.depth > 0.0 ? 1 : 0;
        if ((got > 0.0) != (one.depth > 0.0)) {
            ++other;
        } else {
            worst = std::max(worst, std::abs(got - one.depth));
        }
    }
    state.counters["error"] = 1e6 * worst;
    state.counters["other"] = other;
    state.SetLabel("error: micrometres of depth, worst of " + std::to_string(hit) + " rays that hit; other: of " +
                   std::to_string(compared) + " rays, those that see another thing");
}

void load(benchmark::State& state, bool textures) {
    if (car() == nullptr) return state.SkipWithError("test data absent");
    std::size_t triangles = 0;
    for (auto _ : state) {
        const auto scene = projects::readGltf(car()->file, {textures});
        triangles = scene ? triangleCount(*scene->solid) : 0;
    }
    const auto extent = extentOf(*car()->solid);
    constexpr std::array<double, 6> kTruth{-0.03499509, -0.01620627, -0.03698115, 0.03844783, 0.01261662, 0.03698114};
    double off = triangles == 108936 ? 0.0 : 1e9;
    for (std::size_t i = 0; i < 3; ++i) {
        off = std::max({off, std::abs(static_cast<double>(extent->least[i]) - kTruth[i]),
                        std::abs(static_cast<double>(extent->most[i]) - kTruth[i + 3])});
    }
    state.counters["error"] = off;
    state.SetLabel("error: metres, of the box against glTF-Transform's");
}

template <class Draw>
void depth(benchmark::State& state, Draw draw) {
    if (car() == nullptr) return state.SkipWithError("test data absent");
    Image<float> seen;
    for (auto _ : state)
        seen = draw(*car()->solid, car()->camera, car()->pose);
    judge(state, seen, *car());
}

/// From the file to depth, as `gltf depth` does it: the figure.
void loadAndDraw(benchmark::State& state) {
    if (car() == nullptr) return state.SkipWithError("test data absent");
    Image<float> seen;
    for (auto _ : state) {
        const auto scene = projects::readGltf(car()->file, {false});
        if (!scene) return state.SkipWithError("not read");
        seen = drawnDepth(*scene->solid, car()->camera, car()->pose);
    }
    judge(state, seen, *car());
}

}  // namespace

BENCHMARK(loadAndDraw)->Name("toycar/load-and-depth/1280x1024")->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK_CAPTURE(load, textures, true)->Name("toycar/load/textures")->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK_CAPTURE(load, bare, false)->Name("toycar/load/bare")->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK_CAPTURE(depth, tiles, [](const auto&... of) { return drawnDepth(of...); }) -> Name("toycar/depth/tiles")
    -> Unit(benchmark::kMillisecond) -> UseRealTime();
BENCHMARK_CAPTURE(depth, plain, [](const auto&... of) { return plainDepth(of...); }) -> Name("toycar/depth/plain-loop")
    -> Unit(benchmark::kMillisecond) -> UseRealTime();
BENCHMARK_CAPTURE(depth, picture, [](const auto&... of) { return drawn(of...).depth; })
    -> Name("toycar/depth-and-picture/tiles") -> Unit(benchmark::kMillisecond) -> UseRealTime();

BENCHMARK_MAIN();
