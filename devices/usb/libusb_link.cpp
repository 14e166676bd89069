#include "devices/usb/libusb_link.h"

#include <algorithm>

#include "devices/usb/hex.h"
#include "devices/usb/libusb_stream.h"
#include "devices/usb/usb_words.h"

namespace ilf::devices {
namespace {

/// libusb waits without end for 0.
unsigned limitOf(Milliseconds limit) { return static_cast<unsigned>(std::max<Milliseconds::rep>(limit.count(), 1)); }

std::string sending(std::size_t bytes, Endpoint to) {
    return "sent " + std::to_string(bytes) + " bytes at endpoint " + hex(to.address, 2);
}

std::string waiting(Endpoint from) { return "asked for data at endpoint " + hex(from.address, 2); }

std::string asking(const VendorRequest& request) {
    return request.words.empty() ? "handling request " + hex(request.request, 2) : std::string(request.words);
}

// bmRequestType: vendor, to the device; bit 7 towards the host.
constexpr std::uint8_t kVendorOut = 0x40, kVendorIn = 0xC0;

}  // namespace

Result<std::unique_ptr<UsbLink>> LibusbLink::over(std::shared_ptr<OpenUsbDevice> device) {
    libusb_config_descriptor* configuration = nullptr;
    const int code = libusb_get_active_config_descriptor(libusb_get_device(device->handle), &configuration);
    if (code != LIBUSB_SUCCESS) return tl::unexpected(usbError(code, device->identity, "asked for its configuration"));
    std::unique_ptr<LibusbLink> link(new LibusbLink(std::move(device)));
    for (int i = 0; i < configuration->bNumInterfaces; ++i) {
        const libusb_interface& interface = configuration->interface[i];
        if (interface.num_altsetting < 1) continue;
        const libusb_interface_descriptor& described = interface.altsetting[0];
        if (described.bInterfaceNumber != link->device_->interfaceNumber) continue;
        for (int e = 0; e < described.bNumEndpoints; ++e) {
            const libusb_endpoint_descriptor& endpoint = described.endpoint[e];
            link->endpoints_.push_back({{endpoint.bEndpointAddress},
                                        static_cast<std::uint8_t>(endpoint.bmAttributes & LIBUSB_TRANSFER_TYPE_MASK)});
        }
    }
    libusb_free_config_descriptor(configuration);
    return link;
}

Result<Endpoint> LibusbLink::first(std::uint8_t type, bool towardsHost, const char* words) const {
    for (const Found& found : endpoints_)
        if (found.type == type && ((found.endpoint.address & LIBUSB_ENDPOINT_IN) != 0) == towardsHost)
            return found.endpoint;
    return fail(Fault::device, inWords(identity()) + " has no " + words +
                                   " endpoint: it is not the device it says. Look at what is plugged in there.");
}

Error LibusbLink::tookOnly(int done, std::size_t wanted) const {
    return {Fault::device, inWords(identity()) + " took only " + std::to_string(done) + " of " +
                               std::to_string(wanted) + " bytes. Unplug it and plug it in again."};
}

Result<Endpoint> LibusbLink::interruptOut() const {
    return first(LIBUSB_ENDPOINT_TRANSFER_TYPE_INTERRUPT, false, "interrupt out");
}
Result<Endpoint> LibusbLink::interruptIn() const {
    return first(LIBUSB_ENDPOINT_TRANSFER_TYPE_INTERRUPT, true, "interrupt in");
}
Result<Endpoint> LibusbLink::bulkOut() const { return first(LIBUSB_ENDPOINT_TRANSFER_TYPE_BULK, false, "bulk out"); }
Result<Endpoint> LibusbLink::bulkIn() const { return first(LIBUSB_ENDPOINT_TRANSFER_TYPE_BULK, true, "bulk in"); }

int LibusbLink::transfer(Endpoint endpoint, std::uint8_t* data, std::size_t size, int& done, Milliseconds limit) {
    bool interrupt = false;
    for (const Found& found : endpoints_)
        if (found.endpoint == endpoint) interrupt = found.type == LIBUSB_ENDPOINT_TRANSFER_TYPE_INTERRUPT;
    const auto call = interrupt ? &libusb_interrupt_transfer : &libusb_bulk_transfer;
    return call(device_->handle, endpoint.address, data, static_cast<int>(size), &done, limitOf(limit));
}

Result<void> LibusbLink::send(Endpoint to, std::span<const std::uint8_t> data, Milliseconds limit) {
    Bytes copy(data.begin(), data.end());  // libusb takes what it sends as if it wrote to it
    int done = 0;
    const int code = transfer(to, copy.data(), copy.size(), done, limit);
    if (code != LIBUSB_SUCCESS) return tl::unexpected(usbError(code, identity(), sending(data.size(), to)));
    if (static_cast<std::size_t>(done) != data.size()) return tl::unexpected(tookOnly(done, data.size()));
    return {};
}

Result<Bytes> LibusbLink::receive(Endpoint from, std::size_t most, Milliseconds limit) {
    Bytes data(most);
    int done = 0;
    const int code = transfer(from, data.data(), most, done, limit);
    // What came just as time ran out has come.
    const bool late = code == LIBUSB_ERROR_TIMEOUT && done > 0;
    if (code != LIBUSB_SUCCESS && !late) return tl::unexpected(usbError(code, identity(), waiting(from)));
    data.resize(static_cast<std::size_t>(done));
    return data;
}

Result<void> LibusbLink::controlOut(const VendorRequest& request, std::span<const std::uint8_t> data,
                                    Milliseconds limit) {
    Bytes copy(data.begin(), data.end());
    const int done = libusb_control_transfer(device_->handle, kVendorOut, request.request, request.value, request.index,
                                             copy.data(), static_cast<std::uint16_t>(copy.size()), limitOf(limit));
    if (done < 0) return tl::unexpected(usbError(done, identity(), asking(request)));
    if (static_cast<std::size_t>(done) != data.size()) return tl::unexpected(tookOnly(done, data.size()));
    return {};
}

Result<Bytes> LibusbLink::controlIn(const VendorRequest& request, std::size_t length, Milliseconds limit) {
    Bytes data(length);
    const int done = libusb_control_transfer(device_->handle, kVendorIn, request.request, request.value, request.index,
                                             data.data(), static_cast<std::uint16_t>(length), limitOf(limit));
    if (done < 0) return tl::unexpected(usbError(done, identity(), asking(request)));
    data.resize(static_cast<std::size_t>(done));
    return data;
}

Result<void> LibusbLink::clearHalt(Endpoint endpoint) {
    const int code = libusb_clear_halt(device_->handle, endpoint.address);
    if (code != LIBUSB_SUCCESS)
        return tl::unexpected(
            usbError(code, identity(), "told to clear the halt of endpoint " + hex(endpoint.address, 2)));
    return {};
}

Result<std::unique_ptr<UsbStream>> LibusbLink::streamOut(Endpoint to, std::size_t transferBytes, int inFlight,
                                                         std::function<void(std::span<std::uint8_t>)> fill) {
    return LibusbStream::start(device_, to, transferBytes, inFlight, std::move(fill), {});
}

Result<std::unique_ptr<UsbStream>> LibusbLink::streamIn(Endpoint from, std::size_t transferBytes, int inFlight,
                                                        std::function<void(std::span<const std::uint8_t>)> taken) {
    return LibusbStream::start(device_, from, transferBytes, inFlight, {}, std::move(taken));
}

}  // namespace ilf::devices
