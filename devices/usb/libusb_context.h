// libusb's own objects with their lifetimes; only the files of this folder include it.
#pragma once

#include <libusb.h>

#include <atomic>
#include <memory>
#include <mutex>
#include <stop_token>
#include <thread>

#include "devices/usb/usb_link.h"
#include "devices/usb/usb_news.h"

namespace ilf::devices {

/// Handles what streams have in flight, while there are streams. Transfers that are waited for handle their own.
class UsbEvents {
public:
    explicit UsbEvents(libusb_context* context);
    ~UsbEvents();
    /// libusb's code of why events can no longer be handled, so that nothing in flight comes back; 0: they are.
    int failure() const { return failure_; }

private:
    void run(const std::stop_token& stop);
    libusb_context* context_;
    std::atomic<int> failure_{0};
    std::jthread thread_;
};

class UsbContext {
public:
    /// Null where libusb cannot start.
    static std::shared_ptr<UsbContext> open();
    ~UsbContext();
    UsbContext(const UsbContext&) = delete;
    UsbContext& operator=(const UsbContext&) = delete;

    libusb_context* raw() const { return context_; }
    /// The one event thread, started with the first stream and ended with the last.
    std::shared_ptr<UsbEvents> events();
    /// What came and went. It lives as long as libusb may tell any.
    UsbNews& news() { return news_; }

private:
    explicit UsbContext(libusb_context* context) : context_(context) {}
    libusb_context* context_;
    UsbNews news_;
    std::mutex mutex_;
    std::weak_ptr<UsbEvents> events_;
};

/// An opened device with a claimed interface, released and closed when the last who uses it is gone.
struct OpenUsbDevice {
    std::shared_ptr<UsbContext> context;
    libusb_device_handle* handle = nullptr;
    int interfaceNumber = 0;
    bool claimed = false;
    UsbIdentity identity;

    OpenUsbDevice() = default;
    OpenUsbDevice(const OpenUsbDevice&) = delete;
    OpenUsbDevice& operator=(const OpenUsbDevice&) = delete;
    ~OpenUsbDevice();
};

/// What a device says of itself, as far as the system knows without opening it.
UsbIdentity identityOf(libusb_device* device);
/// /dev/bus/usb/001/004
std::string nodeOf(libusb_device* device);

}  // namespace ilf::devices
