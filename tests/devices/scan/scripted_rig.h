// A show and a camera on a clock that only frames move, looking at the emulated scene, with faults by script.
#pragma once

#include <algorithm>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <random>
#include <utility>
#include <vector>

#include "devices/emulated_scene/emulated_camera.h"
#include "devices/scan/captured_scan.h"

namespace ilf::test {

using namespace ilf::devices;

/// What happens, counted in frames since the start; what was done besides.
struct Script {
    static constexpr int kNever = 1 << 30;
    int delay = 0, delayFrom = 0;  ///< every frame is an older one, from this frame on
    int frozenFrom = kNever;       ///< the same picture from then on
    int movedFrom = kNever;        ///< the camera was bumped by 6 mm
    int wrongScreenFrom = kNever;  ///< light of another picture
    int lostFrom = kNever;         ///< the camera is unplugged
    Second period = 0.05_s;        ///< between frames
    int slowShowFrom = kNever;     ///< from this picture on showing returns a tenth of a second after first light
    int repeatEvery = 0;           ///< each so-manieth frame is the one before again; 0: none
    double ambientLux = 10.0, aperture = 1.0;
    double grain = 0.0;  ///< one sigma of noise beside the sensor's own, codes: gain turned up in the dark
    bool setsExposure = true;
    std::function<void(int)> onFrame = {};  ///< told each frame's number

    int frames = 0, shown = 0, safeLights = 0;
    bool safe = true, locked = false;
    Second exposure = 0.033_s;
};

/// A desk seen with 160 x 128 pixels, lit by a projector of 64 x 48.
class ScriptedScene {
public:
    static constexpr Size kRaster{64, 48};

    explicit ScriptedScene(Script& script) : script_(script), light_(full(1.0F)), before_(light_) {}

    Second show(const Image<std::uint8_t>& picture) {
        now_ += 0.013_s;  // it takes effect some time later
        before_ = light_;
        light_.clear();
        for (const std::uint8_t value : picture.pixels())
            light_.push_back(static_cast<float>(value) / 255.0F);
        changedAt_ = now_;
        if (script_.shown > script_.slowShowFrom) now_ += 0.1_s;
        return changedAt_;
    }
    Frame frame() {
        now_ += script_.period;
        const int number = script_.frames++;
        if (script_.onFrame) script_.onFrame(number);
        // What was there for a part of the exposure shows for that part.
        const double newer = std::clamp((now_ - changedAt_) / script_.exposure, 0.0, 1.0);
        std::vector<float> light = number >= script_.wrongScreenFrom ? full(0.6F) : light_;
        if (number < script_.wrongScreenFrom) {
            for (std::size_t i = 0; i < light.size(); ++i)
                light[i] = static_cast<float>(newer) * light_[i] + static_cast<float>(1.0 - newer) * before_[i];
        }
        const auto& transport = scene(number >= script_.movedFrom);
        transport.shine(light, script_.ambientLux, lux_);
        scene::SensorSettings sensor;
        sensor.exposure = script_.exposure;
        sensor.gain = script_.aperture;
        sensor.seed = static_cast<std::uint64_t>(number) + 1;
        Image<std::uint8_t> picture = scene::exposed(transport, lux_, sensor);
        if (script_.grain > 0.0) picture = grainy(picture, script_.grain, number);
        const bool again = script_.repeatEvery > 0 && number % script_.repeatEvery == 0;
        if ((number >= script_.frozenFrom || again) && !past_.empty()) picture = past_.back();
        past_.push_back(picture);
        const auto back = static_cast<std::size_t>(number >= script_.delayFrom ? script_.delay : 0);
        while (past_.size() > back + 1)
            past_.pop_front();
        return {past_.front(), now_, static_cast<std::uint64_t>(number) + 1, 0.0};
    }
    /// Worked out once for all tests.
    static const scene::LightTransport& scene(bool moved) {
        static const auto made = [](double bump) {
            SceneWish wish;
            wish.binning = 8;
            wish.bump_mm = bump;
            return std::make_unique<scene::LightTransport>(wishedStage(wish, kRaster).value());
        };
        static const auto still = made(0.0), bumped = made(6.0);
        return moved ? *bumped : *still;
    }

private:
    static Image<std::uint8_t> grainy(const Image<std::uint8_t>& picture, double sigma, int number) {
        std::mt19937 random(static_cast<std::uint32_t>(number) + 1);
        std::normal_distribution<double> noise(20.0, sigma);
        std::vector<std::uint8_t> codes;
        for (const std::uint8_t code : picture.pixels())
            codes.push_back(static_cast<std::uint8_t>(std::clamp(code + noise(random), 0.0, 255.0)));
        return Image<std::uint8_t>(picture.size(), picture.channels(), std::move(codes));
    }
    static std::vector<float> full(float value) {
        return std::vector<float>(static_cast<std::size_t>(kRaster.width) * kRaster.height, value);
    }
    Script& script_;
    std::vector<float> light_, before_, lux_;
    std::deque<Image<std::uint8_t>> past_;
    Second now_ = 100.0_s, changedAt_ = 0.0_s;
};

class ScriptedShow : public PatternShow {
public:
    ScriptedShow(Script& script, ScriptedScene& scene) : script_(script), scene_(scene) {}
    Result<Second> show(const Image<std::uint8_t>& picture) override {
        if (picture.size() != ScriptedScene::kRaster) return fail(Fault::outOfRange, "Another raster.");
        script_.safe = false;
        ++script_.shown;
        return scene_.show(picture);
    }
    void safe() noexcept override {
        script_.safe = true;
        ++script_.safeLights;
    }
    Size projector() const override { return ScriptedScene::kRaster; }
    Second sweep() const override { return Second::fromSi(1.0 / 60.0); }

private:
    Script& script_;
    ScriptedScene& scene_;
};

class ScriptedCamera : public CameraSource {
public:
    ScriptedCamera(Script& script, ScriptedScene& scene) : script_(script), scene_(scene) {}
    Result<std::optional<Frame>> read() override {
        if (script_.frames >= script_.lostFrom)
            return fail(Fault::device, "Scripted camera gives no pictures any more.");
        return scene_.frame();
    }
    Result<void> lockExposure(bool locked) override {
        script_.locked = locked;
        return {};
    }
    Result<Second> setExposure(Second exposure) override {
        if (!script_.setsExposure) return fail(Fault::unsupported, "No.");
        return script_.exposure = exposure;
    }
    std::string name() const override { return "Scripted camera"; }
    std::string id() const override { return "scripted"; }

private:
    Script& script_;
    ScriptedScene& scene_;
};

inline Result<CapturedScan> captured(Script& script, const ScanWish& wish = {}, const std::stop_token& stop = {}) {
    ScriptedScene scene(script);
    ScriptedShow show(script, scene);
    ScriptedCamera camera(script, scene);
    return capturedScan(camera, show, wish, {}, stop);
}

}  // namespace ilf::test
