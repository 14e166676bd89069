#include "devices/rig/stage_projector.h"

namespace ilf::devices {
namespace {

/// A source that was plugged or chosen just now is locked on within a few frames.
constexpr dlpc350::Patience kLocking{Milliseconds(200), 5};

/// `tell` as patiently as that.
template <class Tell>
Result<void> waiting(Waiting how, Tell tell) {
    if (how == Waiting::brief) return tell(dlpc350::kBrief);
    // After a message that failed, the next one may only drain what it left behind.
    auto told = tell(dlpc350::kBrief);
    if (!told) told = tell(dlpc350::kBrief);
    if (!told) told = tell(dlpc350::Patience{Milliseconds(500), 20});
    return told;
}

}  // namespace

Result<void> LightCrafterProjector::start(const dlpc350::PatternSequence& sequence) {
    return board_->start(sequence).map([](const auto&) {});
}

Result<void> LightCrafterProjector::showVideo(Waiting how) {
    return waiting(how, [this](const dlpc350::Patience& patience) { return board_->showVideo(patience); });
}

Result<void> LightCrafterProjector::showOwnWhite(Waiting how) {
    return waiting(how, [this](const dlpc350::Patience& patience) { return board_->showOwnWhite(patience); });
}

Result<bool> LightCrafterProjector::seesVideo() { return board_->seesVideo(kLocking); }

}  // namespace ilf::devices
