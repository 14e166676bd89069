#include "devices/tape/serial_tape.h"

#include <algorithm>

namespace ilf::devices {

RecordingSerialLink::RecordingSerialLink(std::unique_ptr<SerialLink> link, std::shared_ptr<TapeRecorder> recorder)
    : link_(std::move(link)), recorder_(std::move(recorder)) {
    recorder_->about("link", "serial");
    recorder_->about("path", link_->name());
}

Result<void> RecordingSerialLink::send(std::span<const std::uint8_t> data, Milliseconds limit) {
    auto done = link_->send(data, limit);
    if (done)
        recorder_->succeeded("out", "", data);
    else
        recorder_->failed("out", "", data, done.error());
    return done;
}

Result<Bytes> RecordingSerialLink::receive(std::size_t most, Milliseconds limit) {
    auto done = link_->receive(most, limit);
    if (done)
        recorder_->succeeded("in", "", *done);
    else
        recorder_->failed("in", "", {}, done.error());
    return done;
}

Result<std::unique_ptr<ReplaySerialLink>> ReplaySerialLink::of(Tape tape) {
    if (tape.of("link") != "serial") return fail(Fault::badFile, "This tape is not of a serial line.");
    return std::unique_ptr<ReplaySerialLink>(new ReplaySerialLink(std::move(tape)));
}

Result<void> ReplaySerialLink::finished() const {
    if (const auto ok = player_.finished(); !ok) return ok;
    if (left_.empty()) return {};
    return fail(Fault::device, "The driver left " + std::to_string(left_.size()) + " bytes of the tape unread.");
}

Result<void> ReplaySerialLink::send(std::span<const std::uint8_t> data, Milliseconds) {
    return player_.nextSent("out", "", data);
}

Result<Bytes> ReplaySerialLink::receive(std::size_t most, Milliseconds) {
    if (left_.empty()) {
        auto came = player_.next("in", "");
        if (!came) return came;
        left_ = *std::move(came);
    }
    const auto cut = left_.begin() + static_cast<std::ptrdiff_t>(std::min(most, left_.size()));
    Bytes taken(left_.begin(), cut);
    left_.erase(left_.begin(), cut);
    return taken;
}

}  // namespace ilf::devices
