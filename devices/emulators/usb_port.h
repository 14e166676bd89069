// One emulated USB device as usbdevfs shows it to programs. Private to the emulated host: umockdev's types are here.
#pragma once

#include <sys/ioctl.h>
#include <umockdev.h>

// Needs sys/ioctl.h before it (devices.md 6.3).
#include <linux/usbdevice_fs.h>

#include <chrono>
#include <cstdint>
#include <functional>
#include <list>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "devices/emulators/usb_device.h"

namespace ilf::devices::emulators {

template <class T>
struct Unref {
    void operator()(T* object) const { g_object_unref(object); }
};
template <class T>
using Owned = std::unique_ptr<T, Unref<T>>;
using IoctlData = Owned<UMockdevIoctlData>;

/// What an ioctl returns, and errno.
using Outcome = std::pair<long, int>;

inline IoctlData resolved(UMockdevIoctlData* data, std::size_t offset, std::size_t length) {
    return IoctlData(umockdev_ioctl_data_resolve(data, offset, length, nullptr));
}

template <class T>
T& as(const IoctlData& data) {
    return *reinterpret_cast<T*>(data->data);
}

/// A transfer a program has handed in and not been given back. Data and buffer are the emulator's copies; both are
/// written to the program's memory when it is given back.
struct Urb {
    IoctlData data, buffer;
    std::size_t moved = 0;
    bool done = false;

    usbdevfs_urb& fields() const { return as<usbdevfs_urb>(data); }
    bool isControl() const { return fields().type == USBDEVFS_URB_TYPE_CONTROL; }
    std::span<std::uint8_t> bytes() const {
        if (!buffer) return {};
        return {buffer->data, std::size_t(buffer->data_len)};
    }
    void finish(int status) {
        done = true;
        fields().status = status;
        fields().actual_length = int(moved);
    }
};

/// One open file of a program.
struct Client {
    std::list<Urb> urbs;
    bool claimed = false;
    std::chrono::steady_clock::time_point heard;  ///< when it last asked for anything
    /// It asked for a transfer that is done when none was: it is answered by then, or once one is.
    std::optional<std::chrono::steady_clock::time_point> asksUntil;
    IoctlData askedFor;  ///< where it then wants it
};

/// A device at a place. It stays until the last program has let go of it, long after the cable is out.
struct UsbPort {
    std::recursive_mutex* lock = nullptr;  ///< the host's, held in every call
    std::function<std::int64_t()> now_ns;
    std::function<void(UsbPort&)> onGone;   ///< the device has left the bus by itself
    std::function<void()> onWaiting;        ///< a program waits: `goOn` from now and then
    std::function<void()> catchUp;          ///< brings the bus to now
    std::uint64_t* transfers = nullptr;     ///< counted here
    std::chrono::microseconds patience{0};  ///< how long a question for a transfer that is done may wait for one
    bool busy = false;                      ///< another program holds the interface
    std::string path, node, sysfs;
    EmulatedUsbDevice* device = nullptr;
    UsbDescriptors descriptors;
    Owned<UMockdevIoctlBase> handler;
    std::list<std::pair<Owned<UMockdevIoctlClient>, Client>> clients;
    bool gone = false, kernelDriver = false;
    bool added = false, pulled = false;  ///< programs can see it; they no longer can
    std::chrono::steady_clock::time_point pulledAt;

    void forgetClosed();
    /// Takes back what a program claimed that was killed in the middle of a call.
    void takeFromSilent(const Client& wishing);
    /// What has to be read from the program's memory; to be done while nothing is locked, since the program may take
    /// its time.
    struct Fetched {
        IoctlData data, buffer;
        bool whole = true;  ///< all that was needed could be read
    };
    static Fetched fetched(UMockdevIoctlClient* client);
    /// None: it is answered later, by `goOn`.
    std::optional<Outcome> answer(UMockdevIoctlClient* client, Fetched fetched, bool& known);
    Outcome claim(Client& client);
    Outcome submit(Client& client, Fetched fetched);
    Outcome reap(Client& client, const IoctlData& pointer);
    /// The device is gone: what was handed in comes back as such, and nothing more is taken.
    void leave();
    /// What a host controller does by itself: transfers go on, and whoever waits for one is answered.
    void goOn(std::int64_t now);
    /// Somebody has handed something in, or asked.
    /// What is under way ends with "no device".
    void endTransfers();
    bool waits() const;
    Outcome discard(Client& client, const void* address);
    void progress(Client& client, std::int64_t now);
    void progress(Urb& urb, std::int64_t now);
};

}  // namespace ilf::devices::emulators
