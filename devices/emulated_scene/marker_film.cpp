#include "devices/emulated_scene/marker_film.h"

#include <algorithm>

#include "devices/emulated_scene/emulated_camera.h"

namespace ilf::devices {
namespace {

constexpr Size kRaster{1024, 768};
/// White of the brightest tenth comes out at this share of the sensor's range.
constexpr double kBright = 0.75;

}  // namespace

Result<std::unique_ptr<MarkerFilm>> MarkerFilm::of(const SceneWish& wish, Second exposure) {
    if (wish.marker < 0)
        return fail(Fault::outOfRange, "There is nothing to follow in the emulated scene: ask for marker=0 to 9.");
    auto stage = wishedStage(wish, kRaster);
    if (!stage) return tl::unexpected(stage.error());
    return std::unique_ptr<MarkerFilm>(new MarkerFilm(*std::move(stage), wish, exposure));
}

MarkerFilm::MarkerFilm(scene::Stage stage, const SceneWish& wish, Second exposure)
    : transport_(std::move(stage)), path_(markerPathOf(wish)), ambientLux_(wish.ambientLux),
      light_(static_cast<std::size_t>(kRaster.width) * static_cast<std::size_t>(kRaster.height), 1.0F) {
    sensor_.exposure = exposure;
    sensor_.noisy = !wish.quiet;
    sensor_.seed = static_cast<std::uint64_t>(wish.seed) * 1000003U;
    transport_.shine(light_, ambientLux_, lux_);
    auto sorted = lux_;
    const auto tenth = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() * 9 / 10);
    std::nth_element(sorted.begin(), tenth, sorted.end());
    const double electrons = sensor_.perLuxSecond * exposure.si() * std::max(1e-3, static_cast<double>(*tenth));
    sensor_.gain = kBright * sensor_.fullWell / electrons;
}

Frame MarkerFilm::at(Second time, std::uint64_t number) const {
    std::vector<float> lux = lux_;
    std::vector<std::uint8_t> tint = transport_.tint();
    const double half_s = 0.5 * sensor_.exposure.si();
    putMarker(transport_.stage(), path_, time.si() - half_s, time.si() + half_s, light_, ambientLux_, lux, tint);
    scene::SensorSettings sensor = sensor_;
    sensor.seed += number;
    return {exposed(transport_.stage().camera.size, lux, tint, sensor), time, number, 0.0};
}

std::array<Point<CameraFrame>, 4> MarkerFilm::truth(Second time) const {
    std::array<Point<CameraFrame>, 4> corners;
    const auto at = markerCorners(transport_.stage(), path_, time.si());
    for (std::size_t k = 0; k < 4; ++k)
        corners[k] = {at[k][0], at[k][1]};
    return corners;
}

}  // namespace ilf::devices
