#include "core/registration/gray_code_smooth.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "core/base/parallel.h"
#include "core/registration/gray_code.h"
#include "core/registration/gray_code_agree.h"

namespace ilf {

namespace {

constexpr auto kDecoded = static_cast<std::uint8_t>(PixelState::decoded);
constexpr auto kInconsistent = static_cast<std::uint8_t>(PixelState::inconsistent);

/// The symmetric system of a weighted fit of 1, i, j.
struct Normal {
    double a[6]{}, x[3]{}, y[3]{};

    void add(double w, double i, double j, double px, double py) {
        const double f[3] = {1.0, i, j};
        int k = 0;
        for (int r = 0; r < 3; ++r) {
            for (int c = r; c < 3; ++c)
                a[k++] += w * f[r] * f[c];
            x[r] += w * f[r] * px;
            y[r] += w * f[r] * py;
        }
    }
    /// Cramer's rule; nothing when the points lie on a line.
    bool solve(Trend& out) const {
        const double m[3][3] = {{a[0], a[1], a[2]}, {a[1], a[3], a[4]}, {a[2], a[4], a[5]}};
        const auto minor = [&](int r, int c) {
            const int r1 = (r + 1) % 3, r2 = (r + 2) % 3, c1 = (c + 1) % 3, c2 = (c + 2) % 3;
            return m[r1][c1] * m[r2][c2] - m[r1][c2] * m[r2][c1];
        };
        const double det = m[0][0] * minor(0, 0) + m[0][1] * minor(0, 1) + m[0][2] * minor(0, 2);
        if (!(std::abs(det) > 1e-9 * a[0] * a[0] * a[0])) return false;
        for (int c = 0; c < 3; ++c) {
            const auto column = static_cast<std::size_t>(c);
            out[column] = (x[0] * minor(0, c) + x[1] * minor(1, c) + x[2] * minor(2, c)) / det;
            out[3 + column] = (y[0] * minor(0, c) + y[1] * minor(1, c) + y[2] * minor(2, c)) / det;
        }
        return true;
    }
};

struct Sample {
    double i, j, x, y;
};

double error(const Trend& t, const Sample& s) {
    return std::hypot(t[0] + t[1] * s.i + t[2] * s.j - s.x, t[3] + t[4] * s.i + t[5] * s.j - s.y);
}

}  // namespace

Trend trendOf(const Places& places) {
    const int step = std::max(1, std::min(places.camera.width, places.camera.height) / 60);
    std::vector<Sample> samples;
    for (int j = step / 2; j < places.camera.height; j += step) {
        for (int i = step / 2; i < places.camera.width; i += step) {
            const auto n = static_cast<std::size_t>(j) * static_cast<std::size_t>(places.camera.width) +
                           static_cast<std::size_t>(i);
            if (places.state[n] == kDecoded)
                samples.push_back({double(i), double(j), places.at[2 * n], places.at[2 * n + 1]});
        }
    }
    Trend trend{};
    if (samples.size() < 3) return trend;
    // Cauchy's weights, their scale the median error of the fit before.
    std::vector<double> errors(samples.size(), 0.0);
    double scale = 1.0;
    for (int round = 0; round < 12; ++round) {
        Normal normal;
        for (std::size_t n = 0; n < samples.size(); ++n) {
            const double e = errors[n] / scale;
            normal.add(1.0 / (1.0 + e * e), samples[n].i, samples[n].j, samples[n].x, samples[n].y);
        }
        if (!normal.solve(trend)) return trend;
        for (std::size_t n = 0; n < samples.size(); ++n)
            errors[n] = error(trend, samples[n]);
        std::vector<double> sorted = errors;
        std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2), sorted.end());
        scale = std::max(0.25, 1.5 * sorted[sorted.size() / 2]);
    }
    return trend;
}

std::vector<std::uint8_t> steadied(Places& places, const Trend& trend, std::array<double, 2> within) {
    // Departures from the trend in sixteenths of a pixel, 16 bits, with a margin so that no loop asks for borders.
    constexpr int kReach = kAgreeReach;
    constexpr float kUnit = 16.0F;
    constexpr std::int16_t kFar = 8000;       // 500 raster pixels off the trend: no farther
    constexpr std::int16_t kNowhere = 20000;  // agrees with nobody
    const int width = places.camera.width, height = places.camera.height;
    const auto columns = static_cast<std::size_t>(width);
    const std::size_t stride = columns + 2 * kReach;
    std::vector<std::int16_t> px(stride * static_cast<std::size_t>(height + 2 * kReach) + kAgreeOverrun, kNowhere);
    std::vector<std::int16_t> py = px;
    parallelFor(height, [&](int j) {
        const std::size_t from = static_cast<std::size_t>(j) * columns;
        const std::size_t to = static_cast<std::size_t>(j + kReach) * stride + kReach;
        for (std::size_t i = 0; i < columns; ++i) {
            if (places.state[from + i] != kDecoded) continue;
            const double x = trend[0] + trend[1] * double(i) + trend[2] * j;
            const double y = trend[3] + trend[4] * double(i) + trend[5] * j;
            const auto leave = [&](float at, double trendAt) {
                const float units = (at - static_cast<float>(trendAt)) * kUnit;
                return static_cast<std::int16_t>(std::clamp(units, -float(kFar), float(kFar)));
            };
            px[to + i] = leave(places.at[2 * (from + i)], x);
            py[to + i] = leave(places.at[2 * (from + i) + 1], y);
        }
    });

    // 25 differences of at most 75 raster pixels still add up in 16 bits.
    const auto gate = [&](double distance) {
        return static_cast<std::int16_t>(std::clamp(distance * double(kUnit), 1.0, 1200.0));
    };
    const std::int16_t gateX = gate(within[0]), gateY = gate(within[1]);
    std::vector<std::uint8_t> agreement(columns * static_cast<std::size_t>(height), 0);
    parallelFor(height, [&](int j) {
        const std::size_t here = static_cast<std::size_t>(j + kReach) * stride + kReach;
        Agreement with(columns);
        countAgreeing({px.data() + here, py.data() + here, std::ptrdiff_t(stride), kNowhere}, width, gateX, gateY,
                      with);
        const std::size_t row = static_cast<std::size_t>(j) * columns;
        for (std::size_t i = 0; i < columns; ++i) {
            if (places.state[row + i] != kDecoded) continue;
            const int agree = with.agree[i], known = with.known[i];
            if (agree < 5 || 5 * agree < 2 * known) {
                places.state[row + i] = kInconsistent;
                continue;
            }
            const float scale = 1.0F / (kUnit * static_cast<float>(agree));
            places.at[2 * (row + i)] += scale * static_cast<float>(with.sumX[i]);
            places.at[2 * (row + i) + 1] += scale * static_cast<float>(with.sumY[i]);
            agreement[row + i] = static_cast<std::uint8_t>(255 * agree / known);
        }
    });
    return agreement;
}

void withoutIslands(Places& places) {
    constexpr int kCell = 8;
    const int width = places.camera.width, height = places.camera.height;
    const int across = (width + kCell - 1) / kCell, down = (height + kCell - 1) / kCell;
    std::vector<int> decoded(static_cast<std::size_t>(across) * static_cast<std::size_t>(down), 0);
    const auto eachPixel = [&](int row, int column, const auto& visit) {
        for (int y = kCell * row; y < std::min(height, kCell * (row + 1)); ++y) {
            for (int x = kCell * column; x < std::min(width, kCell * (column + 1)); ++x)
                visit(static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x));
        }
    };
    const auto cell = [&](int row, int column) {
        return static_cast<std::size_t>(row) * static_cast<std::size_t>(across) + static_cast<std::size_t>(column);
    };
    parallelFor(down, [&](int row) {
        for (int column = 0; column < across; ++column)
            eachPixel(row, column,
                      [&](std::size_t n) { decoded[cell(row, column)] += places.state[n] == kDecoded ? 1 : 0; });
    });
    parallelFor(down, [&](int row) {
        for (int column = 0; column < across; ++column) {
            if (decoded[cell(row, column)] == 0) continue;
            int around = 0, pixels = 0;
            for (int v = std::max(0, row - 1); v <= std::min(down - 1, row + 1); ++v) {
                for (int u = std::max(0, column - 1); u <= std::min(across - 1, column + 1); ++u) {
                    around += decoded[cell(v, u)];
                    pixels += (std::min(width, kCell * (u + 1)) - kCell * u) *
                              (std::min(height, kCell * (v + 1)) - kCell * v);
                }
            }
            if (8 * around >= pixels) continue;
            eachPixel(row, column, [&](std::size_t n) {
                if (places.state[n] == kDecoded) places.state[n] = kInconsistent;
            });
        }
    });
}

}  // namespace ilf
