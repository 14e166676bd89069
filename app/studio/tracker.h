// Follows what the document's regions follow, on a thread of its own: camera pictures and poses go in, moves come out.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include "core/base/latest.h"
#include "core/track/region_tracker.h"
#include "devices/camera/frame.h"
#include "devices/osc/pose_receiver.h"
#include "ui/follow_view.h"

namespace ilf::app {

/// Newest wins.
struct TrackNews {
    std::vector<FollowedNow> regions;
    std::vector<RegionMove> moves;
    std::uint64_t serial = 0;  ///< another one only where `moves` are others
    Second arrived;            ///< the picture or pose they were made of, as steadyNow()
};

/// All functions are for one thread and never wait for the tracker's. Where no region follows anything its thread
/// sleeps, and pictures are not even handed over.
class Tracker {
public:
    /// `onNews` is called from other threads when `tryTake` has something.
    explicit Tracker(std::function<void()> onNews);
    ~Tracker();
    Tracker(const Tracker&) = delete;
    Tracker& operator=(const Tracker&) = delete;

    /// Hears poses from this machine. Refused: a port that another program has.
    Result<void> listen(int port);
    int oscPort() const { return oscPort_; }

    /// The document as it is painted. `camera`: its pictures will come; without them what follows them is left where it
    /// was painted, since nobody asked for it to be looked at.
    void follow(const Document& document, bool camera);
    void see(const devices::Frame& frame);
    /// From a picture's arrival until its light, as measured, and how long a sweep is.
    void lightAfter(Second ahead, Second period);
    /// Which markers of the usual dictionaries are in these pictures; some tenths of a second.
    void lookForMarkers(Box<Picture> scene, Image<std::uint8_t> live);

    std::optional<TrackNews> tryTake() { return news_.tryTake(); }
    /// The answer to a look for markers.
    std::optional<std::vector<ui::MarkerFound>> tryTakeFound() { return found_.tryTake(); }
    /// What was wrong with poses since the last call, each kind once.
    std::vector<std::string> takeSentences();

private:
    struct Posted {
        std::optional<Document> document;
        FollowBy by;
        std::optional<devices::Frame> frame;
        bool poses = false;
        std::optional<Box<Picture>> scene;  ///< to look for markers in, with `live`
        Image<std::uint8_t> live;
        bool any() const { return document || frame || poses || scene; }
    };
    struct Search;  ///< for markers, a dictionary at a time

    void run(const std::stop_token& stop);
    Posted next(const std::stop_token& stop, std::optional<Second> patience);
    void work(Posted& posted, Search& search);
    void publish();

    std::function<void()> onNews_;
    std::mutex mutex_;
    std::condition_variable_any wakes_;
    Posted posted_;
    LightTiming timing_;
    Second period_ = Second::fromSi(1.0 / 60.0);
    Latest<TrackNews> news_;
    Latest<std::vector<ui::MarkerFound>> found_;

    // Of the calling thread.
    bool follows_ = false, looks_ = false;
    int oscPort_ = 0;

    // Of the tracker's thread alone.
    RegionTracker tracker_;
    TrackNews last_;
    std::optional<Second> lastFrame_, sweepStart_;
    Second between_ = 33.3_ms;  ///< pictures

    std::unique_ptr<devices::PoseReceiver> osc_;  ///< guarded by mutex_ until it is there; then it stays
    std::jthread thread_;                         // last: joins before what it uses goes
};

}  // namespace ilf::app
