// A printed marker that is moved through the emulated scene on a known path, for what follows markers to be held
// against.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "devices/emulated_scene/scene_view.h"

namespace ilf::devices::scene {

inline constexpr int kMarkers = 10;  ///< of AprilTag's family 36h11: 0 to 9
inline constexpr double kMarkerSide_m = 0.06;

/// A white card with the tag, held before everything else, facing whoever sits at the desk. It goes round on an ellipse
/// of 200 mm by 80 mm and turns to and fro by 15 degrees meanwhile. It casts no shadow.
struct MarkerPath {
    int id = 0;                                     ///< 0..kMarkers - 1
    double lap_s = 0.0;                             ///< once around; 0: it stays where it is at 0 s
    double coveredFrom_s = 0.0, coveredTo_s = 0.0;  ///< the card is blank meanwhile, as if a hand lay on the tag
    bool operator==(const MarkerPath&) const = default;
};

/// Corners of the black square in the camera's picture, clockwise from its upper left, at a time.
std::array<std::array<double, 2>, 4> markerCorners(const Stage& stage, const MarkerPath& path, double time_s);

/// Puts the card into what `LightTransport::shine` gave of the same light: `lux` and `tint`, pixel by pixel, as it is
/// seen while the exposure lasts, moving. `light`: the projector's raster.
void putMarker(const Stage& stage, const MarkerPath& path, double from_s, double to_s, const std::vector<float>& light,
               double ambientLux, std::vector<float>& lux, std::vector<std::uint8_t>& tint);

}  // namespace ilf::devices::scene
