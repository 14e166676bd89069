// UsbLinks that note every exchange on a tape, and that play one back.
#pragma once

#include <memory>

#include "devices/tape/tape_player.h"
#include "devices/tape/tape_recorder.h"
#include "devices/usb/usb_link.h"

namespace ilf::devices {

/// Whether what streams carry is noted, transfer by transfer as "stream-out" and "stream-in": half a megabyte a second.
enum class Streamed { noted, leftOut };

/// A link as before, and a tape of it.
class RecordingLink : public UsbLink {
public:
    RecordingLink(std::unique_ptr<UsbLink> link, std::shared_ptr<TapeRecorder> recorder,
                  Streamed streamed = Streamed::noted);

    const UsbIdentity& identity() const override { return link_->identity(); }
    Result<Endpoint> interruptOut() const override { return link_->interruptOut(); }
    Result<Endpoint> interruptIn() const override { return link_->interruptIn(); }
    Result<Endpoint> bulkOut() const override { return link_->bulkOut(); }
    Result<Endpoint> bulkIn() const override { return link_->bulkIn(); }
    Result<void> send(Endpoint to, std::span<const std::uint8_t> data, Milliseconds limit) override;
    Result<Bytes> receive(Endpoint from, std::size_t most, Milliseconds limit) override;
    Result<void> controlOut(const VendorRequest& request, std::span<const std::uint8_t> data,
                            Milliseconds limit) override;
    Result<Bytes> controlIn(const VendorRequest& request, std::size_t length, Milliseconds limit) override;
    Result<void> clearHalt(Endpoint endpoint) override;
    Result<std::unique_ptr<UsbStream>> streamOut(Endpoint to, std::size_t transferBytes, int inFlight,
                                                 std::function<void(std::span<std::uint8_t>)> fill) override;
    Result<std::unique_ptr<UsbStream>> streamIn(Endpoint from, std::size_t transferBytes, int inFlight,
                                                std::function<void(std::span<const std::uint8_t>)> taken) override;

private:
    std::unique_ptr<UsbLink> link_;
    std::shared_ptr<TapeRecorder> recorder_;
    Streamed streamed_;
};

/// A device that is only a tape. Its streams run at once when they are opened: `fill` or `taken` is called for each
/// transfer noted for that endpoint, and what was filled otherwise than on the tape is the stream's error.
class ReplayLink : public UsbLink {
public:
    /// An error (Fault::badFile) if the tape is not of a USB device.
    static Result<std::unique_ptr<ReplayLink>> of(Tape tape);

    /// An error if the driver did something else than the tape, or did not finish it.
    Result<void> finished() const { return player_.finished(); }

    const UsbIdentity& identity() const override { return identity_; }
    Result<Endpoint> interruptOut() const override { return noted("interrupt-out"); }
    Result<Endpoint> interruptIn() const override { return noted("interrupt-in"); }
    Result<Endpoint> bulkOut() const override { return noted("bulk-out"); }
    Result<Endpoint> bulkIn() const override { return noted("bulk-in"); }
    Result<void> send(Endpoint to, std::span<const std::uint8_t> data, Milliseconds limit) override;
    Result<Bytes> receive(Endpoint from, std::size_t most, Milliseconds limit) override;
    Result<void> controlOut(const VendorRequest& request, std::span<const std::uint8_t> data,
                            Milliseconds limit) override;
    Result<Bytes> controlIn(const VendorRequest& request, std::size_t length, Milliseconds limit) override;
    Result<void> clearHalt(Endpoint endpoint) override;
    Result<std::unique_ptr<UsbStream>> streamOut(Endpoint to, std::size_t transferBytes, int inFlight,
                                                 std::function<void(std::span<std::uint8_t>)> fill) override;
    Result<std::unique_ptr<UsbStream>> streamIn(Endpoint from, std::size_t transferBytes, int inFlight,
                                                std::function<void(std::span<const std::uint8_t>)> taken) override;

private:
    ReplayLink(UsbIdentity identity, Tape exchanges, std::vector<TapeEntry> streamed);
    Result<Endpoint> noted(const std::string& kind) const;

    UsbIdentity identity_;
    TapePlayer player_;
    std::vector<TapeEntry> streamed_;  ///< apart, since threads mix them with the rest in any order
};

}  // namespace ilf::devices
