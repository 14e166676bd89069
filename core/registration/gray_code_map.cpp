#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <opencv2/calib3d.hpp>
#include <optional>
#include <string>
#include <utility>

#include "core/base/parallel.h"
#include "core/registration/gray_code.h"
#include "core/registration/hole_filling.h"

namespace ilf {

namespace {

using Plane = Homography<ProjectorFrame, CameraFrame>;

/// The plane that most of a sample of decoded pixels lie on, then what fits those best. Both frames have their
/// pixels' centres at + 0.5.
std::optional<Plane> bestPlane(const DecodedScan& decoded) {
    const int step = std::max(1, std::min(decoded.state.width(), decoded.state.height()) / 64);
    std::vector<cv::Point2d> from, to;
    for (int j = step / 2; j < decoded.state.height(); j += step) {
        for (int i = step / 2; i < decoded.state.width(); i += step) {
            if (decoded.confidence.at(i, j) == 0) continue;
            from.emplace_back(i + 0.5, j + 0.5);
            to.emplace_back(decoded.projectorOfCamera.at(i, j, 0), decoded.projectorOfCamera.at(i, j, 1));
        }
    }
    if (from.size() < 8) return std::nullopt;
    constexpr double kOnPlane_px = 3.0;
    try {
        const cv::Mat found = cv::findHomography(from, to, cv::RANSAC, kOnPlane_px, cv::noArray(), 1000);
        if (found.empty() || std::abs(found.at<double>(2, 2)) < 1e-12) return std::nullopt;
        Plane plane;
        for (int k = 0; k < 9; ++k)
            plane.m[static_cast<std::size_t>(k)] = found.at<double>(k / 3, k % 3) / found.at<double>(2, 2);
        if (!(std::abs(plane.determinant()) > 1e-12)) return std::nullopt;
        return plane;
    } catch (const cv::Exception&) {
        return std::nullopt;
    }
}

/// Where values leave the plane, which is what continues smoothly; known: those that were decoded.
Field departures(const DecodedScan& decoded, const Plane& plane) {
    const Size size = decoded.state.size();
    const auto columns = static_cast<std::size_t>(size.width);
    const std::size_t pixels = columns * static_cast<std::size_t>(size.height);
    Field field{size, std::vector<float>(2 * pixels, 0.0F), std::vector<float>(pixels, 0.0F)};
    parallelFor(size.height, [&](int j) {
        for (int i = 0; i < size.width; ++i) {
            if (decoded.confidence.at(i, j) == 0) continue;
            const std::size_t n = static_cast<std::size_t>(j) * columns + static_cast<std::size_t>(i);
            const auto p = plane({i + 0.5, j + 0.5});
            field.values[2 * n] = static_cast<float>(double(decoded.projectorOfCamera.at(i, j, 0)) - p.x);
            field.values[2 * n + 1] = static_cast<float>(double(decoded.projectorOfCamera.at(i, j, 1)) - p.y);
            field.known[n] = 1.0F;
        }
    });
    return field;
}

template <class To, class From>
Image<float> withPlane(Field field, const Homography<To, From>& plane) {
    const auto columns = static_cast<std::size_t>(field.size.width);
    parallelFor(field.size.height, [&](int j) {
        for (int i = 0; i < field.size.width; ++i) {
            const std::size_t n = static_cast<std::size_t>(j) * columns + static_cast<std::size_t>(i);
            const auto p = plane(Point<From>{i + 0.5, j + 0.5});
            field.values[2 * n] += static_cast<float>(p.x);
            field.values[2 * n + 1] += static_cast<float>(p.y);
        }
    });
    return {field.size, 2, std::move(field.values)};
}

struct Corner {
    float x, y;  ///< on the raster
    float i, j;  ///< in the picture
};

/// Writes the camera's place of each raster pixel whose centre lies in the triangle, rows y0 <= y < y1 only. Where
/// light is seen twice, in a mirror or on something glossy, the surer place stays.
void fillTriangle(const std::array<Corner, 3>& t, float weight, int y0, int y1, Field& out) {
    const float det = (t[1].x - t[0].x) * (t[2].y - t[0].y) - (t[2].x - t[0].x) * (t[1].y - t[0].y);
    if (det == 0.0F) return;
    const auto [left, right] = std::minmax({t[0].x, t[1].x, t[2].x});
    const auto [top, bottom] = std::minmax({t[0].y, t[1].y, t[2].y});
    const int x0 = std::max(0, static_cast<int>(std::ceil(left - 0.5F)));
    const int x1 = std::min(out.size.width - 1, static_cast<int>(std::floor(right - 0.5F)));
    const int first = std::max(y0, static_cast<int>(std::ceil(top - 0.5F)));
    const int last = std::min(y1 - 1, static_cast<int>(std::floor(bottom - 0.5F)));
    for (int y = first; y <= last; ++y) {
        for (int x = x0; x <= x1; ++x) {
            const float px = static_cast<float>(x) + 0.5F - t[0].x, py = static_cast<float>(y) + 0.5F - t[0].y;
            const float a = (px * (t[2].y - t[0].y) - py * (t[2].x - t[0].x)) / det;
            const float b = (py * (t[1].x - t[0].x) - px * (t[1].y - t[0].y)) / det;
            constexpr float kSeam = -1e-3F;  // neighbours share their edge, rounding must not open it
            if (a < kSeam || b < kSeam || a + b > 1.0F - kSeam) continue;
            const std::size_t n =
                static_cast<std::size_t>(y) * static_cast<std::size_t>(out.size.width) + static_cast<std::size_t>(x);
            if (weight <= out.known[n]) continue;
            out.values[2 * n] = t[0].i + a * (t[1].i - t[0].i) + b * (t[2].i - t[0].i);
            out.values[2 * n + 1] = t[0].j + a * (t[1].j - t[0].j) + b * (t[2].j - t[0].j);
            out.known[n] = weight;
        }
    }
}

/// The map turned round: squares of four decoded neighbours, laid onto the raster. A square whose corners leave the
/// plane by more than 3 raster pixels differently spans a step in depth, where the camera does not see the light
/// between.
Field turnedRound(const DecodedScan& decoded, const Field& departures) {
    const Size raster = decoded.projector;
    const auto pixels = static_cast<std::size_t>(raster.width) * static_cast<std::size_t>(raster.height);
    Field out{raster, std::vector<float>(2 * pixels, 0.0F), std::vector<float>(pixels, 0.0F)};
    const int width = decoded.state.width(), height = decoded.state.height();
    constexpr float kStep_px = 3.0F;
    constexpr int kBands = 4;  // of the raster: bands do not touch each other's pixels
    parallelFor(kBands, [&](int band) {
        const int y0 = raster.height * band / kBands, y1 = raster.height * (band + 1) / kBands;
        for (int j = 0; j + 1 < height; ++j) {
            const float *upper = decoded.projectorOfCamera.row(j), *lower = decoded.projectorOfCamera.row(j + 1);
            for (int i = 0; i + 1 < width; ++i) {
                const std::size_t n =
                    static_cast<std::size_t>(j) * static_cast<std::size_t>(width) + static_cast<std::size_t>(i);
                const std::array<std::size_t, 4> at{n, n + 1, n + static_cast<std::size_t>(width) + 1,
                                                    n + static_cast<std::size_t>(width)};
                if (departures.known[at[0]] + departures.known[at[1]] + departures.known[at[2]] +
                        departures.known[at[3]] <
                    4.0F)
                    continue;
                const float x = static_cast<float>(i) + 0.5F, y = static_cast<float>(j) + 0.5F;
                const std::array<Corner, 4> c{{{upper[2 * i], upper[2 * i + 1], x, y},
                                               {upper[2 * i + 2], upper[2 * i + 3], x + 1.0F, y},
                                               {lower[2 * i + 2], lower[2 * i + 3], x + 1.0F, y + 1.0F},
                                               {lower[2 * i], lower[2 * i + 1], x, y + 1.0F}}};
                const auto [top, bottom] = std::minmax({c[0].y, c[1].y, c[2].y, c[3].y});
                if (bottom < static_cast<float>(y0) || top > static_cast<float>(y1)) continue;
                bool whole = true;
                for (std::size_t k = 0; k < 4; ++k) {
                    const std::size_t a = at[k], b = at[(k + 1) % 4];
                    whole = whole && std::abs(departures.values[2 * a] - departures.values[2 * b]) < kStep_px &&
                            std::abs(departures.values[2 * a + 1] - departures.values[2 * b + 1]) < kStep_px;
                }
                if (!whole) continue;
                const auto& sure = decoded.confidence;
                const float weight = static_cast<float>(
                    std::min({sure.at(i, j), sure.at(i + 1, j), sure.at(i, j + 1), sure.at(i + 1, j + 1)}));
                fillTriangle({c[0], c[1], c[2]}, weight, y0, y1, out);
                fillTriangle({c[0], c[2], c[3]}, weight, y0, y1, out);
            }
        }
    });
    return out;
}

/// Raster pixels that the camera sees: those the map reaches, and pinholes among them, where most of the 7 x 7 around
/// are seen: a few pixels that were too dark or noisy to decode hide nothing.
std::vector<std::uint8_t> seenPixels(const Field& raster) {
    constexpr int kReach = 3, kMost = 25;
    const int width = raster.size.width, height = raster.size.height;
    std::vector<std::uint8_t> seen(raster.known.size());
    parallelFor(height, [&](int y) {
        const std::size_t row = static_cast<std::size_t>(y) * static_cast<std::size_t>(width);
        for (int x = 0; x < width; ++x) {
            int around = 0;
            const bool here = raster.known[row + static_cast<std::size_t>(x)] > 0.0F;
            for (int v = std::max(0, y - kReach); !here && v <= std::min(height - 1, y + kReach); ++v) {
                for (int u = std::max(0, x - kReach); u <= std::min(width - 1, x + kReach); ++u)
                    around += raster.known[static_cast<std::size_t>(v) * static_cast<std::size_t>(width) +
                                           static_cast<std::size_t>(u)] > 0.0F;
            }
            seen[row + static_cast<std::size_t>(x)] = here || around >= kMost ? 255 : 0;
        }
    });
    return seen;
}

}  // namespace

Result<DenseMap> denseMap(const DecodedScan& decoded) {
    constexpr int kLeast = 1000;
    const int count = decoded.count[static_cast<std::size_t>(PixelState::decoded)];
    if (count < kLeast) {
        return fail(Fault::outOfRange, "Only " + std::to_string(count) +
                                           " pixels of the scan were decoded; a map needs " + std::to_string(kLeast) +
                                           ". Bring more light or a longer exposure, and see that the camera looks "
                                           "where the projector shines.");
    }
    const auto plane = bestPlane(decoded);
    if (!plane) {
        return fail(Fault::outOfRange,
                    "The decoded pixels of the scan lie on one line or on no surface at all: let the "
                    "projector's light fill more of the camera's picture.");
    }
    Field camera = departures(decoded, *plane);
    Field raster = turnedRound(decoded, camera);
    std::vector<std::uint8_t> seen = seenPixels(raster);
    const Homography<CameraFrame, ProjectorFrame> back = plane->inverted();
    parallelFor(raster.size.height, [&](int y) {
        for (int x = 0; x < raster.size.width; ++x) {
            const std::size_t n =
                static_cast<std::size_t>(y) * static_cast<std::size_t>(raster.size.width) + static_cast<std::size_t>(x);
            if (raster.known[n] == 0.0F) continue;
            raster.known[n] = 1.0F;
            const auto p = back({x + 0.5, y + 0.5});
            raster.values[2 * n] -= static_cast<float>(p.x);
            raster.values[2 * n + 1] -= static_cast<float>(p.y);
        }
    });
    fillHoles(camera);
    fillHoles(raster);
    const Size rasterSize = raster.size;
    return DenseMap{withPlane(std::move(camera), *plane),
                    decoded.confidence,
                    withPlane(std::move(raster), back),
                    {rasterSize, 1, std::move(seen)},
                    *plane};
}

}  // namespace ilf
