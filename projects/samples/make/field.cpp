#include "field.h"

namespace ilf::samples {
namespace {

constexpr int kCells = 56;  // along each axis of the bounds: a few centimetres in a room of two metres

// Distances of ellipsoids and displaced surfaces are estimates: keep candidates that this much error could promote.
constexpr float kDoubt = 1.6f;

}  // namespace

Field::Field(const Scene& scene)
    : scene_(scene), cell_((scene.boundsHigh - scene.boundsLow) / float(kCells)),
      candidates_(std::size_t(kCells) * kCells * kCells) {
    const float half = 0.5f * length(cell_);
    std::vector<float> distances(scene.objects.size());
    for (int z = 0; z < kCells; ++z)
        for (int y = 0; y < kCells; ++y)
            for (int x = 0; x < kCells; ++x) {
                const V3 centre = scene.boundsLow + V3{float(x) + 0.5f, float(y) + 0.5f, float(z) + 0.5f} * cell_;
                for (std::size_t i = 0; i < distances.size(); ++i)
                    distances[i] = scene.objects[i].distance(centre);
                const float least = *std::min_element(distances.begin(), distances.end());
                for (std::size_t i = 0; i < distances.size(); ++i)
                    if (distances[i] <= least + 2.0f * half * kDoubt)
                        candidates_[cellOf(centre)].push_back(std::uint16_t(i));
            }
}

std::size_t Field::cellOf(V3 p) const {
    const V3 d = p - scene_.boundsLow;
    const auto along = [](float value, float cell) {
        return std::size_t(std::clamp(int(value / cell), 0, kCells - 1));
    };
    return (along(d.z, cell_.z) * kCells + along(d.y, cell_.y)) * kCells + along(d.x, cell_.x);
}

Field::Nearest Field::nearest(V3 p) const {
    Nearest found;
    for (const std::uint16_t i : candidates_[cellOf(p)])
        if (const float d = scene_.objects[i].distance(p); d < found.distance) found = {d, int(i)};
    return found;
}

bool Field::inside(V3 p) const {
    const V3 a = p - scene_.boundsLow, b = scene_.boundsHigh - p;
    return std::min({a.x, a.y, a.z, b.x, b.y, b.z}) > 0.0f;
}

V3 Field::normal(V3 p, float reach) const {
    // Four points of a tetrahedron give the same gradient as six on the axes.
    const V3 a{1, -1, -1}, b{-1, -1, 1}, c{-1, 1, -1}, d{1, 1, 1};
    return normalized(a * distance(p + a * reach) + b * distance(p + b * reach) + c * distance(p + c * reach) +
                      d * distance(p + d * reach));
}

}  // namespace ilf::samples
