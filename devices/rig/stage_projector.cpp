#include "devices/rig/stage_projector.h"

namespace ilf::devices {

Result<void> LightCrafterProjector::start(const dlpc350::PatternSequence& sequence) {
    return board_->start(sequence).map([](const auto&) {});
}

Result<void> LightCrafterProjector::showVideo() {
    // After a message that failed, the next one may only drain what it left behind.
    constexpr int kTries = 3;
    auto told = board_->showVideo();
    for (int tries = 1; !told && tries < kTries; ++tries)
        told = board_->showVideo();
    return told;
}

}  // namespace ilf::devices
