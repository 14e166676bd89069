#include "core/compile/border.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/compile/compile.h"

namespace ilf {

namespace {

constexpr float kHalf = 127.5F;
/// Pixels by which a joined piece may miss the border. Only the shape of the ramp feels it: the base level makes up for
/// whatever the layers light.
constexpr float kBend = 0.05F;

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
                          visible.map.toCamera(Point<ProjectorFrame>{at.x, at.y}));
    };
    return std::abs(vergence(sheet, inside) - vergence(other, outside)) > kDepthStep.si();
}

/// Finds the pieces inside single cells.
class CellScanner {
public:
    CellScanner(const Visible& visible, int sheet, const Patch<std::uint8_t>& around)
        : visible_(visible), sheet_(sheet), around_(around) {
        for (int other = 0; other < static_cast<int>(visible.weights.size()); ++other)
            maybeStep_ = maybeStep_ || (other != sheet && visible.light.mayStep(sheet, other));
    }
    /// Calls `add(piece)` for the pieces of the cell whose upper left pixel is (x, y).
    template <class Add>
    void scan(int x, int y, Add&& add) const {
        const std::uint8_t *upper = around_.row(y) + (x - around_.at.x0), *lower = upper + around_.at.width();
        const float left = static_cast<float>(x) + 0.5F, top = static_cast<float>(y) + 0.5F;
        const std::array<Spot, 4> spots{Spot{left, top}, {left + 1, top}, {left, top + 1}, {left + 1, top + 1}};
        const std::array<float, 4> v{static_cast<float>(upper[0]), static_cast<float>(upper[1]),
                                     static_cast<float>(lower[0]), static_cast<float>(lower[1])};
        bool step = false;
        if (maybeStep_) {
            const auto most = std::max_element(v.begin(), v.end()) - v.begin();
            const auto least = std::min_element(v.begin(), v.end()) - v.begin();
            step =
                isStep(visible_, sheet_, spots[static_cast<std::size_t>(most)], spots[static_cast<std::size_t>(least)]);
        }
        const auto crossing = [&](std::size_t i, std::size_t j) {
            const float t = (kHalf - v[i]) / (v[j] - v[i]);
            return Spot{spots[i].x + t * (spots[j].x - spots[i].x), spots[i].y + t * (spots[j].y - spots[i].y)};
        };
        const auto piece = [&](Spot p, Spot q) { add(BorderPiece{p.x, p.y, q.x, q.y, step}); };
        const bool a = v[0] > kHalf, b = v[1] > kHalf, c = v[2] > kHalf, d = v[3] > kHalf;
        if (a == d && b == c) {
            // A saddle: whichever side the middle is on stays connected.
            const bool middle = v[0] + v[1] + v[2] + v[3] > 4 * kHalf;
            const Spot up = crossing(0, 1), right = crossing(1, 3), down = crossing(2, 3), west = crossing(0, 2);
            if (middle == a) {
                piece(up, right), piece(west, down);
            } else {
                piece(up, west), piece(right, down);
            }
            return;
        }
        std::array<Spot, 2> ends{};
        std::size_t n = 0;
        if (a != b) ends[n++] = crossing(0, 1);
        if (b != d) ends[n++] = crossing(1, 3);
        if (c != d) ends[n++] = crossing(2, 3);
        if (a != c) ends[n++] = crossing(0, 2);
        piece(ends[0], ends[1]);
    }

private:
    const Visible& visible_;
    int sheet_;
    const Patch<std::uint8_t>& around_;
    bool maybeStep_ = false;
};

bool meets(Spot a, Spot b) { return a.x == b.x && a.y == b.y; }

/// True if the points of a chain stay close to the straight line between its ends.
bool straight(const std::vector<Spot>& chain, Spot end) {
    const Spot from = chain.front();
    const float ux = end.x - from.x, uy = end.y - from.y, limit = kBend * kBend * (ux * ux + uy * uy);
    return std::all_of(chain.begin() + 1, chain.end(), [&](Spot p) {
        const float across = (p.x - from.x) * uy - (p.y - from.y) * ux;
        return across * across <= limit;
    });
}

/// Joins the pieces of one square end to end into as few as stay within kBend of them: a smooth border has one or two
/// straight pieces in a square instead of ten, and distances cost that much less. Squares lie fast on the raster, so
/// the result does not depend on the window it is asked for.
void joinInto(std::vector<BorderPiece>& pieces, std::vector<BorderPiece>& cells) {
    const auto startOf = [](const BorderPiece& p) { return Spot{p.ax, p.ay}; };
    const auto endOf = [](const BorderPiece& p) { return Spot{p.bx, p.by}; };
    const auto hasNeighbour = [&](std::size_t self, Spot at) {
        for (std::size_t i = 0; i < cells.size(); ++i) {
            if (i != self && (meets(startOf(cells[i]), at) || meets(endOf(cells[i]), at))) return true;
        }
        return false;
    };
    std::vector<Spot> chain;
    while (!cells.empty()) {
        // Begin at a loose end where there is one, so that a line through the square is one chain.
        std::size_t first = 0;
        bool fromEnd = false;
        for (std::size_t i = 0; i < cells.size(); ++i) {
            const bool looseStart = !hasNeighbour(i, startOf(cells[i]));
            if (!looseStart && hasNeighbour(i, endOf(cells[i]))) continue;
            first = i;
            fromEnd = !looseStart;
            break;
        }
        const bool step = cells[first].step;
        chain.assign(1, fromEnd ? endOf(cells[first]) : startOf(cells[first]));
        Spot tip = fromEnd ? startOf(cells[first]) : endOf(cells[first]);
        cells.erase(cells.begin() + static_cast<std::ptrdiff_t>(first));
        const auto emit = [&](Spot to) { pieces.push_back({chain.front().x, chain.front().y, to.x, to.y, step}); };
        for (;;) {
            const auto next = std::ranges::find_if(cells, [&](const BorderPiece& p) {
                return p.step == step && (meets(startOf(p), tip) || meets(endOf(p), tip));
            });
            if (next == cells.end()) break;
            const Spot beyond = meets(startOf(*next), tip) ? endOf(*next) : startOf(*next);
            cells.erase(next);
            chain.push_back(tip);
            if (!straight(chain, beyond)) {
                emit(tip);
                chain.assign(1, tip);
            }
            tip = beyond;
        }
        emit(tip);
    }
}

}  // namespace

PixelRect<ProjectorFrame> wholeSquares(PixelRect<ProjectorFrame> rect) {
    const auto down = [](int v) { return v - ((v % kSquare) + kSquare) % kSquare; };
    const auto up = [&](int v) { return down(v + kSquare - 1); };
    return {down(rect.x0), down(rect.y0), up(rect.x1) + 1, up(rect.y1) + 1};
}

std::vector<BorderPiece> borderPieces(const Visible& visible, int sheet, const Patch<std::uint8_t>& around) {
    const CellScanner scanner(visible, sheet, around);
    std::vector<BorderPiece> pieces, cells;
    const int width = around.at.width();
    std::vector<std::uint8_t> mixed(static_cast<std::size_t>(width));
    for (int top = around.at.y0; top + kSquare < around.at.y1; top += kSquare) {
        // Which columns of this row of squares hold any border at all.
        std::ranges::fill(mixed, std::uint8_t{0});
        for (int y = top; y < top + kSquare; ++y) {
            const std::uint8_t *upper = around.row(y), *lower = around.row(y + 1);
            for (int x = 0; x + 1 < width; ++x) {
                mixed[static_cast<std::size_t>(x)] |= static_cast<std::uint8_t>(
                    (upper[x] ^ upper[x + 1]) | (upper[x] ^ lower[x]) | (upper[x] ^ lower[x + 1]));
            }
        }
        for (int left = 0; left + kSquare < width; left += kSquare) {
            std::uint8_t any = 0;
            for (int x = left; x < left + kSquare; ++x)
                any |= mixed[static_cast<std::size_t>(x)];
            if (any < 128) continue;
            cells.clear();
            for (int y = top; y < top + kSquare; ++y) {
                const std::uint8_t *upper = around.row(y), *lower = around.row(y + 1);
                for (int x = left; x < left + kSquare; ++x) {
                    if (((upper[x] ^ upper[x + 1]) | (upper[x] ^ lower[x]) | (upper[x] ^ lower[x + 1])) < 128) continue;
                    scanner.scan(around.at.x0 + x, y, [&](const BorderPiece& piece) { cells.push_back(piece); });
                }
            }
            joinInto(pieces, cells);
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
