#include "core/registration/pixel_map.h"

#include <algorithm>
#include <cassert>
#include <utility>

namespace ilf {

namespace {

/// Bilinear between the centres of a two-channel picture's pixels; `at` is clamped to the outermost centres.
std::pair<double, double> between(const Image<float>& map, double x, double y) {
    const double u = std::clamp(x - 0.5, 0.0, map.width() - 1.0), v = std::clamp(y - 0.5, 0.0, map.height() - 1.0);
    const int i = std::min(static_cast<int>(u), std::max(0, map.width() - 2));
    const int j = std::min(static_cast<int>(v), std::max(0, map.height() - 2));
    const double a = u - i, b = v - j;
    const int right = std::min(i + 1, map.width() - 1), below = std::min(j + 1, map.height() - 1);
    const float *top = map.row(j), *bottom = map.row(below);
    const auto value = [&](int channel) {
        const auto p = [&](const float* row, int column) { return static_cast<double>(row[2 * column + channel]); };
        return (p(top, i) * (1.0 - a) + p(top, right) * a) * (1.0 - b) +
               (p(bottom, i) * (1.0 - a) + p(bottom, right) * a) * b;
    };
    return {value(0), value(1)};
}

/// The map inside its picture; outside, the plane's way from the nearest point of the picture on.
template <class To, class From>
Point<To> through(const Image<float>& map, const Homography<To, From>& plane, Point<From> at) {
    const Point<From> edge{std::clamp(at.x, 0.5, map.width() - 0.5), std::clamp(at.y, 0.5, map.height() - 0.5)};
    const auto [x, y] = between(map, edge.x, edge.y);
    if (edge == at) return {x, y};
    const Point<To> there = plane(at), here = plane(edge);
    return {x + there.x - here.x, y + there.y - here.y};
}

}  // namespace

PixelMap::PixelMap(const Homography<ProjectorFrame, CameraFrame>& plane) : plane_(plane), back_(plane.inverted()) {}

PixelMap::PixelMap(Box<DenseMap> dense)
    : plane_(dense->nearest), back_(dense->nearest.inverted()), dense_(std::move(dense)) {
    assert(dense_->projectorOfCamera.channels() == 2 && dense_->cameraOfProjector.channels() == 2);
    assert(dense_->confidence.size() == dense_->camera() && dense_->seen.size() == dense_->projector());
}

const Homography<ProjectorFrame, CameraFrame>* PixelMap::plane() const { return dense_ ? nullptr : &plane_; }

Point<ProjectorFrame> PixelMap::toProjector(Point<CameraFrame> at) const {
    return dense_ ? through(dense_->projectorOfCamera, plane_, at) : plane_(at);
}

Point<CameraFrame> PixelMap::toCamera(Point<ProjectorFrame> at) const {
    return dense_ ? through(dense_->cameraOfProjector, back_, at) : back_(at);
}

bool PixelMap::seen(int x, int y) const { return !dense_ || dense_->seen.at(x, y) != 0; }

}  // namespace ilf
