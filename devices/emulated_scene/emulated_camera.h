// A camera that nobody has to own: it sees the emulated scene in the light that the devices' process shows now.
#pragma once

#include <deque>
#include <filesystem>
#include <memory>
#include <string>

#include "devices/camera/camera_source.h"
#include "devices/emulated_scene/light_transport.h"
#include "devices/emulated_scene/moving_marker.h"
#include "devices/emulated_scene/scene_wish.h"
#include "devices/emulated_scene/sensor.h"
#include "devices/emulated_scene/shown_light.h"

namespace ilf::devices {

/// "emulated" or "emulated:WORDS", see SceneWish.
bool isEmulatedCamera(const std::string& id);
/// At the usual runtime directory, or at another. Refused: words that are none, a scene's file that cannot be used.
Result<std::unique_ptr<CameraSource>> openEmulatedCamera(const std::string& id);
Result<std::unique_ptr<CameraSource>> openEmulatedCamera(const std::string& id,
                                                         const std::filesystem::path& runtimeDirectory);

/// The scene as wished for, with its camera cut out of its sensor, moved and reached into as it is wished. Refused
/// where its file is.
Result<scene::Stage> wishedStage(const SceneWish& wish, Size raster, bool faulty = true);
/// Of a wish that has a marker.
scene::MarkerPath markerPathOf(const SceneWish& wish);

/// Up to 20 frames a second, in real time. Nothing of it is measured: every name says "emulated".
class EmulatedCamera : public CameraSource {
public:
    EmulatedCamera(std::filesystem::path runtimeDirectory, SceneWish wish);

    Result<std::optional<Frame>> read() override;
    /// Where the light goes is worked out before the first frame, for seconds: that is given up.
    void endWhen(std::stop_token stop) override { stop_ = std::move(stop); }
    Result<void> lockExposure(bool locked) override;
    Result<Second> setExposure(Second exposure) override;
    CameraMode mode() const override;
    std::string name() const override { return "Emulated camera"; }
    std::string id() const override { return kEmulatedCameraId; }

    /// Of the newest frame: what it truly saw. nullptr before the first.
    const scene::LightTransport* truth() const { return transport_.get(); }

private:
    void lookForWishes();
    /// False: it was told to stop meanwhile.
    Result<bool> arrange(Size raster, bool faulty);
    void throughLens(std::vector<float>& light) const;
    void adapt(const Image<std::uint8_t>& picture);

    std::filesystem::path directory_;
    std::stop_token stop_;
    SceneWish wish_;
    std::filesystem::file_time_type wishedAt_{};
    ShownLightReader shown_;
    std::shared_ptr<const scene::LightTransport> transport_;
    SceneWish arranged_;  ///< what transport_ was made for
    scene::SensorSettings sensor_;
    double autoGain_ = 1.0;
    bool locked_ = false;
    std::deque<Image<std::uint8_t>> late_;  ///< pictures that wait for their turn
    std::vector<float> lux_;
    std::vector<std::uint8_t> tint_;  ///< of it, once a marker is in view
    std::optional<Second> began_;     ///< the marker's way
    std::uint64_t number_ = 0, sinceWish_ = 0;
    Second due_;
};

}  // namespace ilf::devices
