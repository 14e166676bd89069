#include "devices/usb/libusb_context.h"

#include <array>
#include <chrono>
#include <cstdio>
#include <fstream>

namespace ilf::devices {
namespace {

/// "1-2.3": the bus, then the ports; the name the kernel gives it in /sys/bus/usb/devices.
std::string pathOf(libusb_device* device) {
    std::array<std::uint8_t, 7> ports{};  // USB 3 allows seven tiers
    const int count = libusb_get_port_numbers(device, ports.data(), static_cast<int>(ports.size()));
    std::string path = std::to_string(libusb_get_bus_number(device));
    for (int i = 0; i < count; ++i)
        path += (i == 0 ? "-" : ".") + std::to_string(ports[static_cast<std::size_t>(i)]);
    return path;
}

/// Strings as the kernel read them when the device came: no permission is needed for them.
std::string systemText(const std::string& path, const char* which) {
    std::ifstream file("/sys/bus/usb/devices/" + path + "/" + which);
    std::string line;
    std::getline(file, line);
    return line;
}

}  // namespace

UsbEvents::UsbEvents(libusb_context* context)
    : context_(context), thread_([this](const std::stop_token& stop) { run(stop); }) {}

UsbEvents::~UsbEvents() {
    thread_.request_stop();
    libusb_interrupt_event_handler(context_);
}

void UsbEvents::run(const std::stop_token& stop) {
    while (!stop.stop_requested()) {
        timeval pause{0, 100'000};
        const int code = libusb_handle_events_timeout_completed(context_, &pause, nullptr);
        const bool good = code == LIBUSB_SUCCESS || code == LIBUSB_ERROR_INTERRUPTED || code == LIBUSB_ERROR_TIMEOUT;
        failure_ = good ? 0 : code;
        // It came back at once, and may again.
        if (!good) std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
}

std::shared_ptr<UsbContext> UsbContext::open() {
    libusb_context* context = nullptr;
    if (libusb_init(&context) != LIBUSB_SUCCESS) return nullptr;
    return std::shared_ptr<UsbContext>(new UsbContext(context));
}

UsbContext::~UsbContext() { libusb_exit(context_); }

std::shared_ptr<UsbEvents> UsbContext::events() {
    const std::scoped_lock lock(mutex_);
    auto events = events_.lock();
    if (!events) events_ = events = std::make_shared<UsbEvents>(context_);
    return events;
}

OpenUsbDevice::~OpenUsbDevice() {
    if (handle == nullptr) return;
    if (claimed) libusb_release_interface(handle, interfaceNumber);
    libusb_close(handle);
}

UsbIdentity identityOf(libusb_device* device) {
    libusb_device_descriptor descriptor{};
    libusb_get_device_descriptor(device, &descriptor);  // cannot fail since libusb 1.0.16
    UsbIdentity identity{descriptor.idVendor, descriptor.idProduct, pathOf(device), {}, {}};
    identity.productName = systemText(identity.path, "product");
    identity.serial = systemText(identity.path, "serial");
    return identity;
}

std::string nodeOf(libusb_device* device) {
    char node[32];
    std::snprintf(node, sizeof node, "/dev/bus/usb/%03u/%03u", libusb_get_bus_number(device),
                  libusb_get_device_address(device));
    return node;
}

}  // namespace ilf::devices
