// SerialLinks that note every exchange on a tape, and that play one back.
#pragma once

#include <memory>

#include "devices/serial/serial_link.h"
#include "devices/tape/tape_player.h"
#include "devices/tape/tape_recorder.h"

namespace ilf::devices {

class RecordingSerialLink : public SerialLink {
public:
    RecordingSerialLink(std::unique_ptr<SerialLink> link, std::shared_ptr<TapeRecorder> recorder);

    const std::string& name() const override { return link_->name(); }
    Result<void> send(std::span<const std::uint8_t> data, Milliseconds limit) override;
    Result<Bytes> receive(std::size_t most, Milliseconds limit) override;

private:
    std::unique_ptr<SerialLink> link_;
    std::shared_ptr<TapeRecorder> recorder_;
};

/// A line that is only a tape: bytes come in the pieces they came in then, cut where the driver takes fewer.
class ReplaySerialLink : public SerialLink {
public:
    /// An error (Fault::badFile) if the tape is not of a serial line.
    static Result<std::unique_ptr<ReplaySerialLink>> of(Tape tape);

    /// An error if the driver did something else than the tape, or did not finish it.
    Result<void> finished() const;

    const std::string& name() const override { return name_; }
    Result<void> send(std::span<const std::uint8_t> data, Milliseconds limit) override;
    Result<Bytes> receive(std::size_t most, Milliseconds limit) override;

private:
    explicit ReplaySerialLink(Tape tape) : name_(tape.of("path")), player_(std::move(tape)) {}

    std::string name_;
    TapePlayer player_;
    Bytes left_;  ///< what came but was not taken yet
};

}  // namespace ilf::devices
