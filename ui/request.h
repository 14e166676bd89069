// What panels ask for: edits, commands, and the few things that need more than an edit.
#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/document/edit.h"
#include "ui/commands.h"
#include "ui/measure_view.h"
#include "ui/register_view.h"

namespace ilf::ui {

/// An edit as part of a gesture (`preview`) or as its end (`commit`, one undo step).
struct EditRequest {
    enum class When { preview, commit };
    When when = When::commit;
    Edit edit;
};
/// The gesture is over and its previews stand: one undo step.
struct CommitGesture {
    std::string label;
};
/// The gesture is over and leaves nothing.
struct CancelGesture {};
/// A command from menu, key or button.
struct RunCommand {
    Command command;
};
/// Open this project, picture or video (by content, not by name); `asScene` keeps the regions of the current project.
struct OpenFile {
    std::string path;
    bool asScene = false;
};
struct SaveFile {
    std::string path;
};
struct ExportView {
    std::string path;
};
struct OpenCamera {
    std::string id;
};
struct SeekVideo {
    double position = 0.0;
};
/// Click-select in the background; the result arrives as a SetMask edit of `region`.
struct SelectObject {
    RegionId region;
    PixelRect<CameraFrame> box;
};
struct SelectFlood {
    RegionId region;
    Point<CameraFrame> at;
    double tolerance = 0.1;  ///< by colour: of full scale; by depth: times the usual
    bool byDepth = false;    ///< the surface under the cursor, from the depth map
};
/// Jump in the undo list.
struct GoToHistory {
    std::size_t step = 0;
};
struct AcknowledgeFault {};
/// A PNG of 16 bits, PFM or EXR, as the camera sees it.
struct LoadDepthMap {
    std::string path;
    std::optional<Metre> metresPerUnit;  ///< absent: guessed, and said
    std::string intrinsics;              ///< file of the camera's; empty: the picture's field of view
};
/// Plan for and play on another rig: "simulated", "emulated", or a rig's file. The output core is stopped in safe light
/// and started anew.
struct UseRig {
    std::string rig;
};
struct SaveRig {
    std::string path;
};
/// Goes through the wizard that measures a rig; what does not belong to its state is not done.
struct Measure {
    enum class Step {
        open,    ///< the page, with what it asks before the first step
        go,      ///< what the step needs is connected
        next,    ///< after a good outcome
        again,   ///< the same step
        back,    ///< the step before
        cancel,  ///< the lenses go to rest and nothing is written; also closes the page
        use,     ///< plan the project with what was stored
    } step = Step::open;
};
struct StartMeasuring {
    MeasureSetup setup;
};
/// Once every step was good.
struct StoreMeasured {
    std::string path;
};
/// Goes through the wizard that registers the camera with the projector; what does not belong to its state is not done.
struct Register {
    enum class Step {
        open,     ///< the page, with the live picture
        light,    ///< is this room's light low enough, and does the camera see this projector?
        scan,     ///< take all pictures, decode, check
        board,    ///< the same with a chessboard that the projector shows
        pose,     ///< a scan of a printed chessboard as it is held now
        cancel,   ///< what is done now ends in steady white light
        marks,    ///< the projector shows its frame, or a numbered cross, or no longer
        another,  ///< the cross goes to another place
        tape,     ///< clicks on the picture are a tape measure's ends, or no longer
        accept,   ///< the registration, or calibration, goes into the rig
        close,
        shift,  ///< the camera was bumped: picture, regions and map move along
        quiet,  ///< it was, and the operator knows
    } step = Step::open;
    RegisterSetup setup{};
};
struct ChooseRegisterWay {
    RegisterWay way = RegisterWay::scan;
};
/// Where a corner of the raster is seen: 0 upper left, then clockwise.
struct PlaceCorner {
    int corner = 0;
    Point<CameraFrame> at;
};
/// Where the cross is seen that is shown now.
struct PlaceCross {
    Point<CameraFrame> at;
};
struct RemovePair {
    std::size_t pair = 0;
};
struct ShowRegisterPicture {
    RegisterPicture what = RegisterPicture::live;
};
/// What is printed; poses of another board are forgotten.
struct SetBoard {
    Board board;
};
struct RemovePose {
    std::size_t pose = 0;
};
/// One end of a tape measure in the camera's picture; a third click begins anew.
struct PlaceTape {
    Point<CameraFrame> at;
};
/// What the tape says between its two ends.
struct TapeSays {
    Metre length;
};
/// Which printed markers are in the scene's picture and the live one: what FollowView::markers will say.
struct LookForMarkers {};
/// Answer to the recovery question at start.
struct Recover {
    enum class Choice { recover, openSaved, skip } choice = Choice::recover;
};
using Request =
    std::variant<EditRequest, CommitGesture, CancelGesture, RunCommand, OpenFile, SaveFile, ExportView, OpenCamera,
                 SeekVideo, SelectObject, SelectFlood, GoToHistory, AcknowledgeFault, LoadDepthMap, UseRig, SaveRig,
                 Measure, StartMeasuring, StoreMeasured, Register, ChooseRegisterWay, PlaceCorner, PlaceCross,
                 RemovePair, ShowRegisterPicture, SetBoard, RemovePose, PlaceTape, TapeSays, Recover, LookForMarkers>;
using Requests = std::vector<Request>;

}  // namespace ilf::ui
