#include "devices/measure/wizard.h"

#include <utility>

namespace ilf::devices {

StepWords wordsOf(MeasureStep step, Eye eye) {
    const std::string side = eye == Eye::left ? "left" : "right", output = eye == Eye::left ? "AO0" : "AO1";
    switch (step) {
    case MeasureStep::projector:
        return {"Delay of the projector",
                "The projector's TRIG_OUT_2 to AI0, and the photodiode to AI1, in the projector's light. The projector "
                "flashes once after each trigger.",
                "Flashes of light that come after each trigger by the same time, a millisecond or less."};
    case MeasureStep::dark:
        return {"Dark",
                output + " to AI0 as well as to its amplifier, and the photodiode to AI1, behind the " + side +
                    " lens's middle. Laser off, room dark.",
                "A small, steady voltage."};
    case MeasureStep::light:
        return {"Light through the lens", "Laser on, through the " + side + " lens onto the photodiode.",
                "Between 0.1 and 9 V more than in the dark, and a lens that moves the light when it is driven."};
    case MeasureStep::powers:
        return {"Powers at rest", "Nothing to change. Do not touch the set-up from now on.",
                "Light that follows the current all the way up and down, and the known powers where they should be."};
    case MeasureStep::waves:
        return {"Waves", "Nothing to change.", "Waves that repeat themselves from sweep to sweep."};
    case MeasureStep::drift:
        return {"Drift", "Nothing to change.", "The light at rest is as it was."};
    }
    return {};
}

bool needsHands(MeasureStep step) {
    return step == MeasureStep::projector || step == MeasureStep::dark || step == MeasureStep::light;
}

MeasureWizard::MeasureWizard(std::vector<MeasureStep> steps)
    : steps_(std::move(steps)), state_(steps_.empty() ? State::done : State::connecting) {}

std::optional<MeasureStep> MeasureWizard::step() const {
    if (state_ == State::done || state_ == State::ended) return std::nullopt;
    return steps_[at_];
}

bool MeasureWizard::connected() {
    if (state_ != State::connecting) return false;
    state_ = State::measuring;
    return true;
}

bool MeasureWizard::measured(StepOutcome outcome) {
    if (state_ != State::measuring) return false;
    outcomes_.resize(at_);
    outcomes_.push_back(std::move(outcome));
    state_ = State::judged;
    return true;
}

bool MeasureWizard::next() {
    if (state_ != State::judged || !outcomes_.back().good) return false;
    ++at_;
    state_ = at_ == steps_.size() ? State::done : State::connecting;
    return true;
}

bool MeasureWizard::retry() {
    if (state_ != State::judged) return false;
    outcomes_.pop_back();
    state_ = State::connecting;
    return true;
}

bool MeasureWizard::back() {
    if ((state_ != State::judged && state_ != State::connecting) || at_ == 0) return false;
    --at_;
    outcomes_.resize(at_);
    state_ = State::connecting;
    return true;
}

bool MeasureWizard::cancel() {
    if (state_ == State::done || state_ == State::ended) return false;
    state_ = State::ended;
    return true;
}

}  // namespace ilf::devices
