#include "devices/emulated_scene/moving_marker.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "core/base/parallel.h"

namespace ilf::devices::scene {
namespace {

/// Tags 0 to 9 as the AprilTag project prints them (tag36h11.c of AprilTag 2): 36 bits, row by row from the upper left,
/// 1 is white.
constexpr std::array<std::uint64_t, kMarkers> kTags{0xd5d628584, 0xd97f18b49, 0xdd280910e, 0xe479e9c98, 0xebcbca822,
                                                    0xf31dab3ac, 0x056a5d085, 0x10652e1d4, 0x22b1dfead, 0x265ad0472};
constexpr int kBits = 6, kModules = kBits + 2;  // with the black border
constexpr double kCard_m = 1.5 * kMarkerSide_m;
constexpr float kWhite = 0.8F, kBlack = 0.04F;
constexpr int kFine = 8;  // rays along a pixel's side, each at its own moment of the exposure

/// Where the card's middle and axes are.
Placed cardAt(const MarkerPath& path, double time_s) {
    const double turn = path.lap_s > 0.0 ? 2.0 * std::numbers::pi * time_s / path.lap_s : 0.0;
    Placed card;
    card.ahead = unit(Vec3{0.0, 0.74, -0.68});
    const Vec3 right{1, 0, 0}, down = cross(card.ahead, right);
    const double roll = 15.0 * std::numbers::pi / 180.0 * std::sin(turn);
    card.right = std::cos(roll) * right + std::sin(roll) * down;
    card.down = std::cos(roll) * down - std::sin(roll) * right;
    card.at = Vec3{0.0, 0.0, 0.16} + 0.10 * std::cos(turn) * right + 0.04 * std::sin(turn) * down;
    return card;
}

/// Of the card, `u`, `v` metres from its middle.
float albedo(const MarkerPath& path, double u, double v, bool covered) {
    if (covered) return kWhite;
    const int x = static_cast<int>(std::floor((u / kMarkerSide_m + 0.5) * kModules));
    const int y = static_cast<int>(std::floor((v / kMarkerSide_m + 0.5) * kModules));
    if (x < 0 || y < 0 || x >= kModules || y >= kModules) return kWhite;
    if (x == 0 || y == 0 || x == kModules - 1 || y == kModules - 1) return kBlack;
    const int bit = kBits * kBits - 1 - (kBits * (y - 1) + x - 1);
    return ((kTags[static_cast<std::size_t>(path.id)] >> bit) & 1U) != 0 ? kWhite : kBlack;
}

/// Light that falls on a place of the card, lux.
float falling(const Stage& stage, const Placed& card, const Vec3& p, const std::vector<float>& light, double ambient) {
    const auto raster = stage.projector.rasterOf(stage.projectorAt.fromWorld(p));
    double lux = ambient;
    if (raster) {
        const int x = static_cast<int>(std::floor((*raster)[0])), y = static_cast<int>(std::floor((*raster)[1]));
        const Size size = stage.projector.size;
        if (x >= 0 && y >= 0 && x < size.width && y < size.height) {
            const Vec3 toLamp = stage.projectorAt.at - p;
            const double away = length(toLamp), cosine = std::max(0.0, -dot(card.ahead, toLamp) / away);
            const auto pixel =
                static_cast<std::size_t>(y) * static_cast<std::size_t>(size.width) + static_cast<std::size_t>(x);
            lux += static_cast<double>(light[pixel]) * stage.projectorLux * cosine / (away * away);
        }
    }
    return static_cast<float>(lux);
}

std::optional<std::array<double, 2>> pictured(const Stage& stage, const Vec3& world) {
    return stage.camera.rasterOf(stage.cameraAt.fromWorld(world));
}

struct Box4 {
    int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
};

/// All pixels that the card may touch while it moves.
Box4 reach(const Stage& stage, const std::vector<Placed>& cards) {
    double x0 = 1e9, y0 = 1e9, x1 = -1e9, y1 = -1e9;
    for (const Placed& card : {cards.front(), cards[cards.size() / 2], cards.back()}) {
        for (int k = 0; k < 4; ++k) {
            const double u = (k == 0 || k == 3 ? -0.5 : 0.5) * kCard_m, v = (k < 2 ? -0.5 : 0.5) * kCard_m;
            const auto at = pictured(stage, card.at + u * card.right + v * card.down);
            if (!at) continue;
            x0 = std::min(x0, (*at)[0]), x1 = std::max(x1, (*at)[0]);
            y0 = std::min(y0, (*at)[1]), y1 = std::max(y1, (*at)[1]);
        }
    }
    const Size size = stage.camera.size;
    const auto inside = [](double v, int most) { return std::clamp(static_cast<int>(std::floor(v)), 0, most); };
    return {inside(x0 - 2.0, size.width), inside(y0 - 2.0, size.height), inside(x1 + 3.0, size.width),
            inside(y1 + 3.0, size.height)};
}

}  // namespace

std::array<std::array<double, 2>, 4> markerCorners(const Stage& stage, const MarkerPath& path, double time_s) {
    const Placed card = cardAt(path, time_s);
    std::array<std::array<double, 2>, 4> corners{};
    for (std::size_t k = 0; k < 4; ++k) {
        const double u = (k == 0 || k == 3 ? -0.5 : 0.5) * kMarkerSide_m, v = (k < 2 ? -0.5 : 0.5) * kMarkerSide_m;
        corners[k] = pictured(stage, card.at + u * card.right + v * card.down).value_or(std::array{0.0, 0.0});
    }
    return corners;
}

void putMarker(const Stage& stage, const MarkerPath& path, double from_s, double to_s, const std::vector<float>& light,
               double ambientLux, std::vector<float>& lux, std::vector<std::uint8_t>& tint) {
    constexpr int kRays = kFine * kFine;
    std::vector<Placed> cards;
    std::vector<bool> covered;
    for (int i = 0; i < kRays; ++i) {
        const double t = from_s + (to_s - from_s) * (i + 0.5) / kRays;
        cards.push_back(cardAt(path, t));
        covered.push_back(t >= path.coveredFrom_s && t < path.coveredTo_s);
    }
    const Box4 box = reach(stage, cards);
    const Vec3 eye = stage.cameraAt.at;
    parallelFor(std::max(0, box.y1 - box.y0), [&](int row) {
        const int y = box.y0 + row;
        for (int x = box.x0; x < box.x1; ++x) {
            // The lens bends so little over a pixel that its rays lie evenly between those of the corners.
            const Vec3 a = stage.camera.rayThrough(x, y), b = stage.camera.rayThrough(x + 1, y),
                       c = stage.camera.rayThrough(x, y + 1);
            float sum = 0.0F;
            int hits = 0;
            for (int i = 0; i < kRays; ++i) {
                // Odd steps through the grid, so that time does not sweep along with a row.
                const int j = (i * 27) % kRays;
                const double s = (j % kFine + 0.5) / kFine, t = (j / kFine + 0.5) / kFine;
                const Vec3 ray = stage.cameraAt.turnedToWorld(a + s * (b - a) + t * (c - a));
                const Placed& card = cards[static_cast<std::size_t>(i)];
                const double steep = dot(card.ahead, ray);
                if (steep <= 1e-6) continue;
                const Vec3 p = eye + (dot(card.ahead, card.at - eye) / steep) * ray;
                const double u = dot(p - card.at, card.right), v = dot(p - card.at, card.down);
                if (std::abs(u) > 0.5 * kCard_m || std::abs(v) > 0.5 * kCard_m) continue;
                sum += albedo(path, u, v, covered[static_cast<std::size_t>(i)]) *
                       falling(stage, card, p, light, ambientLux);
                ++hits;
            }
            if (hits == 0) continue;
            const auto i = static_cast<std::size_t>(y) * static_cast<std::size_t>(stage.camera.size.width) +
                           static_cast<std::size_t>(x);
            const float behind = lux[i] * static_cast<float>(kRays - hits) / kRays, before = sum / kRays;
            lux[i] = behind + before;
            const float share = before / std::max(1e-6F, lux[i]);
            for (std::size_t k = 0; k < 3; ++k) {
                const auto old = static_cast<float>(tint[3 * i + k]);
                tint[3 * i + k] = static_cast<std::uint8_t>(old + share * (64.0F - old) + 0.5F);
            }
        }
    });
}

}  // namespace ilf::devices::scene
