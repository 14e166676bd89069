// A UsbLink over libusb; only the files of this folder include it.
#pragma once

#include <map>
#include <memory>
#include <vector>

#include "devices/usb/libusb_context.h"

namespace ilf::devices {

class LibusbLink : public UsbLink {
public:
    /// `device` has its interface claimed; its endpoints are read from the active configuration.
    static Result<std::unique_ptr<UsbLink>> over(std::shared_ptr<OpenUsbDevice> device);

    const UsbIdentity& identity() const override { return device_->identity; }
    Result<Endpoint> interruptOut() const override;
    Result<Endpoint> interruptIn() const override;
    Result<Endpoint> bulkOut() const override;
    Result<Endpoint> bulkIn() const override;
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
    struct Found {
        Endpoint endpoint;
        std::uint8_t type = 0;  ///< LIBUSB_ENDPOINT_TRANSFER_TYPE_...
    };
    explicit LibusbLink(std::shared_ptr<OpenUsbDevice> device) : device_(std::move(device)) {}
    Result<Endpoint> first(std::uint8_t type, bool towardsHost, const char* words) const;
    Error tookOnly(int done, std::size_t wanted) const;
    int transfer(Endpoint endpoint, std::uint8_t* data, std::size_t size, int& done, Milliseconds limit);

    std::shared_ptr<OpenUsbDevice> device_;
    std::vector<Found> endpoints_;
};

}  // namespace ilf::devices
