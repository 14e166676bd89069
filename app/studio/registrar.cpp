#include "app/studio/registrar.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "app/scan/light_map.h"
#include "app/studio/register_depth.h"
#include "app/studio/register_marks.h"
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

/// Frames in which an automatic exposure finds itself in steady light; without any, the scan's own picture will do.
constexpr int kAdapting = 10;
constexpr std::chrono::seconds kNoFrames{4};

}  // namespace

Registrar::Registrar(std::filesystem::path runtimeDirectory, std::function<void()> onNews, RegisterParts parts)
    : directory_(std::move(runtimeDirectory)), onNews_(std::move(onNews)), parts_(std::move(parts)) {}

std::string Registrar::wantsCamera() const {
    return !view_ || lent_ ? std::string() : cameraAt(std::max(1, posesScanned_));
}

void Registrar::open(const Rig& rig, Dioptre rest, const std::string& camera) {
    if (view_) return;
    rig_ = rig;
    rest_ = rest;
    places_ = crossPlaces(rig.projector);
    place_ = 0;
    placed_ = closing_ = false;
    live_ = quality_ = depthShown_ = spreadShown_ = white_ = {};
    found_ = {};
    view_.emplace();
    view_->calibrated = static_cast<bool>(rig_.calibration);
    view_->legend = qualityLegend();
    view_->target = places_.front();
    chooseCamera(camera);
}

void Registrar::close() {
    if (!view_) return;
    hideMarks();
    forgetFound();
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
    forgetLooks();
    view_->trouble.clear();
    view_->pairs.clear();
    view_->worst = -1;
    view_->picture = live_ = quality_ = depthShown_ = spreadShown_ = white_ = {};
    view_->shows = ui::RegisterPicture::live;
    placed_ = false;
    poses_.clear();
    posesScanned_ = 0;
    view_->calibration.next = 1;
    showPoses({}, {});
    place_ = 0;
    forgetFound();
    showMark();
}

void Registrar::choose(RegisterWay way) {
    const bool there = view_ && view_->way == way && view_->state != State::accepted;
    if (!view_ || scanner_ || there) return;
    hideMarks();
    view_->way = way;
    view_->state = State::ready;
    view_->trouble.clear();
    forgetLooks();
    forgetFound();
    showPicture(ui::RegisterPicture::live);
    if (way == RegisterWay::pairs) fitPairs();
}

ScanOrder Registrar::order() const { return {rig_, rest_, directory_, view_->camera, {}, {}}; }

void Registrar::begin(ScanWork work, bool withCamera) {
    if (!view_ || scanner_ || view_->camera.empty()) return;
    lent_ = withCamera;
    hideMarks();
    forgetLooks();
    forgetFound();
    view_->state = State::working;
    view_->trouble.clear();
    view_->doing.clear();
    view_->done = 0;
    view_->shows = ui::RegisterPicture::live;
    scanner_ = std::make_unique<Scanner>(std::move(work), [this] {
        if (onNews_) onNews_();
    });
}

void Registrar::scan(bool anyway) {
    if (!view_ || scanner_) return;
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
    if (accepting_) accepting_->since = std::chrono::steady_clock::now();
    if (view_->shows == ui::RegisterPicture::live) view_->picture = live_;
    if (placed_) return;
    placed_ = true;
    const double w = rgb.width(), h = rgb.height();
    view_->corners = {{{0.2 * w, 0.2 * h}, {0.8 * w, 0.2 * h}, {0.8 * w, 0.8 * h}, {0.2 * w, 0.8 * h}}};
}

void Registrar::showPicture(ui::RegisterPicture what) {
    using What = ui::RegisterPicture;
    if (!view_ || scanner_) return;
    const bool measured = what == What::depth || what == What::spread;
    if ((what == What::quality && !view_->hasQuality) || (measured && !view_->hasDepth)) return;
    view_->shows = what;
    if (measured) view_->ramp = depthRamp(what == What::depth);
    view_->picture = what == What::quality  ? quality_
                     : what == What::depth  ? depthShown_
                     : what == What::spread ? spreadShown_
                                            : live_;
}

void Registrar::lightOf(const AmbientCheck& ambient, Second exposure) {
    view_->light = ui::RegisterLight{ambient.go, ambient.what, ambient.projectorShare, ambient.contrast, exposure.si()};
}

void Registrar::take(const LightCheck& check) {
    if (check.ambient.lit > 0.0) lightOf(check.ambient, check.exposure);
    view_->remarks = check.remarks;
    if (!check.trouble.empty()) refuse(check.trouble);
}

void Registrar::looked(const ScanOutcome& outcome) {
    if (outcome.captured.ambient.lit > 0.0) lightOf(outcome.captured.ambient, outcome.captured.exposure);
    view_->remarks = outcome.captured.remarks;
    view_->findings = outcome.diagnosis.findings;
    const bool decoded = outcome.black.empty();
    view_->decodedShare = decoded ? outcome.diagnosis.decodedShare : -1.0;
    if (decoded) {
        quality_ = qualityMap(outcome.decoded);
        view_->legend = qualityLegend();
    } else {
        const LightMap seen = lightMap(outcome.white, outcome.black, outcome.moved);
        quality_ = seen.rgb;
        view_->legend = seen.legend;
    }
    view_->hasQuality = true;
    showPicture(ui::RegisterPicture::quality);
}

void Registrar::take(const ScanOutcome& outcome) {
    looked(outcome);
    if (!outcome.trouble.empty()) refuse(outcome.trouble);
    if (!outcome.registration) return;
    showFound(outcome.registration, {});
    view_->found->noDepth = outcome.noDepth;
    white_ = outcome.captured.scan.pictures.front();
    if (!outcome.depth) return;
    depth_ = outcome.depth->depth;
    view_->tape.scale = rig_.calibration ? rig_.calibration->scale : std::string();
    showDepth();
}

void Registrar::take(const PairedRegistration& board) { showFound(Box(board.registration), board.note); }

void Registrar::showFound(Box<Registration> registration, std::string note) {
    found_ = std::move(registration);
    ui::RegisterFound& found = view_->found.emplace();
    found.way = wayOf(found_->method);
    found.rms_px = found_->rms_px;
    found.worst_px = found_->worst_px;
    found.points = found_->points;
    found.provenance = found_->provenance;
    found.note = std::move(note);
}

void Registrar::forgetLooks() {
    view_->findings.clear();
    view_->remarks.clear();
    view_->decodedShare = -1.0;
    view_->hasQuality = false;
}

void Registrar::forgetFound() {
    accepting_.reset();
    white_ = {};
    found_ = {};
    depth_.reset();
    scaled_ = {};
    if (!view_) return;
    view_->accepting = false;
    view_->found.reset();
    view_->hasDepth = false;
    view_->tape = {};
}

void Registrar::refuse(const std::string& why) {
    // Where a finding says the same, once is enough.
    if (std::ranges::none_of(view_->findings, [&](const auto& finding) { return finding.what == why; }))
        view_->trouble = why;
}

void Registrar::accept(const ui::RegisterSetup& setup) {
    const bool any = view_ && (view_->way == RegisterWay::calibration ? bool(view_->calibration.found) : bool(found_));
    if (!any || scanner_ || accepting_) return;
    hideMarks();
    steadyFrames_ = 0;
    accepting_ = {setup, std::chrono::steady_clock::now()};
    view_->accepting = true;
}

std::optional<Registrar::ToWrite> Registrar::toWrite() {
    if (!view_ || !accepting_) return std::nullopt;
    const ui::RegisterSetup setup = accepting_->setup;
    ToWrite all;
    if (view_->way == RegisterWay::calibration) {
        all.calibration = Box(view_->calibration.found->calibration);
    } else {
        const bool waited = std::chrono::steady_clock::now() - accepting_->since > kNoFrames;
        if (setup.asScene && steadyFrames_ < kAdapting && !waited) return std::nullopt;
        all.registration = found_;
        all.calibration = scaled_;
        if (setup.asScene) all.picture = steadyFrames_ >= kAdapting ? live_ : white_;
        if (setup.asScene && setup.depth && depth_) all.depth = Box(*depth_);
    }
    accepting_.reset();
    view_->accepting = false;
    return all;
}

void Registrar::accepted(const Rig& rig) {
    if (!view_) return;
    rig_ = rig;
    view_->calibrated = static_cast<bool>(rig_.calibration);
    view_->state = State::accepted;
    view_->trouble.clear();
    forgetLooks();
    forgetFound();
    showPicture(ui::RegisterPicture::live);
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
    lent_ = false;
    if (closing_) {
        view_.reset();
        return true;
    }
    view_->state = State::ready;
    showPicture(ui::RegisterPicture::live);
    if (*result)
        std::visit([this](const auto& done) { take(done); }, **result);
    else
        refuse(result->error().what);
    return true;
}

}  // namespace ilf::app
