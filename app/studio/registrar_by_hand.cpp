// Registering by what the operator points at: four corners, and numbered crosses.
#include <algorithm>
#include <utility>

#include "app/studio/register_marks.h"
#include "app/studio/registrar.h"
#include "app/words.h"
#include "devices/emulated_scene/emulated_camera.h"

namespace ilf::app {
namespace {

using ui::RegisterWay;

/// The id without the words that say what the emulated scene shall be.
std::string deviceOf(const std::string& camera) {
    return devices::isEmulatedCamera(camera) ? devices::kEmulatedCameraId : camera;
}

}  // namespace

void Registrar::toggleMarks() {
    if (!view_ || scanner_) return;
    if (marks_) return hideMarks();
    marks_ = std::make_unique<MarksShow>(directory_, rig_, rest_, onNews_);
    view_->showsMarks = true;
    view_->trouble.clear();
    showMark();
}

void Registrar::hideMarks() {
    marks_.reset();
    if (view_) view_->showsMarks = false;
}

void Registrar::showMark() {
    view_->targetsLeft = place_ < places_.size();
    if (view_->targetsLeft) view_->target = places_[place_];
    if (!marks_) return;
    if (view_->way == RegisterWay::corners)
        marks_->show(framePicture(rig_.projector));
    else if (view_->targetsLeft)
        marks_->show(crossPicture(rig_.projector, view_->target, static_cast<int>(view_->pairs.size()) + 1));
}

void Registrar::anotherPlace() {
    if (!view_ || scanner_ || view_->way != RegisterWay::pairs || place_ >= places_.size()) return;
    std::rotate(places_.begin() + static_cast<std::ptrdiff_t>(place_),
                places_.begin() + static_cast<std::ptrdiff_t>(place_) + 1, places_.end());
    showMark();
}

void Registrar::placeCorner(int corner, Point<CameraFrame> at) {
    if (!view_ || scanner_ || view_->way != RegisterWay::corners || live_.empty() || corner < 0 || corner > 3) return;
    const Size size = live_.size();
    view_->corners[static_cast<std::size_t>(corner)] = {std::clamp(at.x, -0.5 * size.width, 1.5 * size.width),
                                                        std::clamp(at.y, -0.5 * size.height, 1.5 * size.height)};
    foundByHand(registeredByCorners(view_->corners, size, rig_.projector));
}

void Registrar::placeCross(Point<CameraFrame> at) {
    if (!view_ || !marks_ || view_->way != RegisterWay::pairs || place_ >= places_.size()) return;
    view_->pairs.push_back({{at, places_[place_]}});
    ++place_;
    fitPairs();
    showMark();
}

void Registrar::removePair(std::size_t pair) {
    if (!view_ || scanner_ || pair >= view_->pairs.size()) return;
    // Its place is asked for again, next.
    const auto gone = places_.begin() + static_cast<std::ptrdiff_t>(pair);
    std::rotate(gone, gone + 1, places_.begin() + static_cast<std::ptrdiff_t>(place_));
    --place_;
    view_->pairs.erase(view_->pairs.begin() + static_cast<std::ptrdiff_t>(pair));
    fitPairs();
    showMark();
}

void Registrar::fitPairs() {
    view_->worst = -1;
    for (ui::RegisterPair& pair : view_->pairs)
        pair.fitted = false, pair.used = true;
    forgetFound();
    view_->trouble.clear();
    if (view_->pairs.size() < 4 || live_.empty()) return;
    std::vector<PointPair> points;
    for (const ui::RegisterPair& pair : view_->pairs)
        points.push_back(pair.at);
    const auto found = registeredByPairs(points, live_.size(), rig_.projector);
    foundByHand(found);
    if (!found) return;
    view_->worst = found->worst;
    for (std::size_t i = 0; i < points.size(); ++i) {
        view_->pairs[i].residual_px = found->residual_px[i];
        view_->pairs[i].used = found->used[i];
        view_->pairs[i].fitted = true;
    }
}

void Registrar::foundByHand(const Result<PairedRegistration>& found) {
    forgetFound();
    view_->trouble.clear();
    if (!found) return refuse(found.error().what);
    Registration registration = found->registration;
    registration.camera.device = deviceOf(view_->camera);
    registration.taken = utcNow();
    registration.projectorName = rig_.name;
    registration.provenance = provenanceOf(order());
    showFound(Box(std::move(registration)), found->note);
}

}  // namespace ilf::app
