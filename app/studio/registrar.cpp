#include "app/studio/registrar.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "app/studio/register_marks.h"
#include "app/words.h"
#include "devices/emulated_scene/emulated_camera.h"

namespace ilf::app {
namespace {

using ui::RegisterWay;
using State = ui::RegisterView::State;

ui::RegisterWay wayOf(Registration::Method method) {
    switch (method) {
    case Registration::Method::corners:
        return RegisterWay::corners;
    case Registration::Method::pointPairs:
        return RegisterWay::pairs;
    case Registration::Method::chessboard:
        return RegisterWay::board;
    case Registration::Method::typed:
    case Registration::Method::scan:
        break;
    }
    return RegisterWay::scan;
}

ui::RegisterFound shown(const Registration& registration, std::string note) {
    return {wayOf(registration.method), registration.rms_px,     registration.worst_px,
            registration.points,        registration.provenance, std::move(note)};
}

/// Frames in which an automatic exposure finds itself in steady light; without any, the scan's own picture will do.
constexpr int kAdapting = 10;
constexpr std::chrono::seconds kNoFrames{4};

/// The id without the words that say what the emulated scene shall be.
std::string deviceOf(const std::string& camera) {
    return devices::isEmulatedCamera(camera) ? devices::kEmulatedCameraId : camera;
}

}  // namespace

Registrar::Registrar(std::filesystem::path runtimeDirectory, std::function<void()> onNews, RegisterParts parts)
    : directory_(std::move(runtimeDirectory)), onNews_(std::move(onNews)), parts_(std::move(parts)) {}

std::string Registrar::wantsCamera() const {
    const bool taken = !view_ || view_->state == State::working || view_->state == State::stopping;
    return taken ? std::string() : view_->camera;
}

void Registrar::open(const Rig& rig, Dioptre rest, const std::string& camera) {
    if (view_) return;
    rig_ = rig;
    rest_ = rest;
    places_ = crossPlaces(rig.projector);
    place_ = 0;
    placed_ = closing_ = false;
    live_ = quality_ = white_ = {};
    found_ = {};
    view_.emplace();
    view_->legend = qualityLegend();
    view_->target = places_.front();
    chooseCamera(camera);
}

void Registrar::close() {
    if (!view_) return;
    hideMarks();
    closing_ = true;
    if (scanner_) return cancel();
    view_.reset();
}

void Registrar::chooseCamera(const std::string& id) {
    if (!view_ || scanner_) return;
    view_->camera = id;
    view_->emulated = devices::isEmulatedCamera(id);
    view_->state = State::ready;
    view_->light.reset();
    view_->findings.clear();
    view_->remarks.clear();
    view_->decodedShare = -1.0;
    view_->trouble.clear();
    view_->pairs.clear();
    view_->worst = -1;
    view_->picture = live_ = quality_ = white_ = {};
    view_->quality = view_->hasQuality = placed_ = false;
    place_ = 0;
    forgetFound();
    showMark();
}

void Registrar::choose(RegisterWay way) {
    if (!view_ || scanner_ || view_->way == way) return;
    hideMarks();
    view_->way = way;
    view_->state = State::ready;
    view_->trouble.clear();
    view_->quality = false;
    view_->picture = live_;
    forgetFound();
    if (way == RegisterWay::pairs) fitPairs();
}

ScanOrder Registrar::order() const { return {rig_, rest_, directory_, view_->camera, {}, {}}; }

void Registrar::begin(ScanWork work) {
    if (!view_ || scanner_ || view_->camera.empty()) return;
    hideMarks();
    forgetFound();
    view_->state = State::working;
    view_->trouble.clear();
    view_->doing.clear();
    view_->done = 0;
    view_->quality = false;
    scanner_ = std::make_unique<Scanner>(std::move(work), [this] {
        if (onNews_) onNews_();
    });
}

void Registrar::scan(bool anyway) {
    if (!view_ || scanner_) return;
    view_->findings.clear();
    view_->remarks.clear();
    view_->decodedShare = -1.0;
    view_->hasQuality = false;
    ScanOrder wanted = order();
    wanted.wish.anyway = anyway;
    begin([run = parts_.scan, wanted](const auto& watch, const auto& stop) -> Result<ScanWorkDone> {
        auto outcome = run(wanted, watch, stop);
        if (!outcome) return tl::unexpected(std::move(outcome.error()));
        return ScanWorkDone(*std::move(outcome));
    });
}

void Registrar::checkLight() {
    if (!view_ || scanner_) return;
    view_->light.reset();
    begin([run = parts_.light, wanted = order()](const auto& watch, const auto& stop) -> Result<ScanWorkDone> {
        auto check = run(wanted, watch, stop);
        if (!check) return tl::unexpected(std::move(check.error()));
        return ScanWorkDone(*std::move(check));
    });
}

void Registrar::findBoard() {
    if (!view_ || scanner_) return;
    begin([run = parts_.board, wanted = order()](const auto& watch, const auto& stop) -> Result<ScanWorkDone> {
        auto board = run(wanted, watch, stop);
        if (!board) return tl::unexpected(std::move(board.error()));
        return ScanWorkDone(*std::move(board));
    });
}

void Registrar::cancel() {
    if (!view_) return;
    hideMarks();
    if (!scanner_) return;
    view_->state = State::stopping;
    scanner_->cancel();
}

void Registrar::livePicture(const Image<std::uint8_t>& rgb) {
    if (!view_ || scanner_) return;
    if (!live_.empty() && live_.size() != rgb.size()) placed_ = false;
    live_ = rgb;
    ++steadyFrames_;
    if (!view_->quality) view_->picture = live_;
    if (placed_) return;
    placed_ = true;
    const double w = rgb.width(), h = rgb.height();
    view_->corners = {{{0.2 * w, 0.2 * h}, {0.8 * w, 0.2 * h}, {0.8 * w, 0.8 * h}, {0.2 * w, 0.8 * h}}};
}

void Registrar::togglePicture() {
    if (!view_ || scanner_ || !view_->hasQuality) return;
    view_->quality = !view_->quality;
    view_->picture = view_->quality ? quality_ : live_;
}

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
    view_->found = shown(registration, found->note);
    found_ = Box(std::move(registration));
}

void Registrar::lightOf(const AmbientCheck& ambient, Second exposure) {
    view_->light = ui::RegisterLight{ambient.go, ambient.what, ambient.projectorShare, ambient.contrast, exposure.si()};
}

void Registrar::take(const LightCheck& check) {
    if (check.ambient.lit > 0.0) lightOf(check.ambient, check.exposure);
    view_->remarks = check.remarks;
    if (!check.trouble.empty()) refuse(check.trouble);
}

void Registrar::take(const ScanOutcome& outcome) {
    lightOf(outcome.captured.ambient, outcome.captured.exposure);
    view_->remarks = outcome.captured.remarks;
    view_->findings = outcome.diagnosis.findings;
    view_->decodedShare = outcome.diagnosis.decodedShare;
    quality_ = qualityMap(outcome.decoded);
    view_->hasQuality = view_->quality = true;
    view_->picture = quality_;
    if (!outcome.trouble.empty()) {
        // A finding says the same: once is enough.
        const bool said =
            std::ranges::any_of(view_->findings, [&](const auto& f) { return f.what == outcome.trouble; });
        if (!said) refuse(outcome.trouble);
    }
    if (!outcome.registration) return;
    found_ = outcome.registration;
    view_->found = shown(*found_, {});
    white_ = outcome.captured.scan.pictures.front();
}

void Registrar::take(const PairedRegistration& board) {
    found_ = Box(board.registration);
    view_->found = shown(board.registration, board.note);
}

void Registrar::forgetFound() {
    accepting_.reset();
    white_ = {};
    found_ = {};
    if (view_) view_->found.reset();
}

void Registrar::refuse(const std::string& why) { view_->trouble = why; }

void Registrar::accept(bool asScene) {
    if (!view_ || scanner_ || !found_ || accepting_) return;
    hideMarks();
    steadyFrames_ = 0;
    accepting_ = {asScene, std::chrono::steady_clock::now()};
}

std::optional<Registrar::ToWrite> Registrar::toWrite() {
    if (!accepting_ || !found_) return std::nullopt;
    const bool waited = std::chrono::steady_clock::now() - accepting_->since > kNoFrames;
    if (accepting_->asScene && steadyFrames_ < kAdapting && !waited) return std::nullopt;
    ToWrite both{found_, {}};
    if (accepting_->asScene) both.picture = steadyFrames_ >= kAdapting ? live_ : white_;
    accepting_.reset();
    return both;
}

void Registrar::accepted() {
    if (!view_) return;
    view_->state = State::accepted;
    view_->trouble.clear();
    forgetFound();
}

bool Registrar::collect() {
    bool any = false;
    if (marks_) {
        if (auto why = marks_->ended()) {
            hideMarks();
            refuse(*why);
            any = true;
        }
    }
    if (!scanner_) return any;
    if (auto progress = scanner_->progress()) {
        any = true;
        view_->doing = std::move(progress->words);
        view_->done = progress->done;
        view_->all = progress->all;
        if (!progress->picture.empty()) view_->picture = std::move(progress->picture);
    }
    auto result = scanner_->result();
    if (!result) return any;
    scanner_.reset();
    if (closing_) {
        view_.reset();
        return true;
    }
    view_->state = State::ready;
    view_->picture = live_;
    if (*result)
        std::visit([this](const auto& done) { take(done); }, **result);
    else
        refuse(result->error().what);
    return true;
}

}  // namespace ilf::app
