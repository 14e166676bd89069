// Dense maps made up for tests: what a scan of a plane, or of something bent, would give.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "core/registration/registration.h"

namespace ilf {

/// The homography's values at every pixel, all seen where they fall into the picture; `bend` shifts both directions by
/// smooth waves of that many pixels (they stay each other's inverse only roughly).
inline DenseMap sampledMap(const Homography<ProjectorFrame, CameraFrame>& plane, Size camera, Size projector,
                           double bend = 0.0) {
    const auto area = [](Size s) { return static_cast<std::size_t>(s.width) * static_cast<std::size_t>(s.height); };
    const auto wave = [&](double x, double y) { return bend * std::sin(x / 31.0) * std::cos(y / 23.0); };
    const auto back = plane.inverted();
    std::vector<float> forth, home;
    std::vector<std::uint8_t> sure(area(camera), 255), seen;
    forth.reserve(2 * area(camera));
    home.reserve(2 * area(projector));
    for (int y = 0; y < camera.height; ++y) {
        for (int x = 0; x < camera.width; ++x) {
            const auto p = plane(Point<CameraFrame>{x + 0.5, y + 0.5});
            forth.push_back(static_cast<float>(p.x + wave(x, y)));
            forth.push_back(static_cast<float>(p.y + wave(y, x)));
        }
    }
    for (int y = 0; y < projector.height; ++y) {
        for (int x = 0; x < projector.width; ++x) {
            const auto c = back(Point<ProjectorFrame>{x + 0.5, y + 0.5});
            home.push_back(static_cast<float>(c.x - wave(c.x, c.y)));
            home.push_back(static_cast<float>(c.y - wave(c.y, c.x)));
            const bool in = c.x >= 0.0 && c.y >= 0.0 && c.x < camera.width && c.y < camera.height;
            seen.push_back(in ? 255 : 0);
        }
    }
    return {Image<float>(camera, 2, std::move(forth)), Image<std::uint8_t>(camera, 1, std::move(sure)),
            Image<float>(projector, 2, std::move(home)), Image<std::uint8_t>(projector, 1, std::move(seen)), plane};
}

inline Box<Registration> registered(const Box<DenseMap>& map) {
    Registration registration;
    registration.map = PixelMap(map);
    registration.method = Registration::Method::scan;
    registration.projector = map->projector();
    registration.camera.picture = map->camera();
    registration.provenance = "simulated";
    return Box<Registration>(std::move(registration));
}

/// The same map where `unseen` pixels of the raster are not seen.
inline DenseMap withoutSeeing(DenseMap map, PixelRect<ProjectorFrame> unseen) {
    std::vector<std::uint8_t> seen(map.seen.pixels().begin(), map.seen.pixels().end());
    for (int y = unseen.y0; y < unseen.y1; ++y)
        for (int x = unseen.x0; x < unseen.x1; ++x)
            seen[static_cast<std::size_t>(y) * static_cast<std::size_t>(map.projector().width) +
                 static_cast<std::size_t>(x)] = 0;
    map.seen = Image<std::uint8_t>(map.projector(), 1, std::move(seen));
    return map;
}

}  // namespace ilf
