// Whether the camera was bumped since it was registered: looked at each second, said once, one click to follow it.
#include <spdlog/spdlog.h>

#include <utility>

#include "app/studio/studio.h"
#include "core/track/moved_mask.h"

namespace ilf::app {
namespace {

constexpr double kLooks_s = 1.0;

}  // namespace

void Studio::lookForBump() {
    const Document& document = editor_.document();
    const Box<Registration>& own = document.rig.registration;
    const Scene& scene = document.scene;
    // The scene's picture is the reference: it was taken by this camera where it was registered.
    const bool comparable = own && !registrar_.view() && scene.picture && camera_.id() == own->camera.device &&
                            scene.source == own->camera.device && camera_.frame().rgb.size() == scene.size();
    if (!comparable || own.same(bumpQuiet_)) {
        bump_.reset();
        return;
    }
    if (now_s() - bumpLookedAt_s_ < kLooks_s) return;
    bumpLookedAt_s_ = now_s();
    bumpWatch_.compare(scene.picture, camera_.frame().rgb);
}

void Studio::takeBump() {
    auto report = bumpWatch_.tryTake();
    if (!report) return;
    if (report->bumped && !bump_)
        spdlog::warn("the camera was moved: what it sees lies {:.1f} px aside", report->moved_px);
    strayed_ = report->bumped ? editor_.document().rig.calibration : Box<ProcamCalibration>();
    bump_ = report->bumped ? std::move(report) : std::nullopt;
    quietFrames_ = 0;
}

/// Where things are seen moved with the camera, where the projector sees them did not.
bool Studio::withoutStrayed(Rig& rig) const {
    if (!rig.calibration || !rig.calibration.same(strayed_)) return false;
    rig.calibration = {};
    return true;
}

void Studio::followBump() {
    if (!bump_ || !bump_->newFromOld || camera_.id().empty()) return;
    const Document& document = editor_.document();
    const Motion motion = *bump_->newFromOld;
    bump_.reset();
    Rig rig = document.rig;
    rig.registration = Box(afterBump(*rig.registration, motion));
    const bool calibrate = withoutStrayed(rig);
    auto grabbed = camera_.grabbed();
    if (!grabbed) return say(grabbed.error().what, ui::Tone::warning);
    Scene scene = document.scene;
    scene.picture = grabbed->picture;
    std::vector<Edit> edits{SetRig{std::move(rig)}, SetScene{std::move(scene)}};
    for (const Box<Region>& region : document.regions)
        edits.push_back(SetMask{region->id, moved(region->mask, motion), "Follow the camera"});
    for (Edit& one : edits) {
        // A locked region stays, and says so.
        if (const auto done = editor_.handle({ui::EditRequest::When::preview, std::move(one)}); !done)
            say(done.error().what, ui::Tone::warning);
    }
    editor_.commitGesture("Follow the camera");
    const std::string depth = calibrate ? " Depth does not: calibrate and scan again for it."
                              : editor_.document().scene.depth
                                  ? " Depth does not: scan again where distances come from it."
                                  : "";
    say("Picture, regions and map have moved along with the camera." + depth,
        depth.empty() ? ui::Tone::note : ui::Tone::warning);
}

}  // namespace ilf::app
