// What the studio does while a camera is registered: it lends camera and light, and writes what was found into the rig.
#include <spdlog/spdlog.h>

#include "app/studio/studio.h"
#include "core/base/as_text.h"
#include "core/document/picture_change.h"
#include "core/optics/eye.h"
#include "core/registration/convert.h"
#include "devices/camera/list.h"
#include "ui/register_page.h"

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

bool works(const std::optional<ui::RegisterView>& page) {
    return page &&
           (page->state == ui::RegisterView::State::working || page->state == ui::RegisterView::State::stopping);
}

/// What an operator wants to find in the log afterwards.
void logOutcome(const ui::RegisterView& page) {
    const std::string by = "registering by " + ui::word(page.way);
    if (page.found) spdlog::info("{}: found, {} px rms", by, asText("%.2f", page.found->rms_px));
    if (page.found && page.found->depth)
        spdlog::info("{}: depth known to {} mm", by, asText("%.1f", 1e3 * page.found->depth->sigma.si()));
    const bool calibrates = page.way == ui::RegisterWay::calibration;
    if (calibrates && page.calibration.found) {
        const ProcamCalibration& found = page.calibration.found->calibration;
        spdlog::info("{}: {} poses, camera {} px rms, projector {} px rms", by, found.poses,
                     asText("%.3f", found.cameraRms_px), asText("%.3f", found.projectorRms_px));
    }
    if (calibrates && !page.calibration.refused.empty()) spdlog::info("{}: {}", by, page.calibration.refused);
    for (const ScanFinding& finding : page.findings)
        spdlog::warn("{}: {}", by, finding.what);
    if (!page.trouble.empty()) spdlog::warn("{}: {}", by, page.trouble);
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
    case Step::pose:
        lends();
        return registrar_.scanPose();
    case Step::cancel:
        return registrar_.cancel();
    case Step::marks:
        forgetTake();
        return registrar_.toggleMarks();
    case Step::another:
        return registrar_.anotherPlace();
    case Step::tape:
        return registrar_.toggleTape();
    case Step::accept:
        if (core_.light != devices::LightMode::steady && !registrar_.shows()) link_.safeLight();
        forgetTake();
        return registrar_.accept(request.setup);
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
void Studio::on(const ui::ShowRegisterPicture& request) { registrar_.showPicture(request.what); }
void Studio::on(const ui::SetBoard& request) { registrar_.setBoard(request.board); }
void Studio::on(const ui::RemovePose& request) { registrar_.removePose(request.pose); }
void Studio::on(const ui::PlaceTape& request) { registrar_.placeTape(request.at); }
void Studio::on(const ui::TapeSays& request) { registrar_.tapeSays(request.length); }

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
    registered_ = false;
    bump_.reset();
    Rig rig = document.rig;
    if (withoutStrayed(rig))
        say("The camera was moved since it was calibrated: calibrate again before a scan can measure depth.",
            ui::Tone::warning);
    registrar_.open(rig, rest, usualCamera(rig, core_));
}

void Studio::writeRegistration(const Registrar::ToWrite& found) {
    Rig rig = editor_.document().rig;
    if (found.registration && rig.projector != found.registration->projector)
        return say("The rig's projector was changed since: register the camera again.", ui::Tone::warning);
    if (found.registration) rig.registration = found.registration;
    if (found.registration) withoutStrayed(rig);
    if (found.calibration) rig.calibration = found.calibration;
    using When = ui::EditRequest::When;
    const CameraMode scenes = pictureMode(editor_.document());
    bool sceneIsIt = false;
    if (!found.picture.empty()) {
        Scene scene;
        scene.picture = Box(devices::asPicture({rgbOf(found.picture), {}, 0, 0.0}));
        scene.source = found.registration->camera.device;
        scene.scale = {focalPixels(scene.size().width, kDefaultFieldOfView), PixelScale::Source::assumed};
        scene.camera = found.registration->camera;
        scene = carriedOver(editor_.document(), std::move(scene));
        if (found.depth) {
            scene.scale = {found.depth->camera.fx, PixelScale::Source::calibrated};
            scene.measured = found.depth;
        }
        const auto done = editor_.handle({When::preview, SetScene{std::move(scene)}});
        sceneIsIt = done.has_value();
        if (!done) say("The picture did not become the scene. " + done.error().what, ui::Tone::warning);
    }
    if (found.registration && !sceneIsIt && scenes.device == found.registration->camera.device) {
        // Regions lie on the scene's picture, so that is what the map must be of.
        if (auto fitting = convertedTo(*rig.registration, scenes)) {
            rig.registration = Box(*std::move(fitting));
        } else {
            say(fitting.error().what + " The scene's picture is of another mode: grab it anew (F5).",
                ui::Tone::warning);
        }
    }
    if (const auto done = editor_.handle({When::preview, SetRig{rig}}); !done) {
        editor_.cancelGesture();
        return say(done.error().what, ui::Tone::warning);
    }
    editor_.commitGesture(found.registration ? "Register camera" : "Calibrate camera and projector");
    registered_ = registered_ || static_cast<bool>(found.registration);
    spdlog::info("{} went into the rig", found.registration ? "a registration" : "a calibration");
    registrar_.accepted(rig);
}

void Studio::tendRegistering() {
    const bool worked = works(registrar_.view());
    if (registrar_.collect()) quietFrames_ = 0;
    if (worked && registrar_.view() && !works(registrar_.view())) logOutcome(*registrar_.view());
    if (const auto found = registrar_.toWrite()) writeRegistration(*found);
    const std::string wanted = registrar_.wantsCamera();
    if (wanted == registeringCamera_) return;
    registeringCamera_ = wanted;
    if (!wanted.empty()) return camera_.openLive(wanted);
    if (registrar_.view()) return;
    if (cameraBefore_) return;
    pictures_.hideLive();
    if (!registered_) return camera_.close();
    if (camera_.live()) camera_.toggleLive();
}

}  // namespace ilf::app
