// How a lens on a lens driver comes to rest, whatever happened before.
#include <utility>

#include "devices/lens_driver/lens_driver.h"

namespace ilf::devices {

using lens_driver::Mode;

namespace {

// On the way to rest a silent driver may cost no more than this.
constexpr Milliseconds kAnswerAtRest{15};
// 40 ms of steps: inside 100 ms even if answers run out of time.
constexpr int kSteps = 8;
constexpr Milliseconds kStep{5};

}  // namespace

tl::unexpected<Error> LensDriver::faulted(Error error) {
    if (!fault_) {
        fault_ = error;
        mode_.reset();  // it may have been changed by whatever went wrong
        rest();
    }
    return tl::unexpected(std::move(error));
}

Result<void> LensDriver::rest() {
    // What the driver still has to say must not be taken for an answer, nor keep the lens from its rest.
    discarded(Milliseconds(0));
    // Twice, since a single disturbance of the line is no reason to leave the resting power; then by current.
    auto rested = facts_.powers ? restedByPower() : restedByCurrent();
    if (!rested && facts_.powers) rested = restedByPower();
    if (!rested) rested = restedByCurrent();
    return rested;
}

/// What current a focal power takes is the driver's own affair, so only reading it back tells whether it is allowed. If
/// not, the lens rests by current from then on.
Result<void> LensDriver::currentAllowed() {
    const auto code = asked(lens_driver::readCurrent(), kAnswerAtRest).and_then(lens_driver::codeFrom);
    if (!code) return tl::unexpected(code.error());
    if (allowed(lens_driver::currentOf(*code, facts_.most))) return {};
    facts_.powers.reset();
    return fail(Fault::unsafe, "The resting power of the " + setup_.name +
                                   " takes more current than the rig allows. Choose a smaller one, or check the "
                                   "rig's limit.");
}

Result<void> LensDriver::restedByPower() {
    if (mode_ != Mode::focalPower) {
        if (auto still = restedByCurrent(); !still) return still;
        mode_.reset();
        auto powers = asked(lens_driver::setMode(Mode::focalPower), kAnswerAtRest);
        if (!powers) return tl::unexpected(std::move(powers.error()));
        mode_ = Mode::focalPower;
        power_ = *setup_.restPower;
    }
    const Dioptre from = power_, target = *setup_.restPower;
    for (int step = from == target ? kSteps : 1; step <= kSteps; ++step) {
        auto sent = sendPower(from + (static_cast<double>(step) / kSteps) * (target - from));
        if (sent) sent = currentAllowed();
        if (!sent) return sent;
        if (step < kSteps) clock_.wait(kStep);
    }
    return {};
}

Result<void> LensDriver::restedByCurrent() {
    if (mode_ != Mode::current) {
        // Lost answers are common just after a disturbance; the switch itself may have happened.
        mode_.reset();
        auto back = asked(lens_driver::setMode(Mode::current), kAnswerAtRest);
        if (!back) back = asked(lens_driver::setMode(Mode::current), kAnswerAtRest);
        if (!back) {
            told(lens_driver::setCurrent(0));
            return tl::unexpected(std::move(back.error()));
        }
        mode_ = Mode::current;
    }
    // Where in a sine's swing the lens is, is not known: the ramp starts at the last current told.
    const Ampere from = facts_.most > Ampere() ? lens_driver::currentOf(code_, facts_.most) : Ampere();
    const Ampere target = clamped(setup_.restCurrent.value_or(Ampere()), facts_.limits);
    const bool there = code_ == codeFor(target);
    for (int step = there ? kSteps : 1; step <= kSteps; ++step) {
        const Ampere next = from + (static_cast<double>(step) / kSteps) * (target - from);
        auto sent = sendCurrent(next);
        if (!sent) sent = sendCurrent(next);
        if (!sent) return sent;
        if (step < kSteps) clock_.wait(kStep);
    }
    return {};
}

}  // namespace ilf::devices
