#include "tests/devices/usb/mock_usb.h"

#include <sys/ioctl.h>  // before the next, or its numbers are not constants

#include <linux/usbdevice_fs.h>
#include <umockdev.h>

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>

namespace ilf::devices::test {
namespace {

constexpr const char* kNode = "/dev/bus/usb/001/004";
constexpr const char* kSys = "/sys/devices/pci0000:00/usb1/1-2";

/// Device and configuration descriptor as hexadecimal digits.
std::string descriptors() {
    const std::string endpoints = "07050103400001"   // interrupt out 01, 64 bytes
                                  "07058103400001"   // interrupt in 81
                                  "07050202400000"   // bulk out 02
                                  "07058602400000";  // bulk in 86
    return "120100020000004051040164000100010001"    // 0451:6401, one configuration
           "09022E0001010080FA"                      // 46 bytes, one interface
           "090400000403000000" +
           endpoints;
}

struct Flying {
    UMockdevIoctlData* urb = nullptr;
    UMockdevIoctlData* buffer = nullptr;
    bool done = false;
    usbdevfs_urb& header() const { return *reinterpret_cast<usbdevfs_urb*>(urb->data); }
    void finish(int status, std::size_t bytes) {
        header().status = status;
        header().actual_length = static_cast<int>(bytes);
        done = true;
    }
};

}  // namespace

struct MockUsb::State {
    mutable std::mutex mutex;
    UMockdevTestbed* testbed = nullptr;
    UMockdevIoctlBase* handler = nullptr;
    std::deque<Flying> flying;
    std::deque<std::vector<std::uint8_t>> echoes;
    std::size_t swallowed = 0;
    int pause = 0;  ///< looks until the next bulk transfer is through
    bool busy = false, detached = false, gone = false, plugged = false;

    void control(Flying& f) const {
        std::uint8_t* bytes = f.buffer->data;
        const std::size_t length = static_cast<std::size_t>(bytes[6] | (bytes[7] << 8));
        if (bytes[1] == 0x99) return f.finish(-EPIPE, 0);
        if ((bytes[0] & 0x80) == 0) return f.finish(0, length);
        bytes[8] = 0x08;
        bytes[9] = 0x00;
        f.finish(0, 2);
    }
    void move(Flying& f) {
        const std::size_t length = static_cast<std::size_t>(f.header().buffer_length);
        if (gone) return f.finish(-ENODEV, 0);
        if (f.header().type == USBDEVFS_URB_TYPE_CONTROL) return control(f);
        switch (f.header().endpoint) {
        case 0x01:
            echoes.emplace_back(f.buffer->data, f.buffer->data + length);
            return f.finish(0, length);
        case 0x81:
            if (echoes.empty()) return;
            std::copy(echoes.front().begin(), echoes.front().end(), f.buffer->data);
            f.finish(0, echoes.front().size());
            return echoes.pop_front();
        default:
            break;
        }
        if (pause-- > 0) return;
        pause = 3;
        if (f.header().endpoint == 0x86) {
            std::memset(f.buffer->data, 7, 10);
            return f.finish(0, 10);
        }
        swallowed += length;
        f.finish(0, length);
    }
    void step() {
        for (Flying& f : flying)
            if (!f.done) move(f);
    }

    int submit(UMockdevIoctlData* argument) {
        if (gone) return ENODEV;
        UMockdevIoctlData* urb = umockdev_ioctl_data_resolve(argument, 0, sizeof(usbdevfs_urb), nullptr);
        const auto length = static_cast<std::size_t>(reinterpret_cast<usbdevfs_urb*>(urb->data)->buffer_length);
        UMockdevIoctlData* buffer = umockdev_ioctl_data_resolve(urb, offsetof(usbdevfs_urb, buffer), length, nullptr);
        flying.push_back({urb, buffer, false});
        step();
        return 0;
    }
    int reap(UMockdevIoctlData* argument) {
        step();
        const auto ready = std::find_if(flying.begin(), flying.end(), [](const Flying& f) { return f.done; });
        if (ready == flying.end()) return gone ? ENODEV : EAGAIN;
        UMockdevIoctlData* place = umockdev_ioctl_data_resolve(argument, 0, sizeof(void*), nullptr);
        umockdev_ioctl_data_set_ptr(place, 0, ready->urb);
        g_object_unref(place);
        g_object_unref(ready->buffer);
        g_object_unref(ready->urb);
        flying.erase(ready);
        return 0;
    }
    int discard(UMockdevIoctlData* argument) {
        const auto which = *reinterpret_cast<const gulong*>(argument->data);
        for (Flying& f : flying)
            if (!f.done && f.urb->client_addr == which) f.finish(-ENOENT, 0);
        return 0;
    }
    /// An error number, or less than 0 for what is not known here.
    int handle(gulong request, UMockdevIoctlData* argument) {
        switch (request) {
        case USBDEVFS_CLAIMINTERFACE:
            return busy ? EBUSY : 0;
        case USBDEVFS_DISCONNECT_CLAIM:
        case USBDEVFS_IOCTL:
            detached = true;
            return busy && request == USBDEVFS_DISCONNECT_CLAIM ? EBUSY : 0;
        case USBDEVFS_RELEASEINTERFACE:
        case USBDEVFS_CLEAR_HALT:
            return 0;
        case USBDEVFS_GETDRIVER: {
            if (detached) return ENODATA;
            UMockdevIoctlData* driver = umockdev_ioctl_data_resolve(argument, 0, sizeof(usbdevfs_getdriver), nullptr);
            std::strcpy(reinterpret_cast<usbdevfs_getdriver*>(driver->data)->driver, "usbhid");
            g_object_unref(driver);
            return 0;
        }
        case USBDEVFS_SUBMITURB:
            return submit(argument);
        case USBDEVFS_REAPURB:
        case USBDEVFS_REAPURBNDELAY:
            return reap(argument);
        case USBDEVFS_DISCARDURB:
            return discard(argument);
        default:
            return -1;
        }
    }
    static gboolean asked(UMockdevIoctlBase*, UMockdevIoctlClient* client, gpointer self) {
        auto* state = static_cast<State*>(self);
        const std::scoped_lock lock(state->mutex);
        const int error =
            state->handle(umockdev_ioctl_client_get_request(client), umockdev_ioctl_client_get_arg(client));
        if (error < 0) return FALSE;
        umockdev_ioctl_client_complete(client, error == 0 ? 0 : -1, error);
        return TRUE;
    }
};

bool MockUsb::preloaded() {
    const char* preload = std::getenv("LD_PRELOAD");
    return preload != nullptr && std::string(preload).find("umockdev") != std::string::npos;
}

MockUsb::MockUsb() : state_(std::make_unique<State>()) {
    state_->testbed = umockdev_testbed_new();
    state_->handler = umockdev_ioctl_base_new();
    g_signal_connect(state_->handler, "handle-ioctl", G_CALLBACK(&State::asked), state_.get());
    umockdev_testbed_attach_ioctl(state_->testbed, kNode, state_->handler, nullptr);
}

MockUsb::~MockUsb() {
    if (state_->plugged) pullOut();
    umockdev_testbed_detach_ioctl(state_->testbed, kNode, nullptr);
    g_object_unref(state_->handler);
    g_object_unref(state_->testbed);
}

void MockUsb::plugIn() {
    const std::string device = "P: /devices/pci0000:00/usb1/1-2\n"
                               "N: bus/usb/001/004\n"
                               "E: SUBSYSTEM=usb\nE: DEVTYPE=usb_device\nE: BUSNUM=001\nE: DEVNUM=004\n"
                               "E: DEVNAME=/dev/bus/usb/001/004\n"
                               "A: busnum=1\\n\nA: devnum=4\\n\nA: bConfigurationValue=1\\n\nA: speed=12\\n\n"
                               "A: product=DLPC350\\n\nA: serial=\\n\n"
                               "H: descriptors=" +
                               descriptors() + "\n\n";
    umockdev_testbed_add_from_string(state_->testbed, device.c_str(), nullptr);
    state_->plugged = true;
}

void MockUsb::pullOut() {
    {
        const std::scoped_lock lock(state_->mutex);
        state_->gone = true;
    }
    umockdev_testbed_uevent(state_->testbed, kSys, "remove");
    umockdev_testbed_remove_device(state_->testbed, kSys);
    state_->plugged = false;
}

void MockUsb::setBusy(bool busy) {
    const std::scoped_lock lock(state_->mutex);
    state_->busy = busy;
}
bool MockUsb::kernelDriverSentAway() const {
    const std::scoped_lock lock(state_->mutex);
    return state_->detached;
}
std::size_t MockUsb::swallowed() const {
    const std::scoped_lock lock(state_->mutex);
    return state_->swallowed;
}
std::size_t MockUsb::inFlight() const {
    const std::scoped_lock lock(state_->mutex);
    return state_->flying.size();
}

}  // namespace ilf::devices::test
