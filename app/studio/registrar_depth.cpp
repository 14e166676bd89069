// Calibrating by poses of a printed board, and what a scan then measures, with a tape to set its metres right.
#include <algorithm>
#include <utility>

#include "app/studio/register_depth.h"
#include "app/studio/registrar.h"
#include "devices/emulated_scene/emulated_camera.h"
#include "devices/emulated_scene/scene_things.h"

namespace ilf::app {

using ui::RegisterWay;

std::string Registrar::cameraAt(int pose) const {
    if (view_->way != RegisterWay::calibration || !view_->emulated) return view_->camera;
    const auto colon = view_->camera.find(':');
    auto wish = devices::sceneWishFrom(colon == std::string::npos ? "" : view_->camera.substr(colon + 1));
    if (!wish || wish->board != 0) return view_->camera;
    wish->board = 1 + (pose - 1) % devices::scene::kBoardPoses;
    return devices::kEmulatedCameraId + ":" + devices::wordsOf(*wish);
}

void Registrar::scanPose() {
    if (!view_ || scanner_) return;
    ScanOrder wanted = order();
    wanted.camera = cameraAt(posesScanned_ + 1);
    const std::string name = "Pose " + std::to_string(posesScanned_ + 1);
    begin([run = parts_.pose, wanted, name, board = view_->calibration.board,
           poses = poses_](const auto& watch, const auto& stop) -> Result<ScanWorkDone> {
        auto outcome = run(wanted, board, poses, name, watch, stop);
        if (!outcome) return tl::unexpected(std::move(outcome.error()));
        return ScanWorkDone(*std::move(outcome));
    });
}

void Registrar::setBoard(const Board& board) {
    if (!view_ || scanner_ || board == view_->calibration.board) return;
    if (const auto good = checked(board); !good) return refuse(good.error().what);
    view_->calibration.board = board;
    view_->trouble.clear();
    poses_.clear();
    showPoses({}, {});
}

void Registrar::removePose(std::size_t pose) {
    if (!view_ || scanner_ || pose >= poses_.size()) return;
    auto left = poses_;
    left.erase(left.begin() + static_cast<std::ptrdiff_t>(pose));
    begin([left, board = view_->calibration.board, provenance = provenanceOf(order())](
              const auto&, const auto&) { return Result<ScanWorkDone>(calibratedBy(left, board, provenance)); },
          false);
    view_->doing = "Working the calibration out";
}

void Registrar::take(const PosesOutcome& outcome) {
    if (outcome.scan) looked(*outcome.scan);
    const bool newest = outcome.views.size() > poses_.size();
    poses_ = outcome.views;
    showPoses(outcome.calibrated, outcome.refused);
    if (newest) {
        view_->calibration.next = ++posesScanned_ + 1;
        view_->calibration.corners = poses_.back().inCamera;
        showPicture(ui::RegisterPicture::live);
    }
    if (!outcome.trouble.empty()) refuse(outcome.trouble);
}

void Registrar::showPoses(const Box<Calibrated>& found, std::string refused) {
    ui::RegisterPoses& shows = view_->calibration;
    shows.corners.clear();
    shows.poses.clear();
    shows.found = found;
    shows.refused = std::move(refused);
    for (std::size_t i = 0; i < poses_.size(); ++i) {
        ui::RegisterPose& pose = shows.poses.emplace_back();
        pose.name = poses_[i].name;
        pose.cameraCorners = static_cast<int>(poses_[i].inCamera.size());
        pose.projectorCorners = static_cast<int>(
            std::ranges::count_if(poses_[i].onProjector, [](const auto& at) { return at.has_value(); }));
        if (!found || i >= found->poses.size()) continue;
        pose.fitted = true;
        pose.used = found->poses[i].used;
        pose.camera_px = found->poses[i].camera_px;
        pose.projector_px = found->poses[i].projector_px;
    }
}

void Registrar::showDepth() {
    view_->found->depth = figuresOf(*depth_, found_->points);
    depthShown_ = depthPicture(*depth_);
    spreadShown_ = spreadPicture(*depth_);
    view_->hasDepth = true;
    measureTape();
}

void Registrar::toggleTape() {
    if (!view_ || scanner_ || !depth_) return;
    view_->tape.placing = !view_->tape.placing;
    view_->tape.ends.clear();
    measureTape();
}

void Registrar::placeTape(Point<CameraFrame> at) {
    if (!view_ || scanner_ || !depth_ || !view_->tape.placing) return;
    if (view_->tape.ends.size() == 2) view_->tape.ends.clear();
    view_->tape.ends.push_back(at);
    measureTape();
}

void Registrar::measureTape() {
    const auto& ends = view_->tape.ends;
    view_->tape.length = ends.size() == 2 ? lengthBetween(*depth_, ends[0], ends[1]).value_or(0.0_m) : 0.0_m;
}

void Registrar::tapeSays(Metre length) {
    if (!view_ || scanner_ || !depth_ || !(view_->tape.length > 0.0_m) || !rig_.calibration) return;
    auto calibration = rescaled(scaled_ ? *scaled_ : *rig_.calibration, view_->tape.length, length);
    if (!calibration) return refuse(calibration.error().what);
    depth_ = scaled(*depth_, length / view_->tape.length);
    view_->tape.scale = calibration->scale;
    scaled_ = Box(*std::move(calibration));
    showDepth();
}

}  // namespace ilf::app
