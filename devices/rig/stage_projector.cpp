#include "devices/rig/stage_projector.h"

namespace ilf::devices {

Result<void> LightCrafterProjector::start(const dlpc350::PatternSequence& sequence) {
    return board_->start(sequence).map([](const auto&) {});
}

Result<void> LightCrafterProjector::showVideo(Waiting waiting) {
    if (waiting == Waiting::brief) return board_->showVideo(dlpc350::kBrief);
    // After a message that failed, the next one may only drain what it left behind.
    auto told = board_->showVideo(dlpc350::kBrief);
    if (!told) told = board_->showVideo(dlpc350::kBrief);
    if (!told) told = board_->showVideo({Milliseconds(500), 20});
    return told;
}

}  // namespace ilf::devices
