// The studio: wires window, editor, worker, output core, camera and files, on the main thread.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/studio/bump_watch.h"
#include "app/studio/camera_port.h"
#include "app/studio/editor.h"
#include "app/studio/keeper.h"
#include "app/studio/latency.h"
#include "app/studio/link.h"
#include "app/studio/measurer.h"
#include "app/studio/options.h"
#include "app/studio/registrar.h"
#include "app/studio/selector.h"
#include "app/studio/tracker.h"
#include "app/studio/worker.h"
#include "app/window/frame_times.h"
#include "app/window/pictures.h"
#include "app/window/window.h"

namespace ilf::app {

/// One brush stroke goes: window (callbacks) -> ui::studio (requests) -> editor (history) -> worker (plan, compile) ->
/// link (output core) and -> views -> textures. Everything here runs on the main thread; threads are the members' own.
class Studio {
public:
    static Result<std::unique_ptr<Studio>> start(const StudioOptions& options);
    ~Studio();
    /// Until the window is closed.
    int run();

private:
    Studio(StudioOptions options, std::vector<std::string> coreArguments, std::unique_ptr<Window> window,
           OpenedFile opened);

    void frame();
    void collect();  ///< takes what threads have finished
    void takeDone(Done done);
    void takeSeen(Seen seen);
    void takeNews(LinkNews news);
    void takeFrame();
    void postJob();
    ui::View view() const;
    void handle(const ui::Requests& requests);
    void say(const std::string& sentence, ui::Tone tone);
    bool mayClose();
    bool worthAPicture() const;  ///< everything the window shows is settled
    void keepFrameTimes() const;
    void showTitle();
    double now_s() const;
    int editsSinceTake() const;  ///< 0: what plays is what is painted

    // One for each request of ui/request.h.
    void on(const ui::EditRequest& request);
    void on(const ui::CommitGesture& request);
    void on(const ui::CancelGesture& request);
    void on(const ui::RunCommand& request);
    void on(const ui::OpenFile& request);
    void on(const ui::SaveFile& request);
    void on(const ui::ExportView& request);
    void on(const ui::OpenCamera& request);
    void on(const ui::SeekVideo& request);
    void on(const ui::SelectObject& request);
    void on(const ui::SelectFlood& request);
    void on(const ui::GoToHistory& request);
    void on(const ui::AcknowledgeFault& request);
    void on(const ui::LoadDepthMap& request);
    void on(const ui::UseRig& request);
    void on(const ui::SaveRig& request);
    void on(const ui::Measure& request);
    void on(const ui::StartMeasuring& request);
    void on(const ui::StoreMeasured& request);
    void on(const ui::Register& request);
    void on(const ui::ChooseRegisterWay& request);
    void on(const ui::PlaceCorner& request);
    void on(const ui::PlaceCross& request);
    void on(const ui::RemovePair& request);
    void on(const ui::ShowRegisterPicture& request);
    void on(const ui::SetBoard& request);
    void on(const ui::RemovePose& request);
    void on(const ui::PlaceTape& request);
    void on(const ui::TapeSays& request);
    void on(const ui::Recover& request);
    void on(const ui::LookForMarkers& request);

    void show(OpenedFile opened);  ///< another project altogether
    void measure();                ///< opens the page, or says why not
    void lendDevices();            ///< to the measurer, or takes them back, as it wants
    void useChosenRig();           ///< the one the studio was started with, as an edit like any other
    void registerCamera();         ///< opens the page, or says why not
    void tendRegistering();        ///< what it found, and which camera it wants
    void writeRegistration(const Registrar::ToWrite& found);
    void followRegions();  ///< tells the tracker what there is, and takes what it found
    ui::FollowView followView() const;
    bool followsOnShow() const;  ///< what is painted plays, and moves along with what is followed
    bool followsBehind() const;  ///< what plays does so, while edits wait to be put on show
    void placeShown();           ///< what follows where it is, where the live picture is seen
    void lookForBump();
    void takeBump();
    void followBump();
    bool withoutStrayed(Rig& rig) const;
    void setScene(Scene scene);
    void take();
    void forgetTake();
    void sendIfDue();
    void sendBehind();
    void save(const std::string& path);
    void grab();
    void edit(const Edit& edit);  ///< a whole gesture in one

    StudioOptions options_;
    std::unique_ptr<Window> window_;
    Editor editor_;
    ui::State ui_;
    Pictures pictures_;
    Keeper keeper_;
    CameraPort camera_;
    Selector selector_;
    Latency latency_;
    Measurer measurer_;
    bool lent_ = false;  ///< devices are asked from the output core, or lent already
    Registrar registrar_;
    std::string registeringCamera_;   ///< open for the page
    bool cameraBefore_ = false;       ///< one was open before the page was
    bool registered_ = false;         ///< by the page: its camera stays open, to be watched for bumps
    std::optional<BumpReport> bump_;  ///< the camera was moved
    Box<Registration> bumpQuiet_;     ///< the operator knows that it no longer holds
    Box<ProcamCalibration> strayed_;  ///< its camera was moved since, so that it measures no depth any more
    double bumpLookedAt_s_ = 0.0;
    TrackNews tracked_;              ///< the newest of the tracker
    std::uint64_t trackedFor_ = 0;   ///< serial of the document that it knows
    bool trackedLive_ = false;       ///< and whether it was promised pictures
    std::uint64_t postedMoves_ = 0;  ///< serial of the moves that were posted
    std::optional<Document> shown_;  ///< with what follows where it is; none: as it is painted
    std::vector<RegionMotion> shownMotions_;
    std::uint64_t shownSerial_ = 0, shownMoves_ = 0;  ///< of the document and the moves it was made of
    Latency lightLag_;                                ///< from a picture's arrival to its light
    bool lookingForMarkers_ = false;
    Image<std::uint8_t> liveFrame_;  ///< the newest that was shown
    std::optional<std::vector<ui::MarkerFound>> markers_;

    Done done_;  ///< the newest of the worker
    Seen seen_;  ///< the newest of the viewer
    FrameTimes times_;
    std::array<std::uint64_t, 3> viewsTaken_{};  ///< by Rung
    std::uint64_t postedSerial_ = 0;
    ui::Wants posted_;
    bool postedDragging_ = false;
    Clock::time_point startedAt_ = Clock::now();
    Clock::time_point changedAt_;  ///< when what is shown last changed
    std::uint64_t seenSerial_ = 0;

    devices::Status core_;
    std::string linkTrouble_;
    std::uint64_t faultsSeen_ = 0;
    std::uint64_t revision_ = 0;               ///< of the last program sent
    std::optional<std::uint64_t> takeSerial_;  ///< a take waits for the program of this serial
    std::uint64_t takeHold_ = 0;  ///< the safe light it may end: the one that was held when it was asked for
    Clock::time_point takeAt_;
    std::uint64_t sentHash_ = 0, sentSerial_ = 0;
    bool playAtStart_ = false;  ///< a project that was named at the start plays once the core is there
    std::shared_ptr<const Compiled> sent_;
    std::size_t takenRevision_ = 0;  ///< History::revision at the last take
    bool liveTake_ = false;
    bool ownShow_ = false;  ///< what plays was put on show here
    Document onShow_;       ///< and is of this, as it was painted
    bool closing_ = false;
    std::string title_;
    int quietFrames_ = 0;  ///< frames since anything happened: then the loop may wait

    Worker worker_;  // threads: after all they wake
    Tracker tracker_;
    BumpWatch bumpWatch_;
    Link link_;
};

}  // namespace ilf::app
