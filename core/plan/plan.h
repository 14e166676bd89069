// The plan: which powers the lens must reach, when each region is lit, and what cannot be done and why.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/base/quantity.h"
#include "core/base/result.h"
#include "core/document/document.h"
#include "core/lens/waveform.h"
#include "core/optics/eye.h"

namespace ilf {

/// One surface that takes part in the plan.
struct PlanObject {
    RegionId id;
    std::string name;
    Look look = Look::focus;
    std::optional<Dioptre> strength;
    Metre nearest, farthest;
    bool operator==(const PlanObject&) const = default;
};

/// All that a plan depends on. Two equal inputs have the same plan: an edit that cannot change it costs nothing.
struct PlanInput {
    std::vector<PlanObject> objects;  ///< topmost first, background last
    EyeOptics eye;
    bool camera = false;  ///< observer is a camera: each focused object gets its own level
    Rig rig;
    Dioptre alpha = 0.2_D;
    bool operator==(const PlanInput&) const = default;
};

/// What a document asks of the planner; regions that cover nothing are left out.
PlanInput planInput(const Document& document);

enum class LevelKind { focus, blur };

/// A power at which some regions are lit, and the slots whose light serves it.
struct Level {
    LevelKind kind = LevelKind::focus;
    Dioptre power;
    std::vector<int> slots;  ///< sorted
    double weight = 1.0;     ///< 0..1 of full light in each of its slots, so that all levels give equal luminance
    Dioptre rmsError;        ///< of the power over its lit slots
    bool operator==(const Level&) const = default;
};

/// One exposure. Times are of the light itself, from the start of the sweep; the trigger leaves projectorDelay earlier.
struct Slot {
    int index = 0;
    Second start, duration;
    std::optional<int> level;  ///< index into Plan::levels; none: dark
    Dioptre power;             ///< mean lens power while it is lit
    bool operator==(const Slot&) const = default;
};

/// What the plan means for one region.
struct RegionPlan {
    RegionId id;
    std::string name;
    Look look = Look::focus;
    Metre nearest, farthest;
    std::optional<Dioptre> pMin;  ///< least power that blurs its nearest point; none when always blurred
    std::optional<int> level;     ///< none for neutral
    Dioptre levelPower;
    Metre blurDiameter;           ///< at its nearest point, relaxed eye: the least that can be reached
    Metre blurDiameterAttending;  ///< eye accommodated to the nearest focused object
    double scale = 1.0;           ///< apparent magnification against the focus level
    bool alreadyBlurred = false;  ///< beyond the window of sharp vision even at rest
    std::string problem;          ///< empty, or one sentence: what cannot be done and why
    std::string help;             ///< what would help
    bool operator==(const RegionPlan&) const = default;
};

struct Plan {
    PlanInput input;
    Waveform waveform;
    Dioptre farOffset;          ///< K_f
    std::optional<Dioptre> pS;  ///< P_s, the largest P_min of the regions to blur; none: nothing to blur
    Dioptre alpha;
    std::optional<RegionId> driver;   ///< the region whose P_min is P_s
    Dioptre focusPower;               ///< the focus level nearest the prescription offset
    std::vector<Level> levels;        ///< focus levels first, each kind ascending by power
    std::vector<Slot> slots;          ///< slotsPerSweep of them; a still lens has them all at one level
    std::vector<RegionPlan> regions;  ///< as in the input
    std::vector<std::string> warnings;
    double light = 1.0;  ///< luminance of every region as a share of steady full light
    bool operator==(const Plan&) const = default;

    bool sweeps() const { return !waveform.still(); }
};

/// Plans. The sweep runs from the lowest focus level to P_s + alpha, or farther where a strength or a focus level asks
/// for it. Refusals (Fault::unsafe): a rest power beyond the lens, a slot rate that is no multiple of the sweep rate,
/// an end of the sweep that the sine cannot hold within its error budget for even one slot, and for a camera any
/// focused object's level it cannot hold. What a single region asks in vain is no refusal: it gets `problem` and
/// `help`, and the level that comes nearest. "Already blurred" is judged on the far side only: blur on the near side
/// rests on an estimate of what the eye cannot accommodate away. Only a level at the end of the sweep may have a slot
/// below its border of blur (with alpha near 0), and then it has a `problem`.
Result<Plan> plan(const PlanInput& input);

/// The stand-in scheduler's budget: slots serve a level while their rms power error stays below it.
inline constexpr Dioptre kFocusErrorBudget = 0.1_D;
/// For blur: this share of the step above rest, at least the focus budget.
inline constexpr double kBlurErrorShare = 0.1;

}  // namespace ilf
