// What the operator changes that is not the document: tool, brush, selection, view, panel sizes, text being typed.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "core/document/document.h"
#include "core/document/stroke.h"
#include "core/perceived/perceived.h"
#include "ui/commands.h"
#include "ui/layout.h"
#include "ui/measure_view.h"
#include "ui/register_view.h"

namespace ilf::ui {

struct PredictedRegion;
enum class Tool { move, brush, erase, rectangle, ellipse, polygon, lasso, select, flood };
enum class ViewMode { scene, perceived, light, compare };
enum class Page { selected, wearer, seam, light, rig, scene, history };
enum class Hint { brush, distance, take };
enum class Tone { note, warning, error };

/// A sentence shown until it fades (notes) or is dismissed (errors).
struct Toast {
    std::string text;
    Tone tone = Tone::note;
    double since_s = 0.0;
};

/// What is going on under the pointer on the canvas.
struct CanvasGesture {
    enum class Kind {
        none,
        pan,
        paint,
        drawShape,   ///< rectangle or ellipse from `start` to `now`
        drawLasso,   ///< `points`
        drawBox,     ///< object select
        moveVertex,  ///< `index` of the selected region's outline
        moveAnchor,  ///< `index` of the selected region's plane
        moveAxis,    ///< `index` 0 left, 1 right optical centre
        distance,    ///< scrubs the distance of `region`
        divider,     ///< of the compare view
    };
    Kind kind = Kind::none;
    RegionId region;
    std::size_t index = 0;
    Point<CameraFrame> start, now;
    Point<WidgetFrame> startAt, lastAt;
    std::vector<Point<CameraFrame>> points;
    std::optional<double> carry;  ///< of spacedDabs
    Distance original;            ///< of `region` when a distance or anchor drag began
    int button = 0;               ///< 0 left, 1 right, 2 middle
    bool edited = false;          ///< a preview was sent: it must be committed or cancelled
};

/// The text of the one field that is being typed in, or scrubbed.
struct FieldState {
    unsigned editing = 0;  ///< ImGui id; 0: none
    bool justOpened = false;
    std::string text;
    unsigned scrubbing = 0;
    double scrubbed = 0.0;
    unsigned refused = 0;  ///< the field whose last text was refused
    std::string refusal;
};

struct FileDialog {
    enum class Purpose {
        open,
        openScene,
        saveAs,
        exportView,
        depthMap,
        intrinsics,
        openRig,
        saveRig,
        storeWaves
    } purpose = Purpose::open;
    std::string folder;
    std::string name;
    struct Entry {
        std::string name;
        bool folder = false;
        std::uintmax_t bytes = 0;
    };
    std::vector<Entry> entries;  ///< of `folder`, read when it was entered
    std::string problem;         ///< why the folder could not be read
    bool confirmOverwrite = false;
};

/// What was found after a crash, for the recovery question.
struct RecoveryQuestion {
    std::string what;             ///< "\"Museum\", painted until 14:02"
    bool savedFileExists = true;  ///< whether "open what was saved" is an answer
};

struct State {
    Tool tool = Tool::brush;
    Brush brush{40.0, 0.8, 1.0};
    Brush eraser{40.0, 0.8, 1.0};
    bool protectOthers = false;
    double floodTolerance = 0.1;
    bool floodByDepth = false;
    Box<DepthMap> countedDepth;     ///< whose holes are known
    double depthHoles = 0.0;        ///< share of its pixels
    double surfaceTolerance = 1.0;  ///< of the flood by depth, times the bend that ends a surface
    std::string intrinsics;         ///< file that is loaded along with a depth map; empty: none
    Metre markerSide = 50.0_mm;     ///< of the printed marker a plane is laid through
    int markerId = 0;
    RegionId markerFor;  ///< it will follow the marker that is being looked for
    RegionId selected;

    ViewMode mode = ViewMode::scene;
    Eye eye = Eye::left;
    int slot = 0;
    double divider = 0.5;  ///< of the compare view, share of the canvas
    ViewRequest seeing;    ///< how perceived views are looked at: gaze, attention, colour, rim; the app sets the rest
    bool placingGaze = false;  ///< the next click on the picture is where the eye is turned
    bool debugOpen = false;
    bool seamMarks = true;
    bool fitted = true;
    double zoom = 1.0;          ///< window pixels per picture pixel; follows the window while `fitted`
    Point<CameraFrame> centre;  ///< shown in the middle of the canvas

    PanelSizes panels;
    Page page = Page::selected;
    std::set<Hint> hintsUsed;

    bool panHeld = false, plainHeld = false, overlayHidden = false, distanceHeld = false, distanceDragged = false;
    std::optional<Point<CameraFrame>> cursor;     ///< while the pointer is over the picture
    std::optional<Point<CameraFrame>> lastPoint;  ///< where the last stroke ended: Shift-click draws a line from here
    std::vector<Point<CameraFrame>> polygon;      ///< being drawn
    CanvasGesture gesture;

    FieldState field;
    std::shared_ptr<const PredictedRegion> predicted;  ///< of the selected region, see ui/prediction_card.h
    bool whyOpen = false;                              ///< where its +- comes from is shown
    bool focusDistance = false;                        ///< the distance field takes the keyboard in the next frame
    RegionId renaming;
    std::string nameText;
    bool nameJustOpened = false;

    std::optional<FileDialog> fileDialog;
    std::optional<RecoveryQuestion> recovery;
    MeasureSetup measure;  ///< being typed
    RegisterSetup registering;
    std::string registerScene;  ///< being typed: words for the emulated scene
    int registerCorner = -1;    ///< being dragged
    std::string rigWanted;      ///< asked for while something plays; waits for the operator's word
    bool shortcutsOpen = false, aboutOpen = false, popupsOpen = false;
    std::vector<Toast> toasts;
};

/// Shows a sentence to the operator. The same sentence twice is shown once.
void say(State& state, std::string text, Tone tone, double time_s);

/// What is kept between sessions: panel sizes, page, brushes, hints used. One `key value` a line.
std::string layoutText(const State& state);
/// `state` with what `text` says. A text that is not understood, in whole or in part, leaves the defaults: a corrupt
/// file can not stop the start.
State withLayout(State state, const std::string& text);

}  // namespace ilf::ui
