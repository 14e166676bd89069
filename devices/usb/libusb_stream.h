// A stream of asynchronous libusb transfers; only the files of this folder include it.
#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <optional>
#include <vector>

#include "devices/usb/libusb_context.h"

namespace ilf::devices {

class LibusbStream : public UsbStream {
public:
    using Fill = std::function<void(std::span<std::uint8_t>)>;
    using Taken = std::function<void(std::span<const std::uint8_t>)>;

    /// Out with `fill`, in with `taken`: exactly one of them is set.
    static Result<std::unique_ptr<UsbStream>> start(std::shared_ptr<OpenUsbDevice> device, Endpoint endpoint,
                                                    std::size_t transferBytes, int inFlight, Fill fill, Taken taken);
    /// Never from `fill` or `taken`: it waits for the thread that calls them.
    ~LibusbStream() override;
    Result<void> state() const override;

private:
    struct Part {
        LibusbStream* stream = nullptr;
        libusb_transfer* transfer = nullptr;
        Bytes buffer;
    };
    LibusbStream(std::shared_ptr<OpenUsbDevice> device, Endpoint endpoint, Fill fill, Taken taken);
    Result<void> prepare(std::size_t transferBytes, int inFlight);
    int submit(Part& part);
    void done(Part& part);
    void ended(int code);
    void cancelAll();
    static void LIBUSB_CALL completed(libusb_transfer* transfer);

    std::shared_ptr<OpenUsbDevice> device_;
    std::shared_ptr<UsbEvents> events_;
    Endpoint endpoint_;
    Fill fill_;
    Taken taken_;
    std::vector<std::unique_ptr<Part>> parts_;
    mutable std::mutex mutex_;
    std::condition_variable allBack_;
    int flying_ = 0;
    bool stopping_ = false;
    std::optional<Error> error_;
};

}  // namespace ilf::devices
