#include "app/studio/tracker.h"

#include <algorithm>
#include <array>
#include <deque>
#include <exception>
#include <span>
#include <utility>

#include "core/base/grey.h"
#include "core/track/marker.h"

namespace ilf::app {
namespace {

/// A hold ends and a fade goes on in steps of this; a sweep is a third of it.
constexpr Second kStep = 50.0_ms;
/// One of each family: the smaller dictionaries are its beginnings. Those of few bits (APRILTAG_16h5) are found in any
/// clutter and must be typed.
constexpr std::array kUsual{"APRILTAG_36h11", "4X4_250", "5X5_250", "6X6_250", "7X7_250", "APRILTAG_25h9"};
constexpr double kSureMarker = 0.5;

std::vector<int> allIdsOf(const std::string& dictionary) {
    std::vector<int> ids;
    while (checkedMarker(dictionary, static_cast<int>(ids.size())))
        ids.push_back(static_cast<int>(ids.size()));
    return ids;
}

StreamPose poseOf(const devices::OscPose& said) { return {said.x, said.y, said.rotation_deg, said.confidence}; }

}  // namespace

struct Tracker::Search {
    struct Look {
        Image<std::uint8_t> grey;
        bool inScene;
        const char* dictionary;
    };
    std::deque<Look> left;
    std::vector<ui::MarkerFound> found;

    /// True: there is nothing to look in.
    bool begin(const Box<Picture>& scene, const Image<std::uint8_t>& live) {
        left.clear();
        found.clear();
        const auto sceneGrey = scene ? greyOf(*scene) : Image<std::uint8_t>();
        const auto liveGrey = live.empty() ? live : greyOf(live);
        for (const char* dictionary : kUsual) {
            if (!sceneGrey.empty()) left.push_back({sceneGrey, true, dictionary});
            if (!liveGrey.empty()) left.push_back({liveGrey, false, dictionary});
        }
        return left.empty();
    }
    /// True with the last one.
    bool step() {
        if (left.empty()) return false;
        const Look look = std::move(left.front());
        left.pop_front();
        if (const auto seen = findMarkers(look.grey, {look.dictionary, allIdsOf(look.dictionary), {}, 1})) {
            for (const SeenMarker& marker : *seen) {
                if (marker.confidence < kSureMarker) continue;
                const auto same = std::ranges::find_if(found, [&](const ui::MarkerFound& other) {
                    return other.id == marker.id && other.dictionary == look.dictionary;
                });
                if (same == found.end())
                    found.push_back({look.dictionary, marker.id, middleOf(marker.corners), look.inScene});
            }
        }
        return left.empty();
    }
};

Tracker::Tracker(std::function<void()> onNews)
    : onNews_(std::move(onNews)), thread_([this](const std::stop_token& stop) { run(stop); }) {}
Tracker::~Tracker() = default;

Result<void> Tracker::listen(int port) {
    auto receiver = devices::PoseReceiver::open(port, false, [this] {
        {
            const std::scoped_lock lock(mutex_);
            posted_.poses = true;
        }
        wakes_.notify_one();
    });
    if (!receiver) return tl::unexpected(receiver.error());
    oscPort_ = (*receiver)->port();
    const std::scoped_lock lock(mutex_);
    osc_ = *std::move(receiver);
    return {};
}

void Tracker::follow(const Document& document, bool camera) {
    const auto follows = [&](bool stream) {
        return std::ranges::any_of(document.regions, [&](const Box<Region>& region) {
            return region->follow && std::holds_alternative<StreamTarget>(region->follow->target) == stream;
        });
    };
    const bool before = std::exchange(follows_, follows(false) || follows(true));
    looks_ = camera && follows(false);
    if (!before && !follows_) return;
    {
        const std::scoped_lock lock(mutex_);
        posted_.document = document;
        posted_.by = {camera, oscPort_ != 0};
        if (!looks_) posted_.frame.reset();
    }
    wakes_.notify_one();
}

void Tracker::see(const devices::Frame& frame) {
    if (!looks_) return;
    {
        const std::scoped_lock lock(mutex_);
        posted_.frame = frame;
    }
    wakes_.notify_one();
}

void Tracker::lightAfter(Second ahead, Second period) {
    const std::scoped_lock lock(mutex_);
    timing_.ahead = ahead;
    period_ = period;
}

void Tracker::lookForMarkers(Box<Picture> scene, Image<std::uint8_t> live) {
    {
        const std::scoped_lock lock(mutex_);
        posted_.scene = std::move(scene);
        posted_.live = std::move(live);
    }
    wakes_.notify_one();
}

std::vector<std::string> Tracker::takeSentences() { return osc_ ? osc_->takeSentences() : std::vector<std::string>(); }

Tracker::Posted Tracker::next(const std::stop_token& stop, std::optional<Second> patience) {
    std::unique_lock lock(mutex_);
    const auto arrived = [this] { return posted_.any(); };
    if (patience) {
        wakes_.wait_for(lock, stop, std::chrono::duration<double>(patience->si()), arrived);
    } else {
        wakes_.wait(lock, stop, arrived);
    }
    return std::exchange(posted_, {});
}

void Tracker::run(const std::stop_token& stop) {
    Search search;
    while (true) {
        std::optional<Second> patience;
        if (tracker_.patient()) patience = kStep;
        if (!search.left.empty()) patience = 0.0_s;
        Posted posted = next(stop, patience);
        if (stop.stop_requested()) return;
        try {
            work(posted, search);
        } catch (const std::exception&) {  // memory, or OpenCV where nobody expected it: this picture was not seen
            tracker_.pass(devices::steadyNow());
        }
        publish();
    }
}

void Tracker::work(Posted& posted, Search& search) {
    const bool nothing = posted.scene && search.begin(*posted.scene, posted.live);
    if (posted.document) tracker_.follow(*posted.document, posted.by);
    LightTiming timing;
    std::vector<devices::TimedPose> poses;
    {
        const std::scoped_lock lock(mutex_);
        timing = timing_;
        if (osc_) poses = osc_->take();
    }
    const auto arrived = [&](Second time) {
        last_.arrived = time;
        // The program stays until the next picture's: it is made for the middle of that time.
        sweepStart_ = time + timing.ahead + 0.5 * between_;
    };
    if (posted.frame && tracker_.looks()) {
        const Second time = posted.frame->time;
        if (lastFrame_ && time > *lastFrame_) between_ = 0.8 * between_ + 0.2 * std::min(time - *lastFrame_, 100.0_ms);
        lastFrame_ = time;
        tracker_.see(greyOf(posted.frame->rgb), exposureMiddle(time, timing), devices::steadyNow());
        arrived(time);
    }
    for (const devices::TimedPose& pose : poses) {
        tracker_.hear(pose.pose.address, poseOf(pose.pose), pose.time, devices::steadyNow());
        arrived(devices::steadyNow());
    }
    tracker_.pass(devices::steadyNow());
    if (search.step() || nothing) {
        found_.put(std::move(search.found));
        if (onNews_) onNews_();
    }
}

void Tracker::publish() {
    Second period;
    {
        const std::scoped_lock lock(mutex_);
        period = period_;
    }
    auto moves = tracker_.moves(sweepStart_.value_or(devices::steadyNow()), period);
    auto regions = tracker_.now();
    if (moves == last_.moves && regions == last_.regions) return;
    if (!(moves == last_.moves)) ++last_.serial;
    last_.moves = std::move(moves);
    last_.regions = std::move(regions);
    news_.put(last_);
    if (onNews_) onNews_();
}

}  // namespace ilf::app
