#include <doctest/doctest.h>

#include <chrono>
#include <functional>
#include <mutex>

#include "core/base/srgb.h"
#include "devices/camera/camera.h"
#include "devices/camera/simulated_camera.h"

using namespace ilf;
using namespace ilf::devices;

namespace {

Frame frameOf(int value, Second time, std::uint64_t number = 1) {
    return {Image<std::uint8_t>({2, 1}, 3, std::vector<std::uint8_t>(6, static_cast<std::uint8_t>(value))), time,
            number, 0.0};
}

/// What a scripted camera does next.
struct Script {
    std::mutex mutex;
    bool opens = true, gives = true, repeats = false, breaks = false, locked = false;
    int value = 0, openings = 0;
};

class ScriptedCamera : public CameraSource {
public:
    explicit ScriptedCamera(Script& script) : script_(script) {}
    Result<std::optional<Frame>> read() override {
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
        const std::scoped_lock lock(script_.mutex);
        if (script_.breaks) return fail(Fault::device, "The cable is out.");
        if (!script_.gives) return std::nullopt;
        if (!script_.repeats) ++script_.value;
        return frameOf(script_.value % 256, steadyNow());
    }
    Result<void> lockExposure(bool locked) override {
        const std::scoped_lock lock(script_.mutex);
        script_.locked = locked;
        return {};
    }
    std::string name() const override { return "Scripted"; }
    std::string id() const override { return "scripted"; }

private:
    Script& script_;
};

Camera::Open opening(Script& script) {
    return [&script]() -> Result<std::unique_ptr<CameraSource>> {
        const std::scoped_lock lock(script.mutex);
        ++script.openings;
        if (!script.opens) return fail(Fault::notFound, "It is not plugged in.");
        return std::make_unique<ScriptedCamera>(script);
    };
}

void change(Script& script, const std::function<void(Script&)>& how) {
    const std::scoped_lock lock(script.mutex);
    how(script);
}

/// Waits up to ten seconds, as machines that are busy need, for what normally takes milliseconds.
bool soon(const std::function<bool()>& what) {
    for (int i = 0; i < 1000; ++i) {
        if (what()) return true;
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return false;
}

}  // namespace

TEST_CASE("camera: frozen is no new picture for a second, or the same picture for a second") {
    FreezeWatch watch(10.0_s);
    CHECK_FALSE(watch.frozen(10.9_s));
    CHECK(watch.frozen(11.0_s));  // opened, and nothing came
    watch.arrived(frameOf(1, 11.5_s));
    CHECK_FALSE(watch.frozen(12.4_s));
    for (double t = 11.6; t < 12.6; t += 0.1)
        watch.arrived(frameOf(1, Second::fromSi(t)));
    CHECK(watch.frozen(12.6_s));  // frames come, but always the same
    CHECK(watch.age(12.5_s).si() == doctest::Approx(1.0));
    watch.arrived(frameOf(2, 12.7_s));
    CHECK_FALSE(watch.frozen(13.6_s));
    CHECK(watch.frozen(13.8_s));
}

TEST_CASE("camera: frames arrive, a freeze is noticed and forgiven") {
    Script script;
    Camera camera(opening(script), [] {});
    REQUIRE(soon([&] { return camera.takeFrame().has_value(); }));
    CHECK(camera.state().open);
    CHECK(camera.state().name == "Scripted");
    CHECK_FALSE(camera.state().frozen);
    for (const bool repeats : {true, false}) {
        change(script, [&](Script& s) { (repeats ? s.repeats : s.gives) = repeats; });
        const Second began = steadyNow();
        REQUIRE(soon([&] { return camera.state().frozen; }));
        CHECK((steadyNow() - began).si() > 0.9);
        change(script, [](Script& s) { s.repeats = false, s.gives = true; });
        REQUIRE(soon([&] { return !camera.state().frozen; }));
    }
}

TEST_CASE("camera: what is lost is said, looked for again, and locked as it was") {
    Script script;
    script.opens = false;
    Camera camera(opening(script), [] {});
    REQUIRE(soon([&] { return camera.state().trouble == "It is not plugged in."; }));
    CHECK_FALSE(camera.state().open);
    change(script, [](Script& s) { s.opens = true; });
    REQUIRE(soon([&] { return camera.state().open; }));
    CHECK(camera.state().trouble.empty());
    camera.lockExposure(true);
    REQUIRE(soon([&] { return camera.state().locked; }));

    change(script, [](Script& s) { s.breaks = true, s.locked = false; });
    REQUIRE(soon([&] { return camera.state().trouble == "The cable is out."; }));
    change(script, [](Script& s) { s.breaks = false; });
    REQUIRE(soon([&] { return camera.state().open; }));
    REQUIRE(soon([&] {
        const std::scoped_lock lock(script.mutex);
        return script.locked;
    }));
}

TEST_CASE("camera: the simulated camera says that it is one, moves, and never repeats a picture") {
    SimulatedCamera source;
    CHECK(source.name() == "Simulated camera");
    FreezeWatch watch(0.0_s);
    const auto first = source.read(), second = source.read();
    REQUIRE(first);
    REQUIRE(second);
    CHECK((*first)->rgb.size() == Size{640, 480});
    CHECK_FALSE((*first)->rgb == (*second)->rgb);
    CHECK((*second)->number == 2);
    CHECK((*second)->time - (*first)->time > 0.02_s);
    // Locked, exposure stays; free, it follows the scene (here: a quarter of a 20 s swing, where noise cannot explain
    // it).
    CHECK(simulatedScene(5.0_s, 1, false).at(3, 300, 0) > simulatedScene(5.0_s, 1, true).at(3, 300, 0));
    CHECK(asPicture(**first).at(5, 7, 1) == 257 * (*first)->rgb.at(5, 7, 1));
    CHECK((*openCameraSource("simulated"))->id() == kSimulatedCameraId);
}
