#include "core/document/shape.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

namespace ilf {

namespace {

using Vertices = std::vector<Point<CameraFrame>>;

/// A band of pixel rows into which the edges of a polygon drop the change of covered area from one pixel to the next;
/// the running sum along a row is then the winding number averaged over each pixel (R. Levien, "Inside the fastest font
/// renderer in the world", 2016).
class Band {
public:
    Band(int width, int y0, int y1)
        : width_(width), y0_(y0), y1_(y1),
          changes_(static_cast<std::size_t>(width + 2) * static_cast<std::size_t>(y1 - y0)) {}

    void edge(Point<CameraFrame> a, Point<CameraFrame> b) {
        if (a.y == b.y || std::max(a.y, b.y) <= y0_ || std::min(a.y, b.y) >= y1_) return;
        const double winding = a.y < b.y ? 1.0 : -1.0;
        if (a.y > b.y) std::swap(a, b);
        // What lies left of the picture still covers the row from its first pixel on; what lies right of it, nothing.
        const auto xAt = [&](double y) { return a.x + (b.x - a.x) * ((y - a.y) / (b.y - a.y)); };
        const double top = std::max(a.y, static_cast<double>(y0_));
        const double bottom = std::min(b.y, static_cast<double>(y1_));
        double cuts[4] = {top, top, bottom, bottom};
        if (a.x != b.x) {
            const auto yAt = [&](double x) {
                return std::clamp(a.y + (b.y - a.y) * ((x - a.x) / (b.x - a.x)), top, bottom);
            };
            cuts[1] = std::min(yAt(0.0), yAt(width_));
            cuts[2] = std::max(yAt(0.0), yAt(width_));
        }
        for (int i = 0; i < 3; ++i) {
            if (cuts[i] >= cuts[i + 1]) continue;
            const auto inside = [&](double x) { return std::clamp(x, 0.0, static_cast<double>(width_)); };
            const bool beyond = xAt(0.5 * (cuts[i] + cuts[i + 1])) < 0.0;
            const bool after = xAt(0.5 * (cuts[i] + cuts[i + 1])) > width_;
            const double x0 = beyond ? 0.0 : after ? width_ : inside(xAt(cuts[i]));
            const double x1 = beyond ? 0.0 : after ? width_ : inside(xAt(cuts[i + 1]));
            piece({x0, cuts[i]}, {x1, cuts[i + 1]}, winding);
        }
    }

    /// Coverage of row `y`, non-zero winding.
    void row(int y, std::uint8_t* coverage) const {
        const double* change = &changes_[offset(y)];
        double sum = 0.0;
        for (int x = 0; x < width_; ++x) {
            sum += change[x];
            coverage[x] = static_cast<std::uint8_t>(std::min(std::abs(sum), 1.0) * 255.0 + 0.5);
        }
    }

private:
    std::size_t offset(int y) const { return static_cast<std::size_t>(y - y0_) * static_cast<std::size_t>(width_ + 2); }

    /// An edge going down, inside the band and the picture's width.
    void piece(Point<CameraFrame> a, Point<CameraFrame> b, double winding) {
        const double slope = (b.x - a.x) / (b.y - a.y);
        const int last = std::min(y1_ - 1, static_cast<int>(std::ceil(b.y)) - 1);
        for (int y = static_cast<int>(std::floor(a.y)); y <= last; ++y) {
            const double from = std::max(a.y, static_cast<double>(y));
            const double to = std::min(b.y, y + 1.0);
            if (to <= from) continue;
            const double xa = std::clamp(a.x + slope * (from - a.y), 0.0, static_cast<double>(width_));
            const double xb = std::clamp(a.x + slope * (to - a.y), 0.0, static_cast<double>(width_));
            rowPiece(&changes_[offset(y)], std::min(xa, xb), std::max(xa, xb), (to - from) * winding);
        }
    }

    /// Within one row: an edge from x0 to x1 that spans `height` of the row. The area right of it grows by the share of
    /// the edge passed, pixel by pixel.
    static void rowPiece(double* change, double x0, double x1, double height) {
        const int first = static_cast<int>(std::floor(x0));
        const int end = std::max(first + 1, static_cast<int>(std::ceil(x1)));
        double before = 0.0;
        for (int x = first; x < end; ++x) {
            // Share of pixel x to the right of the edge, averaged over the height: the edge is at l .. r while it is
            // inside the pixel, and left of it for `passedL` of the height.
            double area = x + 1.0 - x0;
            if (x1 - x0 > 1e-12) {
                const double l = std::max(x0, static_cast<double>(x));
                const double r = std::min(x1, x + 1.0);
                const double passedL = (l - x0) / (x1 - x0);
                const double passedR = (r - x0) / (x1 - x0);
                area = passedL + (passedR - passedL) * (x + 1.0 - 0.5 * (l + r));
            }
            change[x] += height * (area - before);
            before = area;
        }
        change[end] += height * (1.0 - before);
    }

    int width_, y0_, y1_;
    std::vector<double> changes_;
};

Vertices outlineOf(const Rectangle& r) { return {{r.a.x, r.a.y}, {r.b.x, r.a.y}, {r.b.x, r.b.y}, {r.a.x, r.b.y}}; }

Vertices outlineOf(const Ellipse& e) {
    const double rx = 0.5 * std::abs(e.b.x - e.a.x);
    const double ry = 0.5 * std::abs(e.b.y - e.a.y);
    const Point<CameraFrame> centre{0.5 * (e.a.x + e.b.x), 0.5 * (e.a.y + e.b.y)};
    // As many chords as keep each within 0.005 px of the arc: sagitta r (1 - cos(pi / n)) = r pi^2 / 2 n^2.
    const double chords = std::numbers::pi * std::sqrt(std::max(rx, ry) / 0.01);
    const int n = static_cast<int>(std::clamp(std::ceil(chords), 16.0, 8192.0));
    Vertices vertices;
    for (int i = 0; i < n; ++i) {
        const double angle = 2.0 * std::numbers::pi * i / n;
        vertices.push_back({centre.x + rx * std::cos(angle), centre.y + ry * std::sin(angle)});
    }
    return vertices;
}

Vertices outlineOf(const Outline& o) { return o.vertices; }

/// `known` gives the tile where it needs no computing, else an empty box; `combine` gives one pixel.
template <class Known, class Combine>
Mask combined(const Mask& a, const Mask& b, const Known& known, const Combine& combine) {
    assert(a.size() == b.size());
    Mask result = a;
    for (int row = 0; row < a.rows(); ++row) {
        for (int column = 0; column < a.columns(); ++column) {
            const Box<Tile>& ta = a.tile(column, row);
            const Box<Tile>& tb = b.tile(column, row);
            Box<Tile> shared = known(ta, tb);
            if (!shared) {
                Tile tile;
                for (std::size_t i = 0; i < tile.v.size(); ++i)
                    tile.v[i] = combine(ta->v[i], tb->v[i]);
                shared = tile == *ta ? ta : boxed(tile);
            }
            if (!shared.same(ta)) result.setTile(column, row, std::move(shared));
        }
    }
    return result;
}

const Box<Tile>& nothing() { return uniformTile(0); }
const Box<Tile>& everything() { return uniformTile(255); }

}  // namespace

Mask rasterised(const Shape& shape, Size size) {
    Mask mask(size);
    const Vertices vertices = std::visit([](const auto& s) { return outlineOf(s); }, shape);
    if (vertices.size() < 3 || mask.empty()) return mask;
    const auto [top, bottom] =
        std::minmax_element(vertices.begin(), vertices.end(), [](const auto& a, const auto& b) { return a.y < b.y; });
    std::vector<std::uint8_t> rows(static_cast<std::size_t>(size.width) * kTile);
    for (int row = 0; row < mask.rows(); ++row) {
        const int y0 = row * kTile;
        const int y1 = std::min(size.height, y0 + kTile);
        if (bottom->y <= y0 || top->y >= y1) continue;
        Band band(size.width, y0, y1);
        for (std::size_t i = 0; i < vertices.size(); ++i)
            band.edge(vertices[i], vertices[(i + 1) % vertices.size()]);
        for (int y = y0; y < y1; ++y) {
            band.row(y, &rows[static_cast<std::size_t>(y - y0) * static_cast<std::size_t>(size.width)]);
        }
        for (int column = 0; column < mask.columns(); ++column) {
            Tile tile;
            const PixelRect<CameraFrame> at = mask.pixelsOf(column, row);
            for (int y = 0; y < at.height(); ++y) {
                const auto from = static_cast<std::size_t>(y) * static_cast<std::size_t>(size.width) +
                                  static_cast<std::size_t>(at.x0);
                std::copy_n(&rows[from], at.width(), &tile.at(0, y));
            }
            mask.setTile(column, row, boxed(tile));
        }
    }
    return mask;
}

Mask united(const Mask& a, const Mask& b) {
    const auto known = [](const Box<Tile>& ta, const Box<Tile>& tb) {
        if (tb.same(nothing()) || ta.same(everything())) return ta;
        if (ta.same(nothing()) || tb.same(everything())) return tb;
        return Box<Tile>();
    };
    return combined(a, b, known, [](std::uint8_t x, std::uint8_t y) { return std::max(x, y); });
}

Mask subtracted(const Mask& a, const Mask& b) {
    const auto known = [](const Box<Tile>& ta, const Box<Tile>& tb) {
        if (tb.same(nothing()) || ta.same(nothing())) return ta;
        if (tb.same(everything())) return nothing();
        return Box<Tile>();
    };
    return combined(a, b, known,
                    [](std::uint8_t x, std::uint8_t y) { return std::min(x, static_cast<std::uint8_t>(255 - y)); });
}

Mask inverted(const Mask& mask) {
    Mask result = mask;
    for (int row = 0; row < mask.rows(); ++row) {
        for (int column = 0; column < mask.columns(); ++column) {
            const Box<Tile>& before = mask.tile(column, row);
            if (before.same(uniformTile(before->v[0]))) {
                result.setTile(column, row, uniformTile(static_cast<std::uint8_t>(255 - before->v[0])));
                continue;
            }
            Tile tile;
            for (std::size_t i = 0; i < tile.v.size(); ++i)
                tile.v[i] = static_cast<std::uint8_t>(255 - before->v[i]);
            result.setTile(column, row, boxed(tile));
        }
    }
    return result;
}

}  // namespace ilf
