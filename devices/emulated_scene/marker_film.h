// Pictures of the emulated scene with its moving marker at any time, without devices and without waiting.
#pragma once

#include <memory>
#include <vector>

#include "devices/camera/frame.h"
#include "devices/emulated_scene/light_transport.h"
#include "devices/emulated_scene/moving_marker.h"
#include "devices/emulated_scene/scene_wish.h"
#include "devices/emulated_scene/sensor.h"

namespace ilf::devices {

/// The projector shows steady white. Of a wish: scene, binning, roi, ambient, marker, lap, cover, hand, quiet and seed.
class MarkerFilm {
public:
    /// Seconds of rays. Refused: a wish without a marker, or one whose scene is.
    static Result<std::unique_ptr<MarkerFilm>> of(const SceneWish& wish, Second exposure = 8.0_ms);

    /// Exposed about `time`, which is the frame's, too. `number`: from 1, of the noise.
    Frame at(Second time, std::uint64_t number) const;
    /// Corners of the marker's black square, clockwise from its upper left.
    std::array<Point<CameraFrame>, 4> truth(Second time) const;

private:
    MarkerFilm(scene::Stage stage, const SceneWish& wish, Second exposure);

    scene::LightTransport transport_;
    scene::MarkerPath path_;
    scene::SensorSettings sensor_;
    double ambientLux_;
    std::vector<float> light_, lux_;  ///< of the projector, and what comes to the sensor without the marker
};

}  // namespace ilf::devices
