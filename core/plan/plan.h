// The plan: which powers the lens must reach, when each region is lit, and what cannot be done and why.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/base/quantity.h"
#include "core/base/result.h"
#include "core/document/document.h"
#include "core/lens/calibration.h"
#include "core/lens/waveform.h"
#include "core/optics/eye.h"

namespace ilf {

/// One surface that takes part in the plan.
struct PlanObject {
    RegionId id;
    std::string name;
    Look look = Look::focus;
    std::optional<Dioptre> strength;
    Metre nearest, farthest;  ///< with its uncertainty taken off and added: see `distanceRange`
    Metre sigma = 0.0_m;      ///< of its distance, one standard deviation; 0: not known
    bool operator==(const PlanObject&) const = default;
};

/// All that a plan depends on. Two equal inputs have the same plan: an edit that cannot change it costs nothing.
struct PlanInput {
    std::vector<PlanObject> objects;  ///< topmost first, background last
    EyeOptics eye;
    bool camera = false;     ///< observer is a camera: each focused object gets its own level
    double ageYears = 28.0;  ///< of the wearer: gives the pupil that flicker is judged with
    Rig rig;
    Dioptre alpha = 0.2_D;
    std::shared_ptr<const LensCalibration> lens;  ///< none: a lens that follows a sine exactly
    bool operator==(const PlanInput&) const = default;
};

/// What a document asks of the planner; regions that cover nothing are left out.
PlanInput planInput(const Document& document, std::shared_ptr<const LensCalibration> lens = nullptr);

enum class LevelKind { focus, blur };

/// A power at which some regions are lit, and the slots whose light serves it.
struct Level {
    LevelKind kind = LevelKind::focus;
    Dioptre power;
    std::vector<int> slots;  ///< sorted
    double exposure = 0.0;   ///< slots' worth of full light; the same for all levels, so that all are equally bright
    Dioptre rmsError;        ///< of the predicted power over its light
    Dioptre budget;          ///< what the rms error was allowed to be
    bool operator==(const Level&) const = default;
};

/// Light of one level in one slot.
struct LevelLight {
    int level = 0;        ///< index into Plan::levels
    double weight = 1.0;  ///< 0..1 of full light
    bool operator==(const LevelLight&) const = default;
};

/// One exposure. Times are of the light itself, from the start of the sweep; the trigger leaves projectorDelay earlier.
/// The scene of a slot is that of its middle, `start + duration / 2`: moving regions are drawn where they are then.
struct Slot {
    int index = 0;
    Second start, duration;
    std::vector<LevelLight>
        lit;           ///< empty: dark. Levels lie on different pixels, so one slot can serve several of one kind
    Dioptre power;     ///< mean lens power while it is lit
    Dioptre rmsError;  ///< of the power within this slot, from its first level; 0 in the dark
    bool operator==(const Slot&) const = default;

    Second middle() const { return start + 0.5 * duration; }
    /// The level it serves, the first if several; none: dark.
    std::optional<int> level() const { return lit.empty() ? std::nullopt : std::optional(lit.front().level); }
    /// Light it gives as a share of the whole sweep's steady light.
    double luminance(Hertz sweepRate) const { return lit.empty() ? 0.0 : lit.front().weight * (duration * sweepRate); }
};

/// What the plan means for one region.
struct RegionPlan {
    RegionId id;
    std::string name;
    Look look = Look::focus;
    Metre nearest, farthest;
    Metre sigma = 0.0_m;          ///< of its distance, one standard deviation; 0: not known
    std::optional<Dioptre> pMin;  ///< least power that blurs its nearest point; none when always blurred
    std::optional<int> level;     ///< none for neutral
    Dioptre levelPower;
    Metre blurDiameter;           ///< at its nearest point, relaxed eye: the least that can be reached
    Metre blurDiameterFarthest;   ///< at its farthest point: the most, where the surface is slanted or deep
    Metre blurDiameterAttending;  ///< eye accommodated to the nearest focused object
    double scale = 1.0;           ///< apparent magnification against the focus level
    bool alreadyBlurred = false;  ///< beyond the window of sharp vision even at rest
    std::string problem;          ///< empty, or one sentence: what cannot be done and why
    std::string help;             ///< what would help
    bool operator==(const RegionPlan&) const = default;
};

/// What a plan took to make: what cannot have changed is taken over from the plan before.
struct PlanWork {
    std::uint64_t plans = 0, wavesChosen = 0, wavesKept = 0, schedulesMade = 0, schedulesKept = 0;
};

struct PlanParts;  // core/plan/parts.h

struct Plan {
    PlanInput input;
    Waveform waveform;
    Dioptre farOffset;          ///< K_f
    std::optional<Dioptre> pS;  ///< P_s, the largest P_min of the regions to blur; none: nothing to blur
    Dioptre alpha;              ///< less than asked where the lens does not reach farther (then there is a warning)
    std::optional<RegionId> driver;     ///< the region whose P_min is P_s
    Dioptre focusPower;                 ///< the focus level nearest the prescription offset
    std::vector<Level> levels;          ///< focus levels first, each kind ascending by power
    std::vector<Slot> slots;            ///< slotsPerSweep of them; a still lens has them all at one level
    std::vector<RegionPlan> regions;    ///< as in the input
    std::vector<std::string> warnings;  ///< what is not as asked
    double light = 1.0;                 ///< luminance of every region as a share of steady full light
    /// A shaped wave would be played if one for these levels had been learnt; empty: nothing is missing.
    std::vector<Dioptre> unlearnt;
    /// How it was made, not what it is; no part of ==.
    PlanWork work;
    std::shared_ptr<const PlanParts> parts;

    bool sweeps() const { return !waveform.still(); }
    bool operator==(const Plan& o) const;
};

/// Plans. The sweep runs from the lowest focus level to P_s + alpha, or farther where a strength or a focus level asks
/// for it. Where the lens does not reach that, alpha is relaxed, with a warning. Refusals (Fault::unsafe): a rest power
/// beyond the lens, a slot rate that is no multiple of the sweep rate, slots the projector cannot show, no wave that
/// reaches P_s (with the largest that is reachable), an end of the sweep that the wave cannot hold within its error
/// budget for even one slot, and for a camera any focused object's level it cannot hold. What a single region asks in
/// vain is no refusal: it gets `problem` and `help`, and the level that comes nearest. "Already blurred" is judged on
/// the far side only: blur on the near side rests on an estimate of what the eye cannot accommodate away. Only a level
/// at the end of the sweep may have a slot below its border of blur (with alpha near 0), and then it has a `problem`.
/// With `previous`, waves and schedules that cannot have changed are taken from it; the result is the same (a law).
/// `unlearnt` is told, also with a refusal, for which levels a shaped wave was asked for and missing.
Result<Plan> plan(const PlanInput& input, const Plan* previous = nullptr, std::vector<Dioptre>* unlearnt = nullptr);

}  // namespace ilf
