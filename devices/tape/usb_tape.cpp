#include "devices/tape/usb_tape.h"

#include <algorithm>
#include <cstdlib>
#include <type_traits>

#include "devices/usb/hex.h"

namespace ilf::devices {
namespace {

constexpr const char* kStreamOut = "stream-out";
constexpr const char* kStreamIn = "stream-in";

std::string addressOf(Endpoint endpoint) { return hex(endpoint.address, 2); }
std::string addressOf(const VendorRequest& request) {
    return hex(request.request, 2) + " " + hex(request.value, 4) + " " + hex(request.index, 4);
}
std::string opening(std::size_t transferBytes, int inFlight) {
    return std::to_string(inFlight) + "x" + std::to_string(transferBytes);
}

/// Notes an exchange by how it ended: with what was received where that was asked for, else with what was sent.
template <class T>
void noteResult(TapeRecorder& recorder, const std::string& kind, const std::string& where, const Result<T>& result,
                std::span<const std::uint8_t> sent) {
    if (!result) return recorder.failed(kind, where, sent, result.error());
    if constexpr (std::is_same_v<T, Bytes>) {
        recorder.succeeded(kind, where, *result);
    } else {
        recorder.succeeded(kind, where, sent);
    }
}

/// A stream that was played when it was opened.
class PlayedStream : public UsbStream {
public:
    explicit PlayedStream(Result<void> state) : state_(std::move(state)) {}
    Result<void> state() const override { return state_; }

private:
    Result<void> state_;
};

}  // namespace

RecordingLink::RecordingLink(std::unique_ptr<UsbLink> link, std::shared_ptr<TapeRecorder> recorder, Streamed streamed)
    : link_(std::move(link)), recorder_(std::move(recorder)), streamed_(streamed) {
    const UsbIdentity& identity = link_->identity();
    recorder_->about("link", "usb");
    recorder_->about("vendor", hex(identity.vendor, 4));
    recorder_->about("product", hex(identity.product, 4));
    recorder_->about("path", identity.path);
    recorder_->about("product-name", identity.productName);
    recorder_->about("serial", identity.serial);
    if (const auto e = link_->interruptOut()) recorder_->about("interrupt-out", addressOf(*e));
    if (const auto e = link_->interruptIn()) recorder_->about("interrupt-in", addressOf(*e));
    if (const auto e = link_->bulkOut()) recorder_->about("bulk-out", addressOf(*e));
    if (const auto e = link_->bulkIn()) recorder_->about("bulk-in", addressOf(*e));
}

Result<void> RecordingLink::send(Endpoint to, std::span<const std::uint8_t> data, Milliseconds limit) {
    auto done = link_->send(to, data, limit);
    noteResult(*recorder_, "out", addressOf(to), done, data);
    return done;
}

Result<Bytes> RecordingLink::receive(Endpoint from, std::size_t most, Milliseconds limit) {
    auto done = link_->receive(from, most, limit);
    noteResult(*recorder_, "in", addressOf(from), done, {});
    return done;
}

Result<void> RecordingLink::controlOut(const VendorRequest& request, std::span<const std::uint8_t> data,
                                       Milliseconds limit) {
    auto done = link_->controlOut(request, data, limit);
    noteResult(*recorder_, "control-out", addressOf(request), done, data);
    return done;
}

Result<Bytes> RecordingLink::controlIn(const VendorRequest& request, std::size_t length, Milliseconds limit) {
    auto done = link_->controlIn(request, length, limit);
    noteResult(*recorder_, "control-in", addressOf(request), done, {});
    return done;
}

Result<void> RecordingLink::clearHalt(Endpoint endpoint) {
    auto done = link_->clearHalt(endpoint);
    noteResult(*recorder_, "clear-halt", addressOf(endpoint), done, {});
    return done;
}

Result<std::unique_ptr<UsbStream>> RecordingLink::streamOut(Endpoint to, std::size_t transferBytes, int inFlight,
                                                            std::function<void(std::span<std::uint8_t>)> fill) {
    const std::string where = addressOf(to);
    auto noting = [fill, recorder = recorder_, where](std::span<std::uint8_t> bytes) {
        fill(bytes);
        recorder->succeeded(kStreamOut, where, bytes);
    };
    auto stream = streamed_ == Streamed::noted ? link_->streamOut(to, transferBytes, inFlight, std::move(noting))
                                               : link_->streamOut(to, transferBytes, inFlight, std::move(fill));
    const std::string opened = where + " " + opening(transferBytes, inFlight);
    noteResult(*recorder_, "open-stream", opened, stream, {});
    return stream;
}

Result<std::unique_ptr<UsbStream>> RecordingLink::streamIn(Endpoint from, std::size_t transferBytes, int inFlight,
                                                           std::function<void(std::span<const std::uint8_t>)> taken) {
    const std::string where = addressOf(from);
    auto noting = [taken, recorder = recorder_, where](std::span<const std::uint8_t> bytes) {
        recorder->succeeded(kStreamIn, where, bytes);
        taken(bytes);
    };
    auto stream = streamed_ == Streamed::noted ? link_->streamIn(from, transferBytes, inFlight, std::move(noting))
                                               : link_->streamIn(from, transferBytes, inFlight, std::move(taken));
    const std::string opened = where + " " + opening(transferBytes, inFlight);
    noteResult(*recorder_, "open-stream", opened, stream, {});
    return stream;
}

Result<std::unique_ptr<ReplayLink>> ReplayLink::of(Tape tape) {
    if (tape.of("link") != "usb") return fail(Fault::badFile, "This tape is not of a USB device.");
    const auto number = [&](const char* key) {
        return static_cast<std::uint16_t>(std::strtoul(tape.of(key).c_str(), nullptr, 16));
    };
    UsbIdentity identity{number("vendor"), number("product"), tape.of("path"), tape.of("product-name"),
                         tape.of("serial")};
    const auto isStreamed = [](const TapeEntry& entry) { return entry.what == kStreamOut || entry.what == kStreamIn; };
    std::vector<TapeEntry> streamed;
    std::copy_if(tape.entries.begin(), tape.entries.end(), std::back_inserter(streamed), isStreamed);
    std::erase_if(tape.entries, isStreamed);
    return std::unique_ptr<ReplayLink>(new ReplayLink(std::move(identity), std::move(tape), std::move(streamed)));
}

ReplayLink::ReplayLink(UsbIdentity identity, Tape exchanges, std::vector<TapeEntry> streamed)
    : identity_(std::move(identity)), player_(std::move(exchanges)), streamed_(std::move(streamed)) {}

Result<Endpoint> ReplayLink::noted(const std::string& kind) const {
    const std::string address = player_.tape().of(kind);
    if (address.empty()) return fail(Fault::device, "The device on this tape has no " + kind + " endpoint.");
    return Endpoint{static_cast<std::uint8_t>(std::strtoul(address.c_str(), nullptr, 16))};
}

Result<void> ReplayLink::send(Endpoint to, std::span<const std::uint8_t> data, Milliseconds) {
    return player_.nextSent("out", addressOf(to), data);
}

Result<Bytes> ReplayLink::receive(Endpoint from, std::size_t most, Milliseconds) {
    auto bytes = player_.next("in", addressOf(from));
    if (bytes && bytes->size() > most)
        return fail(Fault::device, "The tape has " + std::to_string(bytes->size()) + " bytes where the driver takes " +
                                       std::to_string(most) + ".");
    return bytes;
}

Result<void> ReplayLink::controlOut(const VendorRequest& request, std::span<const std::uint8_t> data, Milliseconds) {
    return player_.nextSent("control-out", addressOf(request), data);
}

Result<Bytes> ReplayLink::controlIn(const VendorRequest& request, std::size_t length, Milliseconds) {
    auto bytes = player_.next("control-in", addressOf(request));
    if (bytes && bytes->size() > length)
        return fail(Fault::device, "The tape has " + std::to_string(bytes->size()) + " bytes where the driver takes " +
                                       std::to_string(length) + ".");
    return bytes;
}

Result<void> ReplayLink::clearHalt(Endpoint endpoint) {
    return player_.nextSent("clear-halt", addressOf(endpoint), {});
}

Result<std::unique_ptr<UsbStream>> ReplayLink::streamOut(Endpoint to, std::size_t transferBytes, int inFlight,
                                                         std::function<void(std::span<std::uint8_t>)> fill) {
    const auto opened = player_.nextSent("open-stream", addressOf(to) + " " + opening(transferBytes, inFlight), {});
    if (!opened) return tl::unexpected(opened.error());
    Result<void> state;
    for (const TapeEntry& entry : streamed_) {
        if (entry.what != kStreamOut || entry.where != addressOf(to)) continue;
        Bytes filled(transferBytes);
        fill(filled);
        if (filled != entry.bytes && state)
            state = fail(Fault::device,
                         "The driver streams otherwise than line " + std::to_string(entry.line) + " of the tape.");
    }
    return std::make_unique<PlayedStream>(std::move(state));
}

Result<std::unique_ptr<UsbStream>> ReplayLink::streamIn(Endpoint from, std::size_t transferBytes, int inFlight,
                                                        std::function<void(std::span<const std::uint8_t>)> taken) {
    const auto opened = player_.nextSent("open-stream", addressOf(from) + " " + opening(transferBytes, inFlight), {});
    if (!opened) return tl::unexpected(opened.error());
    for (const TapeEntry& entry : streamed_)
        if (entry.what == kStreamIn && entry.where == addressOf(from)) taken(entry.bytes);
    return std::make_unique<PlayedStream>(Result<void>{});
}

}  // namespace ilf::devices
