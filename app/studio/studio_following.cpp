// Regions that follow something: what the tracker is told, and what becomes of what it found.
#include "app/studio/studio.h"
#include "core/track/predict.h"

namespace ilf::app {

void Studio::followRegions() {
    const Document& document = editor_.document();
    const bool live = camera_.live() && !registrar_.view();
    // Within a gesture it knows the document from before: where a pose puts a region goes by the region's middle, which
    // must not run away under the brush.
    if ((trackedFor_ != editor_.serial() && !editor_.previewing()) || trackedLive_ != live) {
        trackedFor_ = editor_.serial();
        trackedLive_ = live;
        tracker_.follow(document, live);
    }
    if (auto news = tracker_.tryTake()) {
        const bool moved = news->serial != tracked_.serial;
        tracked_ = *std::move(news);
        if (moved) quietFrames_ = 0;
        const Second usual = LightTiming{}.ahead;
        const auto measured = lightLag_.last_ms();
        tracker_.lightAfter(measured ? Second::fromSi(*measured / 1e3) : usual, 1.0 / document.rig.sweepRate);
    }
    if (auto found = tracker_.tryTakeFound()) {
        markers_ = std::move(found);
        lookingForMarkers_ = false;
        quietFrames_ = 0;
    }
    for (const std::string& sentence : tracker_.takeSentences())
        say(sentence, ui::Tone::warning);
}

void Studio::on(const ui::LookForMarkers&) {
    lookingForMarkers_ = true;
    tracker_.lookForMarkers(editor_.document().scene.picture, camera_.live() ? liveFrame_ : Image<std::uint8_t>());
}

bool Studio::followsOnShow() const {
    return ownShow_ && !tracked_.moves.empty() && core_.light == devices::LightMode::slotted && !editor_.previewing() &&
           editor_.history().revision() == takenRevision_;
}

bool Studio::followsBehind() const {
    return ownShow_ && !liveTake_ && !tracked_.moves.empty() && core_.light == devices::LightMode::slotted &&
           !followsOnShow();
}

void Studio::sendBehind() {
    if (!followsBehind() || !done_.onShow || done_.onShowHash == sentHash_) return;
    sent_ = done_.onShow;
    sentHash_ = done_.onShowHash;
    ++revision_;
    if (done_.seen_ns) lightLag_.sent(revision_, *done_.seen_ns);
    link_.send({sent_, revision_, devices::Why::live, takeHold_});
}

void Studio::placeShown() {
    // Without the live picture things are where they were painted.
    if (!camera_.live() || tracked_.moves.empty() || registrar_.view()) {
        shownMotions_.clear();
        shown_.reset();
        return;
    }
    if (shown_ && shownSerial_ == editor_.serial() && shownMoves_ == tracked_.serial) return;
    shownSerial_ = editor_.serial();
    shownMoves_ = tracked_.serial;
    shownMotions_ = motionsAt(tracked_.moves, done_.compiled ? meanLight(done_.compiled->plan) : 0.0_s);
    shown_ = moved(editor_.document(), shownMotions_, shown_ ? &*shown_ : nullptr);
}

ui::FollowView Studio::followView() const {
    ui::FollowView view;
    view.regions = tracked_.regions;
    view.camera = camera_.live();
    view.oscPort = tracker_.oscPort();
    view.looking = lookingForMarkers_;
    view.looked = markers_.has_value();
    if (markers_) view.markers = *markers_;
    view.behind = followsBehind();
    view.shown = shown_ ? &*shown_ : nullptr;
    view.motions = shownMotions_;
    return view;
}

}  // namespace ilf::app
