#include "core/solid/raster.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

#include "core/base/parallel.h"
#include "core/solid/draw.h"

namespace ilf {

namespace {

constexpr int kSub = 4096;             ///< steps in a pixel that vertices lie on
constexpr double kGuard_px = 16384.0;  ///< triangles are cut this far beyond the picture: all products fit 64 bits
constexpr int kRasterTile = 64;
constexpr int kChunks = 32;

/// A triangle on the raster's grid, inside positive, and its nearness as a plane over the picture.
struct Flat {
    std::array<std::int32_t, 3> x, y;
    double a, b, c;     ///< nearness = a * x + b * y + c, pixels
    float least, most;  ///< of the corners' nearness
    std::uint32_t triangle;
};

/// A convex polygon from cutting a triangle by up to five planes.
struct Polygon {
    std::array<glm::dvec3, 8> corners;
    std::size_t count = 0;
};

/// Keeps what has normal . p + offset >= 0. A cut edge gives the same point from either side: always worked out from
/// the end inside.
void cut(Polygon& polygon, const glm::dvec3& normal, double offset) {
    std::array<double, 8> side{};
    bool all = true;
    for (std::size_t i = 0; i < polygon.count; ++i) {
        side[i] = glm::dot(normal, polygon.corners[i]) + offset;
        all = all && side[i] >= 0.0;
    }
    if (all) return;
    Polygon kept;
    for (std::size_t i = 0; i < polygon.count; ++i) {
        const std::size_t j = (i + 1) % polygon.count;
        if (side[i] >= 0.0) kept.corners[kept.count++] = polygon.corners[i];
        if ((side[i] >= 0.0) == (side[j] >= 0.0)) continue;
        const std::size_t in = side[i] >= 0.0 ? i : j, out = side[i] >= 0.0 ? j : i;
        const double t = side[in] / (side[in] - side[out]);
        kept.corners[kept.count++] = polygon.corners[in] + t * (polygon.corners[out] - polygon.corners[in]);
    }
    polygon = kept;
}

/// Triangles of one share of the scene, and which of them touch each tile (`order` from first[tile] to first[tile +
/// 1]).
struct Chunk {
    std::vector<Flat> flats;
    std::vector<std::uint32_t> first, order;
};

class Setup {
public:
    Setup(const SeenTriangles& triangles, const Pinhole& camera)
        : triangles_(triangles), camera_(camera), size_(camera.size) {
        const double w = size_.width, h = size_.height;
        // Sides of the guard band as planes through the pinhole.
        sides_ = {
            glm::dvec3(camera.fx, 0.0, camera.cx + kGuard_px), glm::dvec3(-camera.fx, 0.0, w + kGuard_px - camera.cx),
            glm::dvec3(0.0, camera.fy, camera.cy + kGuard_px), glm::dvec3(0.0, -camera.fy, h + kGuard_px - camera.cy)};
    }

    Chunk chunk(std::size_t from, std::size_t to) const {
        Chunk chunk;
        if (from == to) return chunk;
        std::size_t mesh = triangles_.meshOf(from);
        for (std::size_t i = from; i < to; ++i) {
            while (i >= triangles_.firstTriangle[mesh + 1])
                ++mesh;
            add(chunk, triangles_.corners(i, mesh), static_cast<std::uint32_t>(i));
        }
        bin(chunk);
        return chunk;
    }

    int columns() const { return (size_.width + kRasterTile - 1) / kRasterTile; }
    int rows() const { return (size_.height + kRasterTile - 1) / kRasterTile; }

private:
    /// First pixel whose centre is at or after a place on the grid, and last whose centre is at or before it.
    static int firstCentre(std::int32_t at) { return (at + kSub / 2 - 1) >> 12; }
    static int lastCentre(std::int32_t at) { return (at - kSub / 2) >> 12; }

    void add(Chunk& chunk, const std::array<glm::dvec3, 3>& corners, std::uint32_t triangle) const {
        Polygon polygon{{corners[0], corners[1], corners[2]}, 3};
        cut(polygon, {0.0, 0.0, 1.0}, -kNearestDrawn_m);
        for (const glm::dvec3& side : sides_) {
            if (polygon.count < 3) return;
            cut(polygon, side, 0.0);
        }
        if (polygon.count < 3) return;

        const glm::dvec3 normal = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
        const double along = glm::dot(normal, corners[0]);
        if (along == 0.0 || !std::isfinite(along)) return;  // seen from its edge
        Flat flat{};
        flat.triangle = triangle;
        flat.a = normal.x / (along * camera_.fx);
        flat.b = normal.y / (along * camera_.fy);
        flat.c = normal.z / along - flat.a * camera_.cx - flat.b * camera_.cy;
        flat.least = std::numeric_limits<float>::max();
        std::array<std::int32_t, 8> x{}, y{};
        for (std::size_t i = 0; i < polygon.count; ++i) {
            const glm::dvec3& p = polygon.corners[i];
            x[i] = static_cast<std::int32_t>(std::lround((camera_.fx * p.x / p.z + camera_.cx) * kSub));
            y[i] = static_cast<std::int32_t>(std::lround((camera_.fy * p.y / p.z + camera_.cy) * kSub));
            const auto nearness = static_cast<float>(1.0 / p.z);
            flat.least = std::min(flat.least, nearness);
            flat.most = std::max(flat.most, nearness);
        }
        for (std::size_t i = 1; i + 1 < polygon.count; ++i) {
            flat.x = {x[0], x[i], x[i + 1]};
            flat.y = {y[0], y[i], y[i + 1]};
            const std::int64_t area = std::int64_t{flat.x[1] - flat.x[0]} * (flat.y[2] - flat.y[0]) -
                                      std::int64_t{flat.y[1] - flat.y[0]} * (flat.x[2] - flat.x[0]);
            if (area == 0) continue;
            if (area < 0) {
                std::swap(flat.x[1], flat.x[2]);
                std::swap(flat.y[1], flat.y[2]);
            }
            const PixelRect<CameraFrame> box = boxOf(flat);
            if (!box.empty()) chunk.flats.push_back(flat);
        }
    }

    PixelRect<CameraFrame> boxOf(const Flat& flat) const {
        const auto [left, right] = std::minmax({flat.x[0], flat.x[1], flat.x[2]});
        const auto [top, bottom] = std::minmax({flat.y[0], flat.y[1], flat.y[2]});
        return PixelRect<CameraFrame>{firstCentre(left), firstCentre(top), lastCentre(right) + 1,
                                      lastCentre(bottom) + 1}
            .clipped(size_);
    }

    /// A counting sort by tile, in the order of triangles.
    void bin(Chunk& chunk) const {
        const auto tiles = static_cast<std::size_t>(columns()) * static_cast<std::size_t>(rows());
        chunk.first.assign(tiles + 1, 0);
        const auto eachTile = [&](const Flat& flat, auto visit) {
            const PixelRect<CameraFrame> box = boxOf(flat);
            for (int row = box.y0 / kRasterTile; row <= (box.y1 - 1) / kRasterTile; ++row) {
                for (int column = box.x0 / kRasterTile; column <= (box.x1 - 1) / kRasterTile; ++column)
                    visit(static_cast<std::size_t>(row * columns() + column));
            }
        };
        for (const Flat& flat : chunk.flats)
            eachTile(flat, [&](std::size_t tile) { ++chunk.first[tile + 1]; });
        for (std::size_t i = 0; i < tiles; ++i)
            chunk.first[i + 1] += chunk.first[i];
        chunk.order.resize(chunk.first[tiles]);
        std::vector<std::uint32_t> next(chunk.first.begin(), chunk.first.end() - 1);
        for (std::size_t i = 0; i < chunk.flats.size(); ++i)
            eachTile(chunk.flats[i],
                     [&](std::size_t tile) { chunk.order[next[tile]++] = static_cast<std::uint32_t>(i); });
    }

    const SeenTriangles& triangles_;
    const Pinhole& camera_;
    Size size_;
    std::array<glm::dvec3, 4> sides_;
};

std::int64_t floorDivided(std::int64_t a, std::int64_t b) {  // b > 0
    const std::int64_t q = a / b;
    return a % b < 0 ? q - 1 : q;
}

/// An edge of a triangle as what it says of pixel centres of a row: inside where value + step * x >= 0.
struct Edge {
    std::int64_t dx, dy, x, y, bias;

    Edge(const Flat& flat, std::size_t i)
        : dx(std::int64_t{flat.x[(i + 1) % 3]} - flat.x[i]), dy(std::int64_t{flat.y[(i + 1) % 3]} - flat.y[i]),
          x(flat.x[i]), y(flat.y[i]),
          // What lies exactly on an edge belongs to the triangle whose upper or left edge it is: to one of two.
          bias(dy < 0 || (dy == 0 && dx > 0) ? 0 : -1) {}

    void narrow(int row, int& from, int& to) const {
        const std::int64_t centre = std::int64_t{row} * kSub + kSub / 2;
        const std::int64_t value = dx * (centre - y) - dy * (kSub / 2 - x) + bias, step = -dy * kSub;
        if (step > 0) {
            from = static_cast<int>(std::max<std::int64_t>(from, -floorDivided(value, step)));
        } else if (step < 0) {
            to = static_cast<int>(std::min<std::int64_t>(to, floorDivided(value, -step) + 1));
        } else if (value < 0) {
            to = from;
        }
    }
};

void fill(const Flat& flat, const PixelRect<CameraFrame>& within, Visible& seen) {
    const std::array<Edge, 3> edges{Edge(flat, 0), Edge(flat, 1), Edge(flat, 2)};
    const auto [top, bottom] = std::minmax({flat.y[0], flat.y[1], flat.y[2]});
    const int first = std::max(within.y0, (top + kSub / 2 - 1) >> 12);
    const int last = std::min(within.y1, ((bottom - kSub / 2) >> 12) + 1);
    for (int y = first; y < last; ++y) {
        int from = within.x0, to = within.x1;
        for (const Edge& edge : edges)
            edge.narrow(y, from, to);
        if (from >= to) continue;
        const std::size_t row = static_cast<std::size_t>(y) * static_cast<std::size_t>(seen.size.width);
        float* nearness = seen.nearness.data() + row;
        std::uint32_t* triangle = seen.triangle.data() + row;
        const double start = flat.b * (y + 0.5) + flat.c + 0.5 * flat.a;
        for (int x = from; x < to; ++x) {
            const float here = std::clamp(static_cast<float>(start + flat.a * x), flat.least, flat.most);
            if (here > nearness[x]) {
                nearness[x] = here;
                triangle[x] = flat.triangle;
            }
        }
    }
}

}  // namespace

std::size_t SeenTriangles::meshOf(std::size_t triangle) const {
    const auto after = std::upper_bound(firstTriangle.begin(), firstTriangle.end(), triangle);
    return static_cast<std::size_t>(after - firstTriangle.begin()) - 1;
}

std::array<glm::dvec3, 3> SeenTriangles::corners(std::size_t triangle, std::size_t mesh) const {
    const auto& indices = solid->meshes[mesh]->triangles[triangle - firstTriangle[mesh]];
    const glm::dvec3* own = vertices.data() + firstVertex[mesh];
    return {own[indices[0]], own[indices[1]], own[indices[2]]};
}

SeenTriangles seenTriangles(const Solid& solid, const Pose<CameraSpace, ModelSpace>& cameraFromModel) {
    SeenTriangles seen;
    seen.solid = &solid;
    seen.firstTriangle.push_back(0);
    for (const Box<Mesh>& mesh : solid.meshes) {
        seen.firstVertex.push_back(seen.vertices.size());
        for (const auto& p : mesh->positions) {
            const auto at = cameraFromModel({p[0], p[1], p[2]});
            seen.vertices.emplace_back(at.x, at.y, at.z);
        }
        seen.firstTriangle.push_back(seen.firstTriangle.back() + mesh->triangles.size());
    }
    return seen;
}

Visible visible(const SeenTriangles& triangles, const Pinhole& camera) {
    assert(camera.size.width > 0 && camera.size.width <= kLargestDrawn);
    assert(camera.size.height > 0 && camera.size.height <= kLargestDrawn);
    assert(camera.fx > 0.0 && camera.fy > 0.0);
    const Setup setup(triangles, camera);
    std::vector<Chunk> chunks(kChunks);
    const std::size_t count = triangles.count();
    parallelFor(kChunks, [&](int i) {
        const auto part = static_cast<std::size_t>(i);
        chunks[part] = setup.chunk(count * part / kChunks, count * (part + 1) / kChunks);
    });
    const auto pixels = static_cast<std::size_t>(camera.size.width) * static_cast<std::size_t>(camera.size.height);
    Visible seen{camera.size, std::vector<float>(pixels, 0.0F), std::vector<std::uint32_t>(pixels, kNoTriangle)};
    const int columns = setup.columns();
    parallelFor(columns * setup.rows(), [&](int tile) {
        const int x = tile % columns * kRasterTile, y = tile / columns * kRasterTile;
        const auto within = PixelRect<CameraFrame>{x, y, x + kRasterTile, y + kRasterTile}.clipped(camera.size);
        for (const Chunk& chunk : chunks) {
            if (chunk.first.empty()) continue;
            const std::uint32_t from = chunk.first[static_cast<std::size_t>(tile)],
                                to = chunk.first[static_cast<std::size_t>(tile) + 1];
            for (std::uint32_t i = from; i < to; ++i)
                fill(chunk.flats[chunk.order[i]], within, seen);
        }
    });
    return seen;
}

}  // namespace ilf
