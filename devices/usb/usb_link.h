// One opened USB device as its driver sees it: transfers in and out, and a stream that never pauses.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"

namespace ilf::devices {

using Bytes = std::vector<std::uint8_t>;
using Milliseconds = std::chrono::milliseconds;

/// An endpoint's address as its descriptor gives it: bit 7 set means towards the host.
struct Endpoint {
    std::uint8_t address = 0;
    bool operator==(const Endpoint&) const = default;
};

/// A control transfer's set-up packet, without direction (that is in the call) and length (that is in the data).
struct VendorRequest {
    std::uint8_t request = 0;
    std::uint16_t value = 0, index = 0;
    /// For sentences: what the device was doing for it, "asked for its state". A literal; not part of the request.
    std::string_view words = "";
    bool operator==(const VendorRequest& other) const {
        return request == other.request && value == other.value && index == other.index;
    }
};

/// What a device says of itself when it is found, before it is opened. Serial numbers may be empty or the same on two
/// devices: `path` ("1-2.3": bus, then ports) tells them apart and stays the same when a device is plugged in again.
struct UsbIdentity {
    std::uint16_t vendor = 0, product = 0;
    std::string path, productName, serial;
    bool operator==(const UsbIdentity&) const = default;
};

/// A stream to a bulk endpoint with several transfers always in flight. It lives until it is destroyed, which cancels
/// what is in flight and waits for it.
class UsbStream {
public:
    virtual ~UsbStream() = default;
    /// None while it runs; else why it ended (device gone, stalled, transfer failed).
    virtual Result<void> state() const = 0;
};

/// Calls come from one thread and block at most their time limit. Each error names the device and what would help; a
/// transfer that runs out of time is an error (Fault::device), never an empty success.
class UsbLink {
public:
    virtual ~UsbLink() = default;

    virtual const UsbIdentity& identity() const = 0;
    /// The first endpoint of a kind in the claimed interface, read from its descriptor; none: an error.
    virtual Result<Endpoint> interruptOut() const = 0;
    virtual Result<Endpoint> interruptIn() const = 0;
    virtual Result<Endpoint> bulkOut() const = 0;
    virtual Result<Endpoint> bulkIn() const = 0;

    /// Interrupt or bulk, as the endpoint is. All of `data` is sent or there is an error.
    virtual Result<void> send(Endpoint to, std::span<const std::uint8_t> data, Milliseconds limit) = 0;
    /// One transfer of at most `most` bytes.
    virtual Result<Bytes> receive(Endpoint from, std::size_t most, Milliseconds limit) = 0;
    /// Vendor control transfers (bmRequestType 0x40 and 0xC0).
    virtual Result<void> controlOut(const VendorRequest& request, std::span<const std::uint8_t> data,
                                    Milliseconds limit) = 0;
    virtual Result<Bytes> controlIn(const VendorRequest& request, std::size_t length, Milliseconds limit) = 0;
    virtual Result<void> clearHalt(Endpoint endpoint) = 0;

    /// Keeps `inFlight` transfers of `transferBytes` each queued to `to`; `fill` writes the next transfer's bytes and
    /// is called on the stream's own thread (it must not block).
    virtual Result<std::unique_ptr<UsbStream>> streamOut(Endpoint to, std::size_t transferBytes, int inFlight,
                                                         std::function<void(std::span<std::uint8_t>)> fill) = 0;
    /// The same towards the host: `taken` is handed what arrived.
    virtual Result<std::unique_ptr<UsbStream>> streamIn(Endpoint from, std::size_t transferBytes, int inFlight,
                                                        std::function<void(std::span<const std::uint8_t>)> taken) = 0;
};

}  // namespace ilf::devices
