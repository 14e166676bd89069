#include "devices/emulated_scene/emulated_camera.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <mutex>
#include <thread>

#include "devices/emulated_scene/built_in.h"
#include "devices/emulated_scene/scene_file.h"
#include "devices/link/runtime_directory.h"

namespace ilf::devices {
namespace {

constexpr Second kPeriod = Second::fromSi(1.0 / 20.0);
constexpr Second kShortest = Second::fromSi(1e-4), kLongest = Second::fromSi(1.0);
/// A projector's black is not black.
constexpr float kLeak = 0.0015F;
/// Its lens softens a raster pixel's edges: share of each neighbour, a standard deviation of 0.45 pixels.
constexpr float kSoft = 0.1F;
/// More, and less, light than any exposure makes up for.
constexpr float kWideOpen = 150.0F, kNearlyClosed = 2e-4F;
/// What an automatic exposure aims at, as a mean code.
constexpr double kAim = 110.0;

/// Somebody's windows, which no pattern changes.
void putDesktop(std::vector<float>& light, Size raster) {
    for (int y = 0; y < raster.height; ++y) {
        for (int x = 0; x < raster.width; ++x) {
            const bool window = x > raster.width / 6 && x < raster.width / 2 && y > raster.height / 5;
            const bool line = window && (y / 9) % 2 == 0 && (x / 5 + y / 18) % 3 != 0;
            light[static_cast<std::size_t>(y) * static_cast<std::size_t>(raster.width) + static_cast<std::size_t>(x)] =
                line     ? 0.1F
                : window ? 0.95F
                         : 0.35F;
        }
    }
}

/// Of a wish, what changes where light goes.
SceneWish geometryOf(const SceneWish& wish, bool faulty) {
    SceneWish alone;
    alone.scene = wish.scene;
    alone.scale = wish.scale;
    alone.board = wish.board;
    alone.binning = wish.binning;
    alone.roiX = wish.roiX;
    alone.roiY = wish.roiY;
    alone.roi = wish.roi;
    if (faulty) {
        alone.bump_mm = wish.bump_mm;
        alone.turn_deg = wish.turn_deg;
        alone.hand = wish.hand;
    }
    return alone;
}

/// The way of the light that was worked out last: a page that lends its camera to a scan, and takes it back, need not
/// wait for the same rays three times. A scene's file may have changed since, so none of a file is kept.
class LastTransport {
public:
    std::shared_ptr<const scene::LightTransport> of(const SceneWish& wish, Size raster) {
        const std::lock_guard lock(mutex_);
        return made_ && wish == wish_ && made_->stage().projector.size == raster ? made_ : nullptr;
    }
    void keep(const SceneWish& wish, std::shared_ptr<const scene::LightTransport> made) {
        if (!wish.scene.empty()) return;
        const std::lock_guard lock(mutex_);
        wish_ = wish;
        made_ = std::move(made);
    }

private:
    std::mutex mutex_;
    SceneWish wish_;
    std::shared_ptr<const scene::LightTransport> made_;
};

LastTransport& lastTransport() {
    static LastTransport last;
    return last;
}

}  // namespace

bool isEmulatedCamera(const std::string& id) {
    return id == kEmulatedCameraId || id.starts_with(kEmulatedCameraId + ":");
}

Result<std::unique_ptr<CameraSource>> openEmulatedCamera(const std::string& id) {
    return openEmulatedCamera(id, runtimeDirectory());
}

Result<std::unique_ptr<CameraSource>> openEmulatedCamera(const std::string& id,
                                                         const std::filesystem::path& runtimeDirectory) {
    const auto wish = sceneWishFrom(std::string_view(id).substr(std::min(id.size(), kEmulatedCameraId.size() + 1)));
    if (!wish) return tl::unexpected(wish.error());
    if (!wish->scene.empty()) {
        if (const auto read = scene::sceneThings(wish->scene, wish->scale); !read) return tl::unexpected(read.error());
    }
    return std::make_unique<EmulatedCamera>(runtimeDirectory, *wish);
}

Result<scene::Stage> wishedStage(const SceneWish& wish, Size raster, bool faulty) {
    scene::Stage stage = scene::builtInStage(raster, wish.board);
    if (!wish.scene.empty() && wish.board == 0) {
        auto things = scene::sceneThings(wish.scene, wish.scale);
        if (!things) return tl::unexpected(things.error());
        stage.things = *std::move(things);
    }
    const Size part = wish.roi == Size{} ? stage.camera.size : wish.roi;
    stage.camera = scene::readOut(stage.camera, wish.roiX, wish.roiY, part, wish.binning);
    if (!faulty) return stage;
    stage.cameraAt = scene::nudged(stage.cameraAt, {1e-3 * wish.bump_mm, 0.0, 0.0}, wish.turn_deg, 0.0);
    if (wish.hand) scene::addHand(stage.things, {0.06, -0.04, 0.14});
    return stage;
}

scene::MarkerPath markerPathOf(const SceneWish& wish) {
    return {wish.marker, wish.lap_s, wish.coveredFrom_s, wish.coveredTo_s};
}

EmulatedCamera::EmulatedCamera(std::filesystem::path runtimeDirectory, SceneWish wish)
    : directory_(runtimeDirectory), wish_(wish), shown_(std::move(runtimeDirectory)) {
    if (wish_ == SceneWish{}) {
        lookForWishes();
    } else {  // words of its own count for more than a wish that was there before it
        std::error_code none;
        wishedAt_ = std::filesystem::last_write_time(sceneWishFile(directory_), none);
    }
}

void EmulatedCamera::lookForWishes() {
    std::error_code none;
    const auto written = std::filesystem::last_write_time(sceneWishFile(directory_), none);
    if (none || written == wishedAt_) return;
    wishedAt_ = written;
    const auto wish = savedSceneWish(directory_);
    if (!wish || !*wish || **wish == wish_) return;
    wish_ = **wish;
    sinceWish_ = 0;
}

Result<bool> EmulatedCamera::arrange(Size raster, bool faulty) {
    const SceneWish wanted = geometryOf(wish_, faulty);
    if (transport_ && arranged_ == wanted && transport_->stage().projector.size == raster) return true;
    auto transport = lastTransport().of(wanted, raster);
    if (!transport) {
        auto stage = wishedStage(wanted, raster, true);
        if (!stage) return tl::unexpected(stage.error());
        transport = std::make_shared<const scene::LightTransport>(*std::move(stage), stop_);
    }
    if (stop_.stop_requested()) return false;
    lastTransport().keep(wanted, transport);
    transport_ = std::move(transport);
    arranged_ = wanted;
    late_.clear();
    return true;
}

void EmulatedCamera::throughLens(std::vector<float>& light) const {
    const Size raster = transport_->stage().projector.size;
    const auto width = static_cast<std::size_t>(raster.width), height = static_cast<std::size_t>(raster.height);
    std::vector<float> across(light.size());
    for (std::size_t y = 0; y < height; ++y) {
        const float* row = light.data() + y * width;
        float* out = across.data() + y * width;
        for (std::size_t x = 1; x + 1 < width; ++x)
            out[x] = (1.0F - 2.0F * kSoft) * row[x] + kSoft * (row[x - 1] + row[x + 1]);
        out[0] = row[0];
        out[width - 1] = row[width - 1];
    }
    for (std::size_t y = 0; y < height; ++y) {
        const float* above = across.data() + (y == 0 ? y : y - 1) * width;
        const float* here = across.data() + y * width;
        const float* below = across.data() + (y + 1 == height ? y : y + 1) * width;
        for (std::size_t x = 0; x < width; ++x)
            light[y * width + x] =
                kLeak + (1.0F - kLeak) * ((1.0F - 2.0F * kSoft) * here[x] + kSoft * (above[x] + below[x]));
    }
}

void EmulatedCamera::adapt(const Image<std::uint8_t>& picture) {
    if (locked_) return;
    double sum = 0.0;
    const auto pixels = picture.pixels();
    std::size_t count = 0;
    for (std::size_t i = 1; i < pixels.size(); i += 3 * 61, ++count)
        sum += pixels[i];
    const double mean = std::max(2.0, sum / static_cast<double>(std::max<std::size_t>(1, count)));
    autoGain_ = std::clamp(autoGain_ * std::pow(kAim / mean, 0.7), 0.1, 8.0);
}

Result<std::optional<Frame>> EmulatedCamera::read() {
    Second now = steadyNow();
    if (number_ == 0) due_ = now;
    if (now < due_) std::this_thread::sleep_for(std::chrono::duration<double>((due_ - now).si()));
    lookForWishes();
    const bool faulty = std::cmp_greater_equal(sinceWish_++, wish_.after);
    ShownLight shown = shown_.during(sensor_.exposure);
    const Second till = steadyNow();  // no light that comes while the picture is worked out is in it
    const auto arranged = arrange(shown.raster, faulty);
    if (!arranged) return tl::unexpected(arranged.error());
    if (!*arranged) return std::nullopt;
    if (faulty && wish_.wrongScreen && shown.there) putDesktop(shown.light, shown.raster);
    if (shown.there) throughLens(shown.light);
    transport_->shine(shown.light, wish_.ambientLux, lux_);
    if (wish_.marker >= 0) {
        if (!began_) began_ = till;
        const double t = (till - *began_).si();
        tint_ = transport_->tint();
        putMarker(transport_->stage(), markerPathOf(wish_), t - sensor_.exposure.si(), t, shown.light, wish_.ambientLux,
                  lux_, tint_);
    }
    if (faulty && (wish_.saturated || wish_.dark)) {
        const float aperture = wish_.saturated ? kWideOpen : kNearlyClosed;
        for (float& lux : lux_)
            lux *= aperture;
    }
    scene::SensorSettings settings = sensor_;
    settings.seed = static_cast<std::uint64_t>(wish_.seed) * 1000003U + number_;
    settings.noisy = !wish_.quiet;
    settings.gain = autoGain_;
    const auto& tint = wish_.marker >= 0 ? tint_ : transport_->tint();
    Image<std::uint8_t> picture = exposed(transport_->stage().camera.size, lux_, tint, settings);
    adapt(picture);
    if (faulty && wish_.frozen && !late_.empty()) picture = late_.back();
    late_.push_back(picture);
    const auto kept = static_cast<std::size_t>(faulty ? wish_.delay : 0) + 1;
    while (late_.size() > kept)
        late_.pop_front();
    now = steadyNow();
    due_ = std::max(due_ + kPeriod, now);
    return Frame{late_.front(), till, ++number_, 0.0};
}

Result<void> EmulatedCamera::lockExposure(bool locked) {
    locked_ = locked;
    return {};
}

Result<Second> EmulatedCamera::setExposure(Second exposure) {
    if (!isFinite(exposure)) return fail(Fault::outOfRange, "An exposure is a number of milliseconds.");
    return sensor_.exposure = std::clamp(exposure, kShortest, kLongest);
}

CameraMode EmulatedCamera::mode() const {
    const Size sensor = scene::builtInCamera().size, part = wish_.roi == Size{} ? sensor : wish_.roi;
    return {id(),       sensor,        wish_.roiX,
            wish_.roiY, wish_.binning, {part.width / wish_.binning, part.height / wish_.binning}};
}

}  // namespace ilf::devices
