#include "core/compile/border.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/compile/compile.h"

namespace ilf {

namespace {

constexpr float kHalf = 127.5F;

struct Spot {
    float x, y;
};

/// Which sheet other than `sheet` shows most at a pixel.
int otherSheet(const Visible& visible, int sheet, int x, int y) {
    int best = -1, most = -1;
    for (int other = 0; other < static_cast<int>(visible.weights.size()); ++other) {
        const int weight = visible.weights[static_cast<std::size_t>(other)].at(x, y);
        if (other != sheet && weight > most) best = other, most = weight;
    }
    return best;
}

bool isStep(const Visible& visible, int sheet, Spot inside, Spot outside) {
    const Size size = visible.light.projector;
    const int x = std::clamp(static_cast<int>(outside.x), 0, size.width - 1);
    const int y = std::clamp(static_cast<int>(outside.y), 0, size.height - 1);
    const int other = otherSheet(visible, sheet, x, y);
    if (other < 0 || !visible.light.mayStep(sheet, other)) return false;
    const auto vergence = [&](int which, Spot at) {
        return vergenceAt(visible.document, visible.light.sheets[static_cast<std::size_t>(which)],
                          visible.cameraFromProjector(Point<ProjectorFrame>{at.x, at.y}));
    };
    return std::abs(vergence(sheet, inside) - vergence(other, outside)) > kDepthStep.si();
}

}  // namespace

std::vector<BorderPiece> borderPieces(const Visible& visible, int sheet, const Patch<std::uint8_t>& around) {
    bool maybeStep = false;
    for (int other = 0; other < static_cast<int>(visible.weights.size()); ++other)
        maybeStep = maybeStep || (other != sheet && visible.light.mayStep(sheet, other));

    std::vector<BorderPiece> pieces;
    const int width = around.at.width();
    std::vector<std::uint8_t> mixed(static_cast<std::size_t>(width));
    for (int y = around.at.y0; y + 1 < around.at.y1; ++y) {
        const std::uint8_t *upper = around.row(y), *lower = around.row(y + 1);
        unsigned any = 0;
        for (int x = 0; x + 1 < width; ++x) {
            const unsigned a = upper[x] >> 7, b = upper[x + 1] >> 7, c = lower[x] >> 7, d = lower[x + 1] >> 7;
            const unsigned m = (a ^ b) | (a ^ c) | (a ^ d);
            mixed[static_cast<std::size_t>(x)] = static_cast<std::uint8_t>(m);
            any |= m;
        }
        if (any == 0) continue;
        for (int x = 0; x + 1 < width; ++x) {
            if (mixed[static_cast<std::size_t>(x)] == 0) continue;
            const float left = static_cast<float>(around.at.x0 + x) + 0.5F, top = static_cast<float>(y) + 0.5F;
            const std::array<Spot, 4> spots{Spot{left, top}, {left + 1, top}, {left, top + 1}, {left + 1, top + 1}};
            const std::array<float, 4> v{static_cast<float>(upper[x]), static_cast<float>(upper[x + 1]),
                                         static_cast<float>(lower[x]), static_cast<float>(lower[x + 1])};
            bool step = false;
            if (maybeStep) {
                const auto most = std::max_element(v.begin(), v.end()) - v.begin();
                const auto least = std::min_element(v.begin(), v.end()) - v.begin();
                step = isStep(visible, sheet, spots[static_cast<std::size_t>(most)],
                              spots[static_cast<std::size_t>(least)]);
            }
            const auto crossing = [&](std::size_t i, std::size_t j) {
                const float t = (kHalf - v[i]) / (v[j] - v[i]);
                return Spot{spots[i].x + t * (spots[j].x - spots[i].x), spots[i].y + t * (spots[j].y - spots[i].y)};
            };
            const auto add = [&](Spot a, Spot b) { pieces.push_back({a.x, a.y, b.x, b.y, step}); };
            const bool a = v[0] > kHalf, b = v[1] > kHalf, c = v[2] > kHalf, d = v[3] > kHalf;
            if (a == d && b == c) {
                // A saddle: whichever side the middle is on stays connected.
                const bool middle = v[0] + v[1] + v[2] + v[3] > 4 * kHalf;
                const Spot up = crossing(0, 1), right = crossing(1, 3), down = crossing(2, 3), west = crossing(0, 2);
                if (middle == a) {
                    add(up, right), add(west, down);
                } else {
                    add(up, west), add(right, down);
                }
                continue;
            }
            std::array<Spot, 2> ends{};
            std::size_t n = 0;
            if (a != b) ends[n++] = crossing(0, 1);
            if (b != d) ends[n++] = crossing(1, 3);
            if (c != d) ends[n++] = crossing(2, 3);
            if (a != c) ends[n++] = crossing(0, 2);
            add(ends[0], ends[1]);
        }
    }
    return pieces;
}

void lowerToDistance(const std::vector<BorderPiece>& pieces, bool step, float radius, Patch<float>& squared) {
    for (const BorderPiece& piece : pieces) {
        if (piece.step != step) continue;
        const float ux = piece.bx - piece.ax, uy = piece.by - piece.ay;
        const float scale = 1.0F / std::max(ux * ux + uy * uy, 1e-12F);
        const float low = std::min(piece.ay, piece.by), high = std::max(piece.ay, piece.by);
        const int y0 = std::max(squared.at.y0, static_cast<int>(std::floor(low - radius)));
        const int y1 = std::min(squared.at.y1, static_cast<int>(std::ceil(high + radius)) + 1);
        for (int y = y0; y < y1; ++y) {
            const float cy = static_cast<float>(y) + 0.5F;
            const float off = std::max({0.0F, low - cy, cy - high});
            if (off >= radius) continue;
            const float half = std::sqrt(radius * radius - off * off);
            const int x0 = std::max(squared.at.x0, static_cast<int>(std::floor(std::min(piece.ax, piece.bx) - half)));
            const int x1 =
                std::min(squared.at.x1, static_cast<int>(std::ceil(std::max(piece.ax, piece.bx) + half)) + 1);
            float* line = squared.row(y) - squared.at.x0;
            const float wy = cy - piece.ay, first = 0.5F - piece.ax, along = wy * uy;
            for (int x = x0; x < x1; ++x) {
                const float wx = static_cast<float>(x) + first;
                const float t = std::min(1.0F, std::max(0.0F, (wx * ux + along) * scale));
                const float dx = wx - t * ux, dy = wy - t * uy;
                line[x] = std::min(line[x], dx * dx + dy * dy);
            }
        }
    }
}

}  // namespace ilf
