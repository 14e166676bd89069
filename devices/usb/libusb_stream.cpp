#include "devices/usb/libusb_stream.h"

#include <cassert>

#include "devices/usb/usb_words.h"

namespace ilf::devices {
namespace {

constexpr const char* kStreaming = "exchanging a stream of samples";

/// The code a call that waits would have returned.
int codeOf(const libusb_transfer& transfer) {
    switch (transfer.status) {
    case LIBUSB_TRANSFER_COMPLETED:
        return LIBUSB_SUCCESS;
    case LIBUSB_TRANSFER_TIMED_OUT:
        return LIBUSB_ERROR_TIMEOUT;
    case LIBUSB_TRANSFER_CANCELLED:
        return LIBUSB_ERROR_INTERRUPTED;
    case LIBUSB_TRANSFER_STALL:
        return LIBUSB_ERROR_PIPE;
    case LIBUSB_TRANSFER_NO_DEVICE:
        return LIBUSB_ERROR_NO_DEVICE;
    case LIBUSB_TRANSFER_OVERFLOW:
        return LIBUSB_ERROR_OVERFLOW;
    case LIBUSB_TRANSFER_ERROR:
        return LIBUSB_ERROR_IO;
    }
    return LIBUSB_ERROR_OTHER;
}

}  // namespace

LibusbStream::LibusbStream(std::shared_ptr<OpenUsbDevice> device, Endpoint endpoint, Fill fill, Taken taken)
    : device_(std::move(device)), events_(device_->context->events()), endpoint_(endpoint), fill_(std::move(fill)),
      taken_(std::move(taken)) {
    assert((fill_ != nullptr) != (taken_ != nullptr));
}

Result<std::unique_ptr<UsbStream>> LibusbStream::start(std::shared_ptr<OpenUsbDevice> device, Endpoint endpoint,
                                                       std::size_t transferBytes, int inFlight, Fill fill,
                                                       Taken taken) {
    std::unique_ptr<LibusbStream> stream(
        new LibusbStream(std::move(device), endpoint, std::move(fill), std::move(taken)));
    if (auto ready = stream->prepare(transferBytes, inFlight); !ready) return tl::unexpected(ready.error());
    // All are filled before the first is sent, so that none waits for another's samples.
    if (stream->fill_)
        for (const auto& part : stream->parts_)
            stream->fill_(part->buffer);
    for (const auto& part : stream->parts_)
        if (const int code = stream->submit(*part); code != LIBUSB_SUCCESS)
            return tl::unexpected(usbError(code, stream->device_->identity, kStreaming));
    return stream;
}

Result<void> LibusbStream::prepare(std::size_t transferBytes, int inFlight) {
    for (int i = 0; i < inFlight; ++i) {
        auto part = std::make_unique<Part>();
        part->stream = this;
        part->buffer.resize(transferBytes);
        part->transfer = libusb_alloc_transfer(0);
        if (part->transfer == nullptr)
            return tl::unexpected(usbError(LIBUSB_ERROR_NO_MEM, device_->identity, kStreaming));
        libusb_fill_bulk_transfer(part->transfer, device_->handle, endpoint_.address, part->buffer.data(),
                                  static_cast<int>(transferBytes), &LibusbStream::completed, part.get(), 0);
        parts_.push_back(std::move(part));
    }
    return {};
}

LibusbStream::~LibusbStream() {
    {
        std::unique_lock lock(mutex_);
        stopping_ = true;
        cancelAll();
        // The kernel writes into the buffers until each transfer is back, so there is no time limit to this.
        allBack_.wait(lock, [&] { return flying_ == 0; });
    }
    for (const auto& part : parts_)
        libusb_free_transfer(part->transfer);
}

Result<void> LibusbStream::state() const {
    const std::scoped_lock lock(mutex_);
    if (error_) return tl::unexpected(*error_);
    if (const int code = events_->failure(); code != 0)
        return tl::unexpected(usbError(code, device_->identity, kStreaming));
    return {};
}

int LibusbStream::submit(Part& part) {
    const std::scoped_lock lock(mutex_);
    if (stopping_ || error_) return LIBUSB_ERROR_INTERRUPTED;
    const int code = libusb_submit_transfer(part.transfer);
    if (code == LIBUSB_SUCCESS) ++flying_;
    return code;
}

void LIBUSB_CALL LibusbStream::completed(libusb_transfer* transfer) {
    auto* part = static_cast<Part*>(transfer->user_data);
    part->stream->done(*part);
}

void LibusbStream::done(Part& part) {
    int code = codeOf(*part.transfer);
    if (code == LIBUSB_SUCCESS) {
        if (fill_ && part.transfer->actual_length != part.transfer->length)
            code = LIBUSB_ERROR_IO;
        else if (fill_)
            fill_(part.buffer);
        else
            taken_({part.buffer.data(), static_cast<std::size_t>(part.transfer->actual_length)});
    }
    if (code == LIBUSB_SUCCESS) code = submit(part);
    if (code != LIBUSB_SUCCESS) ended(code);
    // Last, since the stream may be gone as soon as nothing flies.
    const std::scoped_lock lock(mutex_);
    if (--flying_ == 0) allBack_.notify_all();
}

void LibusbStream::ended(int code) {
    const std::scoped_lock lock(mutex_);
    if (stopping_ || error_) return;
    error_ = usbError(code, device_->identity, kStreaming);
    cancelAll();
}

void LibusbStream::cancelAll() {
    for (const auto& part : parts_)
        libusb_cancel_transfer(part->transfer);  // of one that does not fly: nothing
}

}  // namespace ilf::devices
