#include "devices/usb/usb_bus.h"

#include <algorithm>
#include <utility>

#include "devices/usb/libusb_context.h"
#include "devices/usb/libusb_link.h"
#include "devices/usb/usb_words.h"

namespace ilf::devices {
namespace {

/// libusb's list of what is plugged in.
class DeviceList {
public:
    explicit DeviceList(libusb_context* context) : count_(libusb_get_device_list(context, &list_)) {}
    ~DeviceList() {
        if (list_ != nullptr) libusb_free_device_list(list_, 1);
    }
    DeviceList(const DeviceList&) = delete;
    DeviceList& operator=(const DeviceList&) = delete;
    std::span<libusb_device* const> all() const { return {list_, count_ > 0 ? static_cast<std::size_t>(count_) : 0}; }

private:
    libusb_device** list_ = nullptr;
    ssize_t count_ = 0;
};

Result<void> opened(OpenUsbDevice& open, libusb_device* device) {
    const int code = libusb_open(device, &open.handle);
    if (code == LIBUSB_ERROR_ACCESS) return tl::unexpected(usbPermissionError(open.identity, nodeOf(device)));
    if (code != LIBUSB_SUCCESS) return tl::unexpected(usbError(code, open.identity, "opened"));
    return {};
}

Result<void> claimed(OpenUsbDevice& open, libusb_device* device) {
    int configuration = 1;
    libusb_get_configuration(open.handle, &configuration);
    const std::string driver = kernelDriverOf(open.identity.path, configuration, open.interfaceNumber);
    libusb_set_auto_detach_kernel_driver(open.handle, 1);  // where unsupported, the claim says busy
    const int code = libusb_claim_interface(open.handle, open.interfaceNumber);
    if (code == LIBUSB_ERROR_BUSY) {
        return tl::unexpected(usbBusyError(open.identity, programsHolding(nodeOf(device)), driver));
    }
    if (code == LIBUSB_ERROR_NOT_FOUND)
        return fail(Fault::device, inWords(open.identity) + " has no interface " +
                                       std::to_string(open.interfaceNumber) +
                                       ": it is not the device it says. Look at what is plugged in there.");
    if (code != LIBUSB_SUCCESS) return tl::unexpected(usbError(code, open.identity, "claimed"));
    open.claimed = true;
    return {};
}

}  // namespace

/// Has libusb tell its news. They go to the context and not to this object: when a callback is taken back, it may still
/// be running on another thread.
class UsbBus::Watch {
public:
    explicit Watch(std::shared_ptr<UsbContext> context) : context_(std::move(context)) {
        constexpr int kAny = LIBUSB_HOTPLUG_MATCH_ANY;
        if (libusb_has_capability(LIBUSB_CAP_HAS_HOTPLUG) != 0)
            registered_ = libusb_hotplug_register_callback(
                              context_->raw(), LIBUSB_HOTPLUG_EVENT_DEVICE_ARRIVED | LIBUSB_HOTPLUG_EVENT_DEVICE_LEFT,
                              0, kAny, kAny, kAny, &Watch::noticed, &context_->news(), &callback_) == LIBUSB_SUCCESS;
    }
    ~Watch() {
        if (registered_) libusb_hotplug_deregister_callback(context_->raw(), callback_);
    }
    Watch(const Watch&) = delete;
    Watch& operator=(const Watch&) = delete;

    const std::shared_ptr<UsbContext>& context() const { return context_; }

    std::vector<UsbChange> taken() {
        timeval atOnce{0, 0};
        // Where events cannot be handled there are no news, and a list still tells what is there.
        (void)libusb_handle_events_timeout_completed(context_->raw(), &atOnce, nullptr);
        return context_->news().taken();
    }

private:
    /// Comes from within any libusb call that handles events, so it only notes.
    static int LIBUSB_CALL noticed(libusb_context*, libusb_device* device, libusb_hotplug_event event, void* news) {
        static_cast<UsbNews*>(news)->add({event == LIBUSB_HOTPLUG_EVENT_DEVICE_ARRIVED, identityOf(device)});
        return 0;
    }

    std::shared_ptr<UsbContext> context_;
    libusb_hotplug_callback_handle callback_ = 0;
    bool registered_ = false;
};

UsbBus::UsbBus(std::unique_ptr<Watch> watch) : watch_(std::move(watch)) {}
UsbBus::~UsbBus() = default;

Result<std::unique_ptr<UsbBus>> UsbBus::open() {
    auto context = UsbContext::open();
    if (!context)
        return fail(Fault::device, "USB cannot be used on this machine: libusb did not start. Is /sys mounted?");
    return std::unique_ptr<UsbBus>(new UsbBus(std::make_unique<Watch>(std::move(context))));
}

Result<std::vector<UsbIdentity>> UsbBus::devices(std::span<const UsbModel> models) const {
    const DeviceList list(watch_->context()->raw());
    std::vector<UsbIdentity> found;
    for (libusb_device* device : list.all()) {
        libusb_device_descriptor descriptor{};
        libusb_get_device_descriptor(device, &descriptor);
        const UsbModel model{descriptor.idVendor, descriptor.idProduct};
        if (std::find(models.begin(), models.end(), model) != models.end()) found.push_back(identityOf(device));
    }
    std::sort(found.begin(), found.end(), [](const UsbIdentity& a, const UsbIdentity& b) { return a.path < b.path; });
    return found;
}

Result<std::unique_ptr<UsbLink>> UsbBus::link(const std::string& path, int interfaceNumber) {
    const DeviceList list(watch_->context()->raw());
    for (libusb_device* device : list.all()) {
        auto open = std::make_shared<OpenUsbDevice>();
        open->identity = identityOf(device);
        if (open->identity.path != path) continue;
        open->context = watch_->context();
        open->interfaceNumber = interfaceNumber;
        if (const auto ok = opened(*open, device); !ok) return tl::unexpected(ok.error());
        if (const auto ok = claimed(*open, device); !ok) return tl::unexpected(ok.error());
        return LibusbLink::over(std::move(open));
    }
    return fail(Fault::notFound,
                "No USB device is plugged in at " + path + ". Plug it in at that port, or choose where it is now.");
}

std::vector<UsbChange> UsbBus::changes() { return watch_->taken(); }

}  // namespace ilf::devices
