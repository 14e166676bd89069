#include "core/track/marker_edges.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

namespace ilf {

namespace {

constexpr double kStep_px = 0.25;   // between samples across the outline
constexpr double kClearStep = 6.0;  // grey values: less is noise, not an edge
constexpr double kHuber_px = 0.3;   // edge points farther from their line count less
constexpr int kPasses = 3;          // of looking for edges, each from better lines

double sampled(const Image<std::uint8_t>& grey, double x, double y) {
    const double px = std::clamp(x - 0.5, 0.0, grey.width() - 1.001);
    const double py = std::clamp(y - 0.5, 0.0, grey.height() - 1.001);
    const int ix = static_cast<int>(px), iy = static_cast<int>(py);
    const double fx = px - ix, fy = py - iy;
    const std::uint8_t* a = grey.row(iy) + ix;
    const std::uint8_t* b = a + grey.stride();
    return (a[0] * (1 - fx) + a[1] * fx) * (1 - fy) + (b[0] * (1 - fx) + b[1] * fx) * fy;
}

struct Line {
    Point<CameraFrame> at;
    double dx = 1.0, dy = 0.0;  ///< unit direction
    bool fitted = false;
};

struct EdgePoint {
    Point<CameraFrame> at;
    double weight = 1.0;
};

struct Side {
    std::vector<EdgePoint> edges;
    int asked = 0;
    double steps = 0.0;  ///< sum of the edges' heights
};

/// Edges along a side: at each place the centre of the rise from dark (inside) to light (outside).
Side edgesAlong(const Image<std::uint8_t>& grey, Point<CameraFrame> a, Point<CameraFrame> b, double reach) {
    Side side;
    const double length = std::hypot(b.x - a.x, b.y - a.y);
    const double tx = (b.x - a.x) / length, ty = (b.y - a.y) / length;
    const double nx = ty, ny = -tx;  // outwards, as corners run clockwise in the picture
    // Near the corners another side's edge bends this one.
    const double margin = std::max(1.0, 0.08 * length);
    const int count = std::clamp(static_cast<int>(length - 2.0 * margin), 4, 64);
    const int half = static_cast<int>(std::ceil(reach / kStep_px));
    std::vector<double> profile(static_cast<std::size_t>(2 * half + 1));
    for (int i = 0; i < count; ++i) {
        const double t = margin + (length - 2.0 * margin) * (i + 0.5) / count;
        const Point<CameraFrame> on{a.x + t * tx, a.y + t * ty};
        for (int k = -half; k <= half; ++k) {
            const double s = k * kStep_px;
            profile[static_cast<std::size_t>(k + half)] = sampled(grey, on.x + s * nx, on.y + s * ny);
        }
        ++side.asked;
        // The steepest rise, over a pixel, then the centre of all rise about it: what lies beyond the next dip is
        // another edge.
        const int wide = static_cast<int>(std::lround(1.0 / kStep_px));
        int best = -1;
        double most = kClearStep;
        for (int k = 0; k + wide <= 2 * half; ++k) {
            const double rise = profile[static_cast<std::size_t>(k + wide)] - profile[static_cast<std::size_t>(k)];
            if (rise > most) {
                most = rise;
                best = k;
            }
        }
        if (best < 0) continue;
        int from = best, to = best + wide;
        while (from > 0 && profile[static_cast<std::size_t>(from - 1)] < profile[static_cast<std::size_t>(from)])
            --from;
        while (to < 2 * half && profile[static_cast<std::size_t>(to + 1)] > profile[static_cast<std::size_t>(to)])
            ++to;
        double sum = 0.0, weight = 0.0;
        for (int k = from; k < to; ++k) {
            const double rise = profile[static_cast<std::size_t>(k + 1)] - profile[static_cast<std::size_t>(k)];
            sum += rise * (k + 0.5 - half) * kStep_px;
            weight += rise;
        }
        if (weight < kClearStep) continue;
        const double s = sum / weight;
        side.edges.push_back({{on.x + s * nx, on.y + s * ny}, weight});
        side.steps += weight;
    }
    return side;
}

double off(const Line& line, const Point<CameraFrame>& p) {
    return (p.x - line.at.x) * line.dy - (p.y - line.at.y) * line.dx;
}

/// Total least squares, re-weighted (Huber).
Line lineThrough(const std::vector<EdgePoint>& edges) {
    Line line;
    for (int pass = 0; pass < 6; ++pass) {
        double w = 0.0, mx = 0.0, my = 0.0;
        const auto weightOf = [&](const EdgePoint& e) {
            if (pass == 0) return e.weight;
            const double d = std::abs(off(line, e.at));
            return e.weight * (d <= kHuber_px ? 1.0 : kHuber_px / d);
        };
        std::vector<double> weights(edges.size());
        for (std::size_t i = 0; i < edges.size(); ++i) {
            weights[i] = weightOf(edges[i]);
            w += weights[i];
            mx += weights[i] * edges[i].at.x;
            my += weights[i] * edges[i].at.y;
        }
        mx /= w;
        my /= w;
        double xx = 0.0, xy = 0.0, yy = 0.0;
        for (std::size_t i = 0; i < edges.size(); ++i) {
            const double ex = edges[i].at.x - mx, ey = edges[i].at.y - my;
            xx += weights[i] * ex * ex;
            xy += weights[i] * ex * ey;
            yy += weights[i] * ey * ey;
        }
        const double angle = 0.5 * std::atan2(2.0 * xy, xx - yy);
        line = {{mx, my}, std::cos(angle), std::sin(angle), true};
    }
    return line;
}

std::optional<Point<CameraFrame>> crossing(const Line& a, const Line& b) {
    const double d = a.dx * b.dy - a.dy * b.dx;
    if (std::abs(d) < 0.05) return std::nullopt;  // sides that run within 3 degrees of each other have no corner
    const double t = ((b.at.x - a.at.x) * b.dy - (b.at.y - a.at.y) * b.dx) / d;
    return Point<CameraFrame>{a.at.x + t * a.dx, a.at.y + t * a.dy};
}

}  // namespace

Outlined outlined(const Image<std::uint8_t>& grey, const Quad& rough, int modules) {
    Outlined result;
    result.corners = rough;
    const bool clockwise = signedArea(rough) > 0.0;
    const double runaway = std::max(4.0, 0.2 * std::sqrt(std::abs(signedArea(rough))));
    for (int pass = 0; pass < kPasses; ++pass) {
        std::array<Line, 4> lines;
        int asked = 0;
        std::size_t found = 0;
        double squares = 0.0, steps = 0.0;
        for (std::size_t i = 0; i < 4; ++i) {
            auto a = result.corners[i], b = result.corners[(i + 1) % 4];
            if (!clockwise) std::swap(a, b);
            const double length = std::hypot(b.x - a.x, b.y - a.y);
            if (!(length >= 4.0)) return result;
            const double reach = std::clamp(0.8 * length / modules, 1.25, pass == 0 ? 4.0 : 2.0);
            const Side side = edgesAlong(grey, a, b, reach);
            asked += side.asked;
            if (side.edges.size() < 3 || 2 * side.edges.size() < static_cast<std::size_t>(side.asked)) {
                // Too little of this side is seen: the rough one stands.
                lines[i] = {a, (b.x - a.x) / length, (b.y - a.y) / length, false};
                continue;
            }
            lines[i] = lineThrough(side.edges);
            found += side.edges.size();
            steps += side.steps;
            for (const EdgePoint& e : side.edges)
                squares += std::min(off(lines[i], e.at) * off(lines[i], e.at), 1.0);
        }
        result.found = asked > 0 ? static_cast<double>(found) / asked : 0.0;
        result.rms_px = found > 0 ? std::sqrt(squares / static_cast<double>(found)) : 0.0;
        result.contrast = found > 0 ? steps / static_cast<double>(found) : 0.0;
        Quad next = result.corners;
        for (std::size_t i = 0; i < 4; ++i) {
            const auto corner = crossing(lines[(i + 3) % 4], lines[i]);
            if (!corner) return result;
            next[i] = *corner;
        }
        if (farthestCorner(next, rough) > runaway) {
            result.found = 0.0;  // lines of something that is no side of this marker
            return result;
        }
        result.corners = next;
    }
    return result;
}

}  // namespace ilf
