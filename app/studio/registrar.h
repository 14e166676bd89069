// Registers the camera with the projector for the window: the wizard's states on the main thread, light and pictures on
// threads of their own.
#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "app/scan/scanner.h"
#include "app/studio/marks_show.h"
#include "ui/register_view.h"

namespace ilf::app {

/// What takes pictures while light is shown; tests put others in their place.
struct RegisterParts {
    std::function<Result<ScanOutcome>(const ScanOrder&, const devices::ScanWatch&, const std::stop_token&)> scan =
        &scanned;
    std::function<Result<LightCheck>(const ScanOrder&, const devices::ScanWatch&, const std::stop_token&)> light =
        &lightChecked;
    std::function<Result<PairedRegistration>(const ScanOrder&, const devices::ScanWatch&, const std::stop_token&)>
        board = &scannedBoard;
    std::function<Result<PosesOutcome>(const ScanOrder&, const Board&, std::vector<BoardView>, const std::string& name,
                                       const devices::ScanWatch&, const std::stop_token&)>
        pose = &scannedPose;
};

/// Whatever is begun here ends in steady white light with the lens at rest. While `shows()`, nobody else may send to
/// the output core; while `wantsCamera()` is empty, nobody else may have the camera open.
class Registrar {
public:
    /// `onNews` is called on other threads when `collect` has something.
    Registrar(std::filesystem::path runtimeDirectory, std::function<void()> onNews, RegisterParts parts = {});
    Registrar(const Registrar&) = delete;
    Registrar& operator=(const Registrar&) = delete;

    /// None: the page is closed.
    const std::optional<ui::RegisterView>& view() const { return view_; }
    /// The projector shows patterns or marks, or is about to.
    bool shows() const { return view_ && view_->patterns(); }
    /// The camera whose live picture the page shows; empty: none, it must be closed.
    std::string wantsCamera() const;

    /// Opens the page for this rig, whose core plays it with lenses at `rest`.
    void open(const Rig& rig, Dioptre rest, const std::string& camera);
    /// At once, or as soon as the light is steady again.
    void close();

    // Each does nothing where the state does not allow it.
    void chooseCamera(const std::string& id);
    void choose(ui::RegisterWay way);
    void scan(bool anyway);
    void checkLight();
    void findBoard();
    void scanPose();
    /// F12 as well: what is shown ends, nothing is kept.
    void cancel();
    void toggleMarks();
    void anotherPlace();
    void showPicture(ui::RegisterPicture what);
    void placeCorner(int corner, Point<CameraFrame> at);
    void placeCross(Point<CameraFrame> at);
    void removePair(std::size_t pair);
    void setBoard(const Board& board);
    void removePose(std::size_t pose);
    void toggleTape();
    void placeTape(Point<CameraFrame> at);
    /// The tape's length: depth and calibration are scaled to it.
    void tapeSays(Metre length);

    /// A frame of the camera that is wanted: RGB.
    void livePicture(const Image<std::uint8_t>& rgb);
    /// What can be accepted; empty: nothing.
    const Box<Registration>& found() const { return found_; }
    /// What was found shall go into the rig. Marks end; where the scene's picture is wanted, `toWrite` waits for frames
    /// under steady light, which the caller asks for.
    void accept(const ui::RegisterSetup& setup);
    /// What is empty stays as it is.
    struct ToWrite {
        Box<Registration> registration;
        Box<ProcamCalibration> calibration;
        Image<std::uint8_t> picture;  ///< under white light; grey or RGB
        Box<MeasuredDepth> depth;     ///< of the picture
    };
    /// Once, when all is there.
    std::optional<ToWrite> toWrite();
    /// It went into the rig, which is this one now.
    void accepted(const Rig& rig);

    /// Takes what other threads have done; true if there was anything.
    bool collect();

private:
    ScanOrder order() const;
    /// The camera; an emulated one that nobody told about a board sees the `pose`-th while one is asked for.
    std::string cameraAt(int pose) const;
    /// `withCamera`: the work opens the camera itself, so that nobody else may have it.
    void begin(ScanWork work, bool withCamera = true);
    void take(const ScanOutcome& outcome);
    void take(const LightCheck& check);
    void take(const PairedRegistration& board);
    void take(const PosesOutcome& poses);
    void looked(const ScanOutcome& outcome);
    void showPoses(const Box<Calibrated>& found, std::string refused);
    void showDepth();
    void measureTape();
    void foundByHand(const Result<PairedRegistration>& found);
    void lightOf(const AmbientCheck& ambient, Second exposure);
    void fitPairs();
    void showMark();
    void hideMarks();
    void showFound(Box<Registration> registration, std::string note);
    void forgetLooks();
    void forgetFound();
    void refuse(const std::string& why);

    std::filesystem::path directory_;
    std::function<void()> onNews_;
    RegisterParts parts_;

    std::optional<ui::RegisterView> view_;
    Rig rig_;
    Dioptre rest_;
    bool closing_ = false;
    bool lent_ = false;    ///< the camera, to what is at work
    bool placed_ = false;  ///< corners were put inside this camera's picture
    Image<std::uint8_t> live_, quality_, depthShown_, spreadShown_;
    Image<std::uint8_t> white_;  ///< of the scan that found something
    int steadyFrames_ = 0;       ///< live ones since the last light of ours
    struct Accepting {
        ui::RegisterSetup setup;
        std::chrono::steady_clock::time_point since;  ///< when the last frame came, or it was asked for
    };
    std::optional<Accepting> accepting_;
    Box<Registration> found_;
    std::vector<BoardView> poses_;
    int posesScanned_ = 0;
    std::optional<MeasuredDepth> depth_;  ///< of what was found
    Box<ProcamCalibration> scaled_;       ///< by the tape that `depth_` follows; empty: the rig's own holds
    std::vector<Point<ProjectorFrame>> places_;
    std::size_t place_ = 0;

    std::unique_ptr<MarksShow> marks_;
    std::unique_ptr<Scanner> scanner_;
};

}  // namespace ilf::app
