// Everything a panel may read in one frame: documents, plans, pictures and states, all values or read-only references.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/compile/compile.h"
#include "core/document/document.h"
#include "core/perceived/seam_border.h"
#include "core/perceived/seam_profile.h"
#include "core/perceived/view_engine.h"
#include "core/plan/plan.h"
#include "core/plan/report.h"
#include "ui/follow_view.h"
#include "ui/measure_view.h"
#include "ui/register_view.h"

namespace ilf::ui {

/// A GL texture as ImGui wants it, with its size in texels. 0: not there yet.
struct Texture {
    std::uintptr_t id = 0;
    Size size;
};

enum class Light {
    unknown,  ///< no core: what the room shows is not known to the studio
    steady,   ///< uniform white, lens at rest: safe light
    slotted,  ///< a program plays
};

/// What the output core last said. `simulated` is shown wherever its figures are.
enum class DeviceHealth : std::uint8_t { well, absent, unplugged, wrongMode, silent };

/// One device of the rig.
struct Device {
    std::string what;  ///< "projector", "display", "lenses"
    DeviceHealth health = DeviceHealth::absent;
    std::string name;  ///< with its place
    std::string line;  ///< what it does, or what is wrong and what would help
};

struct CoreStatus {
    /// How far what is played is from where it belongs.
    struct Timing {
        bool locked = false;
        Second phase, jitter;
        double driftPpm = 0.0;
        std::uint64_t missedTriggers = 0;
    };

    bool connected = false;
    bool simulated = true;
    bool emulated = false;  ///< the drivers of real devices over emulated cables; also simulated
    Light light = Light::unknown;
    std::uint64_t revisionPlayed = 0;
    std::uint64_t revisionSent = 0;
    std::uint64_t swaps = 0;
    std::uint64_t droppedUpdates = 0;
    double strokeToSwap_ms = 0.0;  ///< of the last program taken
    std::string projector, lens;   ///< one line each: name and state
    bool projectorWell = false, lensWell = false;
    std::string lastFault;  ///< stays until acknowledged
    bool faultSeen = true;
    std::optional<Timing> timing;             ///< none: nothing is measured
    std::optional<double> lensTemperature_C;  ///< none: nobody measures it
    std::vector<Device> devices;              ///< empty: projector and lens lines say all there is
    std::vector<std::string> limits;          ///< what the core may not do on this machine, one sentence each
};

struct CameraStatus {
    bool open = false;
    std::string name;
    double frameAge_s = 0.0;
    bool frozen = false;  ///< no new frame for a second, or the same one again and again
    bool live = false;    ///< the live picture goes on beneath the frozen one
    bool locked = false;  ///< exposure and white balance locked
    bool isVideoFile = false;
    double videoPosition = 0.0;  ///< 0..1
};

/// What the worker last worked out. May be one edit behind what is painted; `forCurrent` says whether it is.
struct Computed {
    bool forCurrent = false;
    std::optional<Plan> plan;
    std::string planError;  ///< the sentence, when there is no plan
    const Compiled* compiled = nullptr;
    std::optional<SeamProfile> seam;
    std::shared_ptr<const std::vector<BorderSeam>> seams;  ///< along whole borders, worst first; none until at rest
    std::shared_ptr<const PlanReport> report;              ///< none before the first plan
    double plan_ms = 0.0, compile_ms = 0.0, view_ms = 0.0;
    std::string viewRung;    ///< "while dragging", "at rest", "refined": how carefully the perceived view was made
    double viewScale = 1.0;  ///< its pixels per picture pixel: below 1 for pictures wider than views are computed
    std::optional<ViewCounters> viewCounters;  ///< of the eye on screen
    CompileCounters counters;
    /// The window's last frame: processor time of its own work, and what the swap took (software GL draws in it).
    double frameOwn_ms = 0.0, frameSwap_ms = 0.0;
};

struct RecentFile {
    std::string path, name;
};

struct View {
    const Document& document;
    bool previewing = false;                   ///< a gesture is going on
    std::string undoLabel{}, redoLabel{};      ///< empty: nothing to undo
    std::vector<std::string> historyLabels{};  ///< oldest first
    std::size_t historyPosition = 0;

    Texture scene{};                     ///< the frozen picture
    Texture live{};                      ///< the live camera, when it goes on beneath
    Texture overlay{};                   ///< RGBA of ui/overlay.h, uploaded tile by tile
    std::array<Texture, 2> perceived{};  ///< left, right
    Texture plain{};                     ///< steady light at the same scale, for compare
    std::vector<Texture> lights{};       ///< one for each image of the program

    Computed computed{};
    CoreStatus core{};
    CameraStatus camera{};
    bool liveTake = false;   ///< every change is sent while painting
    int editsSinceTake = 0;  ///< 0: what plays is what is painted
    std::string fileName{};  ///< empty: untitled
    bool unsaved = false;
    double savedAgo_s = -1.0;  ///< negative: never
    std::vector<RecentFile> recent{};
    std::vector<std::string> cameras{};         ///< stable ids
    bool busySelecting = false;                 ///< click-select is at work
    std::optional<MeasureView> measuring{};     ///< present: a rig is measured, or about to be
    std::optional<RegisterView> registering{};  ///< present: a camera is registered with the projector
    Texture registerPicture{};                  ///< of its picture
    double time_s = 0.0;                        ///< monotonic
    double scale = 1.0;                         ///< content scale of the display
    std::optional<BumpView> bump{};             ///< present: say so
    FollowView follow{};
};

}  // namespace ilf::ui
