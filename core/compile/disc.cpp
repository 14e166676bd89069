#include "core/compile/disc.h"

#include <cmath>
#include <cstdlib>

namespace ilf {

namespace {

/// Area of the unit pixel around (x, y), x, y >= 0, inside a disc around the origin: 32 exact strips.
double areaInside(double x, double y, double radius) {
    constexpr int kStrips = 32;
    double area = 0.0;
    for (int i = 0; i < kStrips; ++i) {
        const double sy = y - 0.5 + (i + 0.5) / kStrips;
        const double half = radius * radius - sy * sy;
        if (half <= 0.0) continue;
        const double reach = std::sqrt(half);
        area += std::max(0.0, std::min(x + 0.5, reach) - std::max(x - 0.5, -reach));
    }
    return area / kStrips;
}

}  // namespace

Disc::Disc(double radius) {
    const int reach = std::max(0, static_cast<int>(std::ceil(radius - 0.5)));
    double sum = 0.0;
    std::vector<std::vector<double>> areas(static_cast<std::size_t>(reach + 1));
    for (int y = 0; y <= reach; ++y) {
        for (int x = 0; x <= reach; ++x) {
            const double area = radius < 0.5 ? 1.0 : areaInside(x, y, radius);
            areas[static_cast<std::size_t>(y)].push_back(area);
            sum += area * (x > 0 ? 2 : 1) * (y > 0 ? 2 : 1);
        }
    }
    wholeWeight_ = static_cast<float>(1.0 / sum);
    for (const std::vector<double>& line : areas) {
        Row row;
        for (const double area : line) {
            if (area > 1.0 - 1e-9 && row.rim.empty()) {
                ++row.whole;
            } else if (area > 0.0) {
                row.rim.push_back(static_cast<float>(area / sum));
            }
        }
        rows_.push_back(std::move(row));
    }
}

double Disc::weight(int dx, int dy) const {
    if (std::abs(dy) > reach()) return 0.0;
    const Row& row = rows_[static_cast<std::size_t>(std::abs(dy))];
    if (std::abs(dx) <= row.whole) return static_cast<double>(wholeWeight_);
    const auto rim = static_cast<std::size_t>(std::abs(dx) - row.whole - 1);
    return rim < row.rim.size() ? static_cast<double>(row.rim[rim]) : 0.0;
}

Patch<float> Disc::averaged(const Patch<std::uint8_t>& light, PixelRect<ProjectorFrame> at) const {
    Patch<float> result(at, 0.0F);
    const int width = at.width(), around = reach(), lineWidth = width + 2 * around;
    std::vector<float> line(static_cast<std::size_t>(lineWidth)), sums(static_cast<std::size_t>(lineWidth + 1)),
        filtered(static_cast<std::size_t>(width));
    for (int y = at.y0 - around; y < at.y1 + around; ++y) {
        // Sums of bytes over a row stay far below 2^24, so that floats hold them exactly.
        const std::uint8_t* source = light.row(y) + (at.x0 - around - light.at.x0);
        bool dark = true;
        for (int x = 0; x < lineWidth; ++x) {
            line[static_cast<std::size_t>(x)] = static_cast<float>(source[x]);
            sums[static_cast<std::size_t>(x + 1)] = sums[static_cast<std::size_t>(x)] + static_cast<float>(source[x]);
            dark = dark && source[x] == 0;
        }
        if (dark) continue;
        for (int dy = 0; dy <= around; ++dy) {
            const bool above = y - dy >= at.y0 && y - dy < at.y1, below = dy > 0 && y + dy >= at.y0 && y + dy < at.y1;
            if (!above && !below) continue;
            const Row& row = rows_[static_cast<std::size_t>(dy)];
            float* out = filtered.data();
            const float* centre = line.data() + around;
            if (row.whole >= 0) {
                const float* from = sums.data() + around - row.whole;
                const float* to = sums.data() + around + row.whole + 1;
                for (int x = 0; x < width; ++x)
                    out[x] = wholeWeight_ * (to[x] - from[x]);
            } else {
                // A row that the disc only grazes: its middle pixel is the first of the rim, once and not twice.
                for (int x = 0; x < width; ++x)
                    out[x] = row.rim.empty() ? 0.0F : -row.rim[0] * centre[x];
            }
            for (std::size_t k = 0; k < row.rim.size(); ++k) {
                const int dx = row.whole + 1 + static_cast<int>(k);
                const float weight = row.rim[k];
                const float *left = centre - dx, *right = centre + dx;
                for (int x = 0; x < width; ++x)
                    out[x] += weight * (left[x] + right[x]);
            }
            if (above) {
                float* to = result.row(y - dy);
                for (int x = 0; x < width; ++x)
                    to[x] += out[x];
            }
            if (below) {
                float* to = result.row(y + dy);
                for (int x = 0; x < width; ++x)
                    to[x] += out[x];
            }
        }
    }
    return result;
}

}  // namespace ilf
