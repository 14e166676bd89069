// The steps of measuring a rig, as an operator goes through them: connect, measure, see, go on or do it again.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/document/wearer.h"

namespace ilf::devices {

enum class MeasureStep {
    projector,  ///< light after trigger
    dark,       ///< the photodiode without the laser
    light,      ///< laser through the lens, and whether the right lens moves
    powers,     ///< at rest, over the current and back
    waves,      ///< one period each of many
    drift,      ///< at rest once more: whether anything moved meanwhile
};
inline constexpr MeasureStep kLensSteps[] = {MeasureStep::dark, MeasureStep::light, MeasureStep::powers,
                                             MeasureStep::waves, MeasureStep::drift};

/// What the operator reads before a step.
struct StepWords {
    std::string title, connect, expect;
};
StepWords wordsOf(MeasureStep step, Eye eye);
/// False: nothing needs to be connected, switched or moved before it.
bool needsHands(MeasureStep step);

/// What came of a step. `measured` says the numbers, `advice` what would help where they are not good.
struct StepOutcome {
    bool good = false;
    std::string measured, advice;
    bool operator==(const StepOutcome&) const = default;
};

/// Pure: it knows nothing of devices. Each call that does not belong to the state is refused (false) and changes
/// nothing.
class MeasureWizard {
public:
    enum class State {
        connecting,  ///< the operator connects what the step needs
        measuring,
        judged,  ///< the step's outcome is shown
        done,    ///< every step was good
        ended,   ///< cancelled
    };
    explicit MeasureWizard(std::vector<MeasureStep> steps);

    State state() const { return state_; }
    /// None once it is done or ended.
    std::optional<MeasureStep> step() const;
    std::size_t number() const { return at_; }  ///< of the steps before this one
    const std::vector<MeasureStep>& steps() const { return steps_; }
    /// Of each step that was measured, the last.
    const std::vector<StepOutcome>& outcomes() const { return outcomes_; }

    bool connected();
    bool measured(StepOutcome outcome);
    /// Only after a good outcome.
    bool next();
    /// The same step again, from connecting on.
    bool retry();
    /// The step before; what was measured from there on no longer counts.
    bool back();
    bool cancel();

private:
    std::vector<MeasureStep> steps_;
    std::size_t at_ = 0;
    State state_;
    std::vector<StepOutcome> outcomes_;
};

}  // namespace ilf::devices
