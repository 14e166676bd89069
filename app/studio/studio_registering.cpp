// What the studio does while a camera is registered: it lends camera and light, and writes what was found into the rig.
#include "app/studio/studio.h"
#include "core/optics/eye.h"
#include "devices/camera/list.h"

namespace ilf::app {
namespace {

Image<std::uint8_t> rgbOf(const Image<std::uint8_t>& picture) {
    if (picture.channels() == 3) return picture;
    std::vector<std::uint8_t> rgb;
    rgb.reserve(3 * picture.pixels().size());
    for (const std::uint8_t grey : picture.pixels())
        rgb.insert(rgb.end(), 3, grey);
    return Image<std::uint8_t>(picture.size(), 3, std::move(rgb));
}

/// The one the rig was registered with, else the first one plugged in; where light is simulated, the one that sees it.
std::string usualCamera(const Rig& rig, const devices::Status& core) {
    const auto cameras = devices::listCameras();
    for (const devices::CameraEntry& camera : cameras) {
        if (rig.registration && camera.id == rig.registration->camera.device) return camera.id;
    }
    for (const devices::CameraEntry& camera : cameras) {
        if (!camera.device.empty() && !core.simulated) return camera.id;
    }
    return devices::kEmulatedCameraId;
}

}  // namespace

void Studio::on(const ui::Register& request) {
    using Step = ui::Register::Step;
    const auto lends = [this] {
        forgetTake();
        camera_.close();
        registeringCamera_.clear();
    };
    switch (request.step) {
    case Step::open:
        return registerCamera();
    case Step::light:
        lends();
        return registrar_.checkLight();
    case Step::scan:
        lends();
        return registrar_.scan(request.setup.anyway);
    case Step::board:
        lends();
        return registrar_.findBoard();
    case Step::cancel:
        return registrar_.cancel();
    case Step::marks:
        forgetTake();
        return registrar_.toggleMarks();
    case Step::another:
        return registrar_.anotherPlace();
    case Step::picture:
        return registrar_.togglePicture();
    case Step::accept:
        if (core_.light != devices::LightMode::steady && !registrar_.shows()) link_.safeLight();
        forgetTake();
        return registrar_.accept(request.setup.asScene);
    case Step::close:
        return registrar_.close();
    case Step::shift:
        return followBump();
    case Step::quiet:
        bumpQuiet_ = editor_.document().rig.registration;
        bump_.reset();
        return;
    }
}

void Studio::on(const ui::ChooseRegisterWay& request) { registrar_.choose(request.way); }
void Studio::on(const ui::PlaceCorner& request) { registrar_.placeCorner(request.corner, request.at); }
void Studio::on(const ui::PlaceCross& request) { registrar_.placeCross(request.at); }
void Studio::on(const ui::RemovePair& request) { registrar_.removePair(request.pair); }

void Studio::registerCamera() {
    if (registrar_.view()) return;
    if (measurer_.view())
        return say("A rig is being measured: store or cancel that before registering a camera.", ui::Tone::warning);
    if (!core_.connected)
        return say("The output core is not connected, so no patterns can be shown; try again when it is back.",
                   ui::Tone::warning);
    const Document& document = editor_.document();
    const Dioptre rest = document.wearer.camera ? Dioptre() : restPower(eyeOptics(document.wearer));
    cameraBefore_ = camera_.live();
    bump_.reset();
    registrar_.open(document.rig, rest, usualCamera(document.rig, core_));
}

void Studio::writeRegistration(const Registrar::ToWrite& found) {
    Rig rig = editor_.document().rig;
    if (rig.projector != found.registration->projector)
        return say("The rig's projector was changed since: register the camera again.", ui::Tone::warning);
    rig.registration = found.registration;
    using When = ui::EditRequest::When;
    if (const auto done = editor_.handle({When::preview, SetRig{std::move(rig)}}); !done)
        return say(done.error().what, ui::Tone::warning);
    if (!found.picture.empty()) {
        Scene scene;
        scene.picture = Box(devices::asPicture({rgbOf(found.picture), {}, 0, 0.0}));
        scene.source = found.registration->camera.device;
        scene.scale = {focalPixels(scene.size().width, kDefaultFieldOfView), PixelScale::Source::assumed};
        if (const auto done = editor_.handle({When::preview, SetScene{carriedOver(std::move(scene))}}); !done)
            say(done.error().what, ui::Tone::warning);
    }
    editor_.commitGesture("Register camera");
    registrar_.accepted();
}

void Studio::tendRegistering() {
    if (registrar_.collect()) quietFrames_ = 0;
    if (const auto found = registrar_.toWrite()) writeRegistration(*found);
    const std::string wanted = registrar_.wantsCamera();
    if (wanted == registeringCamera_) return;
    registeringCamera_ = wanted;
    if (!wanted.empty()) return camera_.openLive(wanted);
    if (registrar_.view()) return;
    if (cameraBefore_) return;
    camera_.close();
    pictures_.hideLive();
}

}  // namespace ilf::app
