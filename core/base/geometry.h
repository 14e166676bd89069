// Points, rectangles and homographies that know the frame they live in.
#pragma once

#include <algorithm>
#include <array>

namespace ilf {

/// Frames of two-dimensional points, all in pixels: x right, y down, pixel (i, j) has its centre at (i + 0.5, j + 0.5).
struct CameraFrame {};     ///< the picture regions are painted on
struct ProjectorFrame {};  ///< the projector's raster
struct WidgetFrame {};     ///< the window

template <class Frame>
struct Point {
    double x = 0.0;
    double y = 0.0;
    bool operator==(const Point&) const = default;
};

struct Size {
    int width = 0;
    int height = 0;
    bool operator==(const Size&) const = default;
};

/// Half-open rectangle of whole pixels: x0 <= x < x1, y0 <= y < y1. Empty when x1 <= x0 or y1 <= y0.
template <class Frame>
struct PixelRect {
    int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
    bool operator==(const PixelRect&) const = default;

    bool empty() const { return x1 <= x0 || y1 <= y0; }
    int width() const { return std::max(0, x1 - x0); }
    int height() const { return std::max(0, y1 - y0); }
    PixelRect grown(int by) const { return {x0 - by, y0 - by, x1 + by, y1 + by}; }
    PixelRect clipped(Size to) const {
        return {std::max(0, x0), std::max(0, y0), std::min(to.width, x1), std::min(to.height, y1)};
    }
    PixelRect united(PixelRect o) const {
        if (empty()) return o;
        if (o.empty()) return *this;
        return {std::min(x0, o.x0), std::min(y0, o.y0), std::max(x1, o.x1), std::max(y1, o.y1)};
    }
};

/// A projective map of the plane that says both ends: `Homography<ProjectorFrame, CameraFrame> projectorFromCamera`.
template <class To, class From>
struct Homography {
    /// Row-major 3x3 matrix acting on (x, y, 1).
    std::array<double, 9> m{1, 0, 0, 0, 1, 0, 0, 0, 1};
    bool operator==(const Homography&) const = default;

    Point<To> operator()(Point<From> p) const {
        const double w = m[6] * p.x + m[7] * p.y + m[8];
        return {(m[0] * p.x + m[1] * p.y + m[2]) / w, (m[3] * p.x + m[4] * p.y + m[5]) / w};
    }
    double determinant() const {
        return m[0] * (m[4] * m[8] - m[5] * m[7]) - m[1] * (m[3] * m[8] - m[5] * m[6]) +
               m[2] * (m[3] * m[7] - m[4] * m[6]);
    }
    /// The way back. Precondition: determinant() is not 0 (files and forms check it).
    Homography<From, To> inverted() const {
        const double d = 1.0 / determinant();
        return {{(m[4] * m[8] - m[5] * m[7]) * d, (m[2] * m[7] - m[1] * m[8]) * d, (m[1] * m[5] - m[2] * m[4]) * d,
                 (m[5] * m[6] - m[3] * m[8]) * d, (m[0] * m[8] - m[2] * m[6]) * d, (m[2] * m[3] - m[0] * m[5]) * d,
                 (m[3] * m[7] - m[4] * m[6]) * d, (m[1] * m[6] - m[0] * m[7]) * d, (m[0] * m[4] - m[1] * m[3]) * d}};
    }
};

}  // namespace ilf
