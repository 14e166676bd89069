// Regions that follow something: what the tracker is told, and what becomes of what it found.
#include "app/studio/studio.h"

namespace ilf::app {

void Studio::followRegions() {
    const Document& document = editor_.document();
    const bool live = camera_.live() && !registrar_.view();
    if (trackedFor_ != editor_.serial() || trackedLive_ != live) {
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

const Document& Studio::shown() const {
    const bool moved = camera_.live() && !tracked_.moves.empty() && !editor_.previewing() && done_.compiled &&
                       done_.serial == editor_.serial();
    return moved ? done_.compiled->document : editor_.document();
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
    return view;
}

}  // namespace ilf::app
