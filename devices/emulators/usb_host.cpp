#include "devices/emulators/usb_host.h"

#include <dlfcn.h>
#include <sys/ioctl.h>
#include <umockdev.h>

// Needs sys/ioctl.h before it (devices.md 6.3).
#include <linux/usbdevice_fs.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdio>
#include <cstring>
#include <list>
#include <mutex>
#include <set>
#include <stop_token>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

namespace ilf::devices::emulators {

namespace {

template <class T>
struct Unref {
    void operator()(T* object) const { g_object_unref(object); }
};
template <class T>
using Owned = std::unique_ptr<T, Unref<T>>;
using IoctlData = Owned<UMockdevIoctlData>;

/// What an ioctl returns, and errno.
using Outcome = std::pair<long, int>;

IoctlData resolved(UMockdevIoctlData* data, std::size_t offset, std::size_t length) {
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
};

std::string hex(const Bytes& bytes) {
    std::string text;
    char digits[3];
    for (const std::uint8_t byte : bytes) {
        std::snprintf(digits, sizeof digits, "%02x", unsigned(byte));
        text += digits;
    }
    return text;
}

std::string threeDigits(int number) {
    char digits[16];
    std::snprintf(digits, sizeof digits, "%03d", number);
    return digits;
}

/// "1-2.3" hangs on "1-2", that on "usb1".
std::string parentOf(const std::string& path) {
    const auto dot = path.rfind('.');
    return dot != std::string::npos ? path.substr(0, dot) : "usb" + path.substr(0, path.find('-'));
}

bool wellFormed(const std::string& path) {
    const auto dash = path.find('-');
    if (dash == std::string::npos || path.size() > 24) return false;
    bool digit = false;
    for (std::size_t i = 0; i < path.size(); ++i) {
        const bool isDigit = path[i] >= '0' && path[i] <= '9';
        const bool separates = digit && (i == dash || (i > dash && path[i] == '.'));
        if (!isDigit && !separates) return false;
        digit = isDigit;
    }
    return digit;
}

/// Preloaded, its ioctl comes before the C library's.
bool preloaded() {
    Dl_info info{};
    void* found = dlsym(RTLD_DEFAULT, "ioctl");
    return found != nullptr && dladdr(found, &info) != 0 && info.dli_fname != nullptr &&
           std::string_view(info.dli_fname).find("umockdev-preload") != std::string_view::npos;
}

}  // namespace

struct UsbHost::Impl {
    /// A device at a place. It stays until the last program has let go of it, long after the cable is out.
    struct Port {
        Impl* host = nullptr;
        std::string path, node, sysfs;
        EmulatedUsbDevice* device = nullptr;
        UsbDescriptors descriptors;
        Owned<UMockdevIoctlBase> handler;
        std::list<std::pair<Owned<UMockdevIoctlClient>, Client>> clients;
        bool gone = false, kernelDriver = false;
        bool added = false, pulled = false;  ///< programs can see it; they no longer can
        std::chrono::steady_clock::time_point pulledAt;

        void forgetClosed();
        Outcome answer(UMockdevIoctlClient* client, bool& known);
        Outcome claim(Client& client);
        Outcome submit(Client& client, UMockdevIoctlData* arg);
        Outcome reap(Client& client, UMockdevIoctlData* arg);
        Outcome discard(Client& client, const void* address);
        void progress(Client& client);
        void progress(Urb& urb);
    };

    Clock clock;
    Owned<UMockdevTestbed> bed;
    std::string directory;
    std::recursive_mutex devices;  ///< the emulators, and what is known of ports
    std::mutex bedCalls;           ///< the test bed takes one call at a time
    std::list<std::unique_ptr<Port>> ports;
    std::set<std::string> busy, hubs;
    struct Return {
        std::string path;
        EmulatedUsbDevice* device;
        std::int64_t at_ns;
    };
    std::vector<Return> returns;
    int nextNumber = 1;
    std::uint64_t transfers = 0;
    std::condition_variable_any wake;
    std::jthread attendant;  ///< pulls cables that devices pull themselves; last, so that it ends first

    ~Impl();
    Port* at(const std::string& path) const;
    Result<void> plug(const std::string& path, EmulatedUsbDevice& device);
    Result<void> add(Port& port);
    void pull(Port& port);
    std::vector<Port*> goneAndNotPulled();
    void letGo(Port& port);
    void attend(const std::stop_token& stop);
};

UsbHost::Impl::Port* UsbHost::Impl::at(const std::string& path) const {
    for (const auto& port : ports)
        if (port->path == path && !port->gone) return port.get();
    return nullptr;
}

/// Forgets programs that have closed their file. umockdev tells nobody of it: its signal "client-vanished" is declared
/// and never sent (0.17.16).
void UsbHost::Impl::Port::forgetClosed() {
    std::erase_if(clients,
                  [](const auto& entry) { return umockdev_ioctl_client_get_connected(entry.first.get()) == FALSE; });
}

// Ioctls of usbdevfs; linux/usbdevice_fs.h and the kernel's documentation of it.
Outcome UsbHost::Impl::Port::answer(UMockdevIoctlClient* client, bool& known) {
    UMockdevIoctlData* arg = umockdev_ioctl_client_get_arg(client);
    const unsigned long request = umockdev_ioctl_client_get_request(client);
    if (gone) return {-1, ENODEV};
    auto entry = std::ranges::find_if(clients, [&](const auto& known_) { return known_.first.get() == client; });
    if (entry == clients.end()) {
        forgetClosed();
        entry = clients.emplace(clients.end(), Owned<UMockdevIoctlClient>(client), Client{});
        g_object_ref(client);
    }
    Client& program = entry->second;
    switch (request) {
    case USBDEVFS_GET_CAPABILITIES: {
        const IoctlData capabilities = resolved(arg, 0, sizeof(std::uint32_t));
        as<std::uint32_t>(capabilities) = USBDEVFS_CAP_ZERO_PACKET;
        return {0, 0};
    }
    case USBDEVFS_CLAIMINTERFACE:
        return claim(program);
    case USBDEVFS_RELEASEINTERFACE:
        program.claimed = false;
        return {0, 0};
    case USBDEVFS_DISCONNECT_CLAIM:
        kernelDriver = false;
        return claim(program);
    case USBDEVFS_GETDRIVER: {
        if (!kernelDriver) return {-1, ENODATA};
        const IoctlData driver = resolved(arg, 0, sizeof(usbdevfs_getdriver));
        descriptors.kernelDriver.copy(as<usbdevfs_getdriver>(driver).driver, USBDEVFS_MAXDRIVERNAME);
        return {0, 0};
    }
    case USBDEVFS_IOCTL: {
        const IoctlData call = resolved(arg, 0, sizeof(usbdevfs_ioctl));
        const int code = as<usbdevfs_ioctl>(call).ioctl_code;
        const bool connects = code == int(USBDEVFS_CONNECT);
        if (!connects && code != int(USBDEVFS_DISCONNECT)) return {-1, ENOTTY};
        if (!connects && !kernelDriver) return {-1, ENODATA};
        kernelDriver = connects && !descriptors.kernelDriver.empty();
        return {0, 0};
    }
    case USBDEVFS_SUBMITURB:
        return submit(program, arg);
    case USBDEVFS_REAPURB:
    case USBDEVFS_REAPURBNDELAY:
        return reap(program, arg);
    case USBDEVFS_DISCARDURB:
        return discard(program, *reinterpret_cast<void**>(arg->data));
    case USBDEVFS_CLEAR_HALT: {
        const IoctlData endpoint = resolved(arg, 0, sizeof(unsigned));
        device->clearHalt(static_cast<std::uint8_t>(as<unsigned>(endpoint)), host->clock());
        return {0, 0};
    }
    case USBDEVFS_SETCONFIGURATION:
    case USBDEVFS_SETINTERFACE:
    case USBDEVFS_RESET:
        return {0, 0};
    default:
        known = false;
        return {-1, ENOTTY};
    }
}

Outcome UsbHost::Impl::Port::claim(Client& client) {
    forgetClosed();
    const bool taken = std::ranges::any_of(
        clients, [&](const auto& other) { return &other.second != &client && other.second.claimed; });
    if (taken || kernelDriver || host->busy.contains(path)) return {-1, EBUSY};
    client.claimed = true;
    return {0, 0};
}

Outcome UsbHost::Impl::Port::submit(Client& client, UMockdevIoctlData* arg) {
    constexpr int kLongest = 1 << 20;
    Urb urb;
    urb.data = resolved(arg, 0, sizeof(usbdevfs_urb));
    if (!urb.data) return {-1, EFAULT};
    const int length = urb.fields().buffer_length;
    if (length < 0 || length > kLongest || urb.fields().type == USBDEVFS_URB_TYPE_ISO) return {-1, EINVAL};
    if (length > 0) urb.buffer = resolved(urb.data.get(), offsetof(usbdevfs_urb, buffer), std::size_t(length));
    if (urb.isControl() && length < 8) return {-1, EINVAL};
    if (!urb.isControl() && !client.claimed) return {-1, EINVAL};
    client.urbs.push_back(std::move(urb));
    ++host->transfers;
    progress(client);
    return gone ? Outcome{-1, ENODEV} : Outcome{0, 0};
}

/// Of each endpoint the oldest transfer that is not done goes on as far as the device lets it.
void UsbHost::Impl::Port::progress(Client& client) {
    std::set<unsigned> waiting;
    for (Urb& urb : client.urbs) {
        if (gone) return;
        const unsigned endpoint = urb.isControl() ? 0U : urb.fields().endpoint;
        if (urb.done || waiting.contains(endpoint)) continue;
        progress(urb);
        if (!urb.done) waiting.insert(endpoint);
    }
}

void UsbHost::Impl::Port::progress(Urb& urb) {
    const std::span<std::uint8_t> bytes = urb.bytes();
    const std::int64_t now_ns = host->clock();
    const std::uint8_t endpoint = urb.fields().endpoint;
    UsbTransfer transfer;
    if (urb.isControl()) {
        const auto word = [&](std::size_t offset) {
            return static_cast<std::uint16_t>(bytes[offset] + 256U * bytes[offset + 1]);
        };
        const ControlSetup setup{bytes[0], bytes[1], word(2), word(4), word(6)};
        const auto data = bytes.subspan(8, std::min<std::size_t>(bytes.size() - 8, setup.length));
        transfer = controlTransfer(*device, descriptors, setup, data, now_ns);
    } else if ((endpoint & 0x80U) != 0) {
        transfer = device->in(endpoint, bytes.subspan(urb.moved), now_ns);
    } else {
        transfer = device->out(endpoint, bytes.subspan(urb.moved), now_ns);
    }
    urb.moved += transfer.bytes;
    switch (transfer.answer) {
    case UsbAnswer::done:
        urb.finish(0);
        break;
    case UsbAnswer::stall:
        urb.finish(-EPIPE);
        break;
    case UsbAnswer::busy:
        break;
    case UsbAnswer::gone:
        gone = true;
        if (const auto back = device->backOnBusAt(); back && *back > now_ns)
            host->returns.push_back({path, device, *back});
        host->wake.notify_all();
        break;
    }
}

Outcome UsbHost::Impl::Port::reap(Client& client, UMockdevIoctlData* arg) {
    progress(client);
    if (gone) return {-1, ENODEV};
    const auto done = std::ranges::find_if(client.urbs, &Urb::done);
    if (done == client.urbs.end()) return {-1, EAGAIN};
    const IoctlData pointer = resolved(arg, 0, sizeof(void*));
    umockdev_ioctl_data_set_ptr(pointer.get(), 0, done->data.get());
    client.urbs.erase(done);
    return {0, 0};
}

Outcome UsbHost::Impl::Port::discard(Client& client, const void* address) {
    for (Urb& urb : client.urbs) {
        if (urb.done || urb.data->client_addr != reinterpret_cast<gulong>(address)) continue;
        urb.finish(-ENOENT);
        return {0, 0};
    }
    return {-1, EINVAL};
}

Result<void> UsbHost::Impl::plug(const std::string& path, EmulatedUsbDevice& device) {
    if (!wellFormed(path)) return fail(Fault::outOfRange, "\"" + path + "\" is no place on a USB bus such as 1-2.3.");
    const std::scoped_lock bedLock(bedCalls);
    // What pulled its own cable there may not have been taken out yet.
    for (Port* left : goneAndNotPulled())
        if (left->path == path) pull(*left);
    auto port = std::make_unique<Port>();
    port->host = this;
    port->path = path;
    port->device = &device;
    port->descriptors = device.descriptors();
    port->kernelDriver = !port->descriptors.kernelDriver.empty();
    Port& added = *port;
    {
        const std::scoped_lock lock(devices);
        bool taken = at(path) != nullptr || hubs.contains(path);
        for (std::string hub = parentOf(path); !hub.starts_with("usb"); hub = parentOf(hub))
            taken = taken || at(hub) != nullptr;
        if (taken) return fail(Fault::outOfRange, "Something is plugged in at USB " + path + " already.");
        ports.push_back(std::move(port));
    }

    // Real devices hang on hubs, and programs follow the chain to tell the place.
    std::vector<std::string> chain;
    for (std::string parent = parentOf(path);; parent = parentOf(parent)) {
        chain.push_back(parent);
        if (parent.starts_with("usb")) break;
    }
    std::string below = "/devices/pci0000:00/0000:00:14.0";
    for (auto hub = chain.rbegin(); hub != chain.rend(); ++hub) {
        below += "/" + *hub;
        if (!hubs.insert(*hub).second) continue;
        Port shape;
        shape.path = *hub;
        shape.sysfs = below;
        shape.descriptors = usbDescriptors({0x1D6B, 0x0002, 9, "", "Hub", "", {}});
        if (auto made = add(shape); !made) return made;
    }
    added.sysfs = below + "/" + path;

    added.handler.reset(umockdev_ioctl_base_new());
    g_signal_connect(added.handler.get(), "handle-ioctl",
                     G_CALLBACK(+[](UMockdevIoctlBase*, UMockdevIoctlClient* client, gpointer data) -> gboolean {
                         auto& served = *static_cast<Port*>(data);
                         bool known = true;
                         Outcome outcome;
                         {
                             const std::scoped_lock lock(served.host->devices);
                             outcome = served.answer(client, known);
                         }
                         if (!known) return FALSE;
                         umockdev_ioctl_client_complete(client, outcome.first, outcome.second);
                         return TRUE;
                     }),
                     &added);
    return add(added);
}

/// Makes the device known to programs: the handler first, so that opening works when they hear of it.
Result<void> UsbHost::Impl::add(Port& port) {
    const std::string name = port.sysfs.substr(port.sysfs.rfind('/') + 1);
    const bool root = name.starts_with("usb");
    const std::string bus = root ? name.substr(3) : name.substr(0, name.find('-'));
    const int number = nextNumber++;
    const std::string node = "bus/usb/" + threeDigits(std::stoi(bus)) + "/" + threeDigits(number);
    port.node = "/dev/" + node;
    GError* error = nullptr;
    const auto refused = [&](const std::string& what) {
        const std::string why = error != nullptr ? error->message : "for no given reason";
        g_clear_error(&error);
        port.gone = true;
        return fail(Fault::device, what + " at USB " + port.path + " failed: " + why + ".");
    };
    if (port.handler && umockdev_testbed_attach_ioctl(bed.get(), port.node.c_str(), port.handler.get(), &error) == 0)
        return refused("Emulating a device");

    const Bytes& id = port.descriptors.device;
    const auto word = [&](std::size_t offset) {
        char digits[8];
        std::snprintf(digits, sizeof digits, "%02x%02x", unsigned(id[offset + 1]), unsigned(id[offset]));
        return std::string(digits);
    };
    std::string text = "P: " + port.sysfs + "\nN: " + node +
                       "\nE: SUBSYSTEM=usb\nE: DEVTYPE=usb_device\nE: DRIVER=usb\nE: DEVNAME=" + port.node +
                       "\nE: BUSNUM=" + threeDigits(std::stoi(bus)) + "\nE: DEVNUM=" + threeDigits(number) +
                       "\nA: busnum=" + bus + "\\n\nA: devnum=" + std::to_string(number) +
                       "\\n\nA: bConfigurationValue=1\\n\nA: speed=" + (root ? "480" : "12") +
                       "\\n\nA: devpath=" + (root ? "0" : name.substr(name.find('-') + 1)) +
                       "\\n\nA: idVendor=" + word(8) + "\\n\nA: idProduct=" + word(10) + "\\n\n";
    const std::pair<std::uint8_t, const char*> names[] = {{1, "manufacturer"}, {2, "product"}, {3, "serial"}};
    for (const auto& [index, attribute] : names)
        if (const auto found = port.descriptors.strings.find(index); found != port.descriptors.strings.end())
            text += "A: " + std::string(attribute) + "=" + found->second + "\\n\n";
    text += "H: descriptors=" + hex(port.descriptors.device) + hex(port.descriptors.configuration) + "\n";
    if (umockdev_testbed_add_from_string(bed.get(), text.c_str(), &error) == 0) return refused("Adding a device");
    port.added = true;
    return {};
}

/// Programs hear of it, then the node vanishes; whoever still holds it open reads "no device". With `bedCalls` held.
void UsbHost::Impl::pull(Port& port) {
    {
        const std::scoped_lock lock(devices);
        if (port.pulled) return;
        port.pulled = port.gone = true;
        port.pulledAt = std::chrono::steady_clock::now();
        for (auto& [program, client] : port.clients)
            client.urbs.clear();
        port.device->unplugged(clock());
    }
    const std::string path = "/sys" + port.sysfs;
    umockdev_testbed_uevent(bed.get(), path.c_str(), "remove");
    umockdev_testbed_remove_device(bed.get(), path.c_str());
}

std::vector<UsbHost::Impl::Port*> UsbHost::Impl::goneAndNotPulled() {
    const std::scoped_lock lock(devices);
    std::vector<Port*> found;
    for (const auto& port : ports)
        if (port->gone && !port->pulled && port->added) found.push_back(port.get());
    return found;
}

/// No program holds it any more: nothing reaches it from here on. With `bedCalls` held.
void UsbHost::Impl::letGo(Port& port) {
    g_signal_handlers_disconnect_by_data(port.handler.get(), &port);
    umockdev_testbed_detach_ioctl(bed.get(), port.node.c_str(), nullptr);
}

void UsbHost::Impl::attend(const std::stop_token& stop) {
    std::unique_lock lock(devices);
    while (!stop.stop_requested()) {
        if (!goneAndNotPulled().empty()) {
            lock.unlock();
            {
                const std::scoped_lock bedLock(bedCalls);
                for (Port* port : goneAndNotPulled())
                    pull(*port);
            }
            lock.lock();
            continue;
        }
        // A while after it was pulled, so that nobody is half-way through opening it.
        const auto old = std::chrono::steady_clock::now() - std::chrono::seconds(1);
        for (const auto& port : ports)
            if (port->pulled) port->forgetClosed();
        const auto left = std::ranges::find_if(
            ports, [&](const auto& port) { return port->pulled && port->clients.empty() && port->pulledAt < old; });
        if (left != ports.end()) {
            const std::unique_ptr<Port> port = std::move(*left);
            ports.erase(left);
            lock.unlock();
            {
                const std::scoped_lock bedLock(bedCalls);
                letGo(*port);
            }
            lock.lock();
            continue;
        }
        const auto due = std::ranges::find_if(returns, [&](const Return& r) { return r.at_ns <= clock(); });
        if (due != returns.end()) {
            const Return back = *due;
            returns.erase(due);
            lock.unlock();
            // Refused where somebody has plugged something in there meanwhile; that is then what is there.
            (void)plug(back.path, *back.device);
            lock.lock();
            continue;
        }
        wake.wait_for(lock, stop, std::chrono::milliseconds(returns.empty() ? 200 : 20), [] { return false; });
    }
}

UsbHost::Impl::~Impl() {
    attendant = {};  // asked to stop, and waited for
    for (const auto& port : ports) {
        if (port->added) pull(*port);
        if (port->handler) letGo(*port);
    }
}

Result<std::unique_ptr<UsbHost>> UsbHost::started(Clock clock) {
    if (!preloaded())
        return fail(Fault::notFound, std::string("Emulated USB devices need ") + kUsbPreload +
                                         " (package umockdev) in LD_PRELOAD when the program starts.");
    auto impl = std::make_unique<Impl>();
    impl->clock = std::move(clock);
    if (!impl->clock)
        impl->clock = [] {
            return std::chrono::duration_cast<std::chrono::nanoseconds>(
                       std::chrono::steady_clock::now().time_since_epoch())
                .count();
        };
    impl->bed.reset(umockdev_testbed_new());
    gchar* root = umockdev_testbed_get_root_dir(impl->bed.get());
    impl->directory = root;
    g_free(root);
    Impl& attended = *impl;
    impl->attendant = std::jthread([&attended](const std::stop_token& stop) { attended.attend(stop); });
    return std::unique_ptr<UsbHost>(new UsbHost(std::move(impl)));
}

UsbHost::UsbHost(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
UsbHost::~UsbHost() = default;

Result<void> UsbHost::plug(const std::string& path, EmulatedUsbDevice& device) { return impl_->plug(path, device); }

void UsbHost::unplug(const std::string& path) {
    const std::scoped_lock bedLock(impl_->bedCalls);
    Impl::Port* port = nullptr;
    {
        const std::scoped_lock lock(impl_->devices);
        std::erase_if(impl_->returns, [&](const Impl::Return& back) { return back.path == path; });
        port = impl_->at(path);
    }
    if (port != nullptr) impl_->pull(*port);
}

bool UsbHost::plugged(const std::string& path) const {
    const std::scoped_lock lock(impl_->devices);
    return impl_->at(path) != nullptr;
}

void UsbHost::setBusy(const std::string& path, bool busy) {
    const std::scoped_lock lock(impl_->devices);
    if (busy)
        impl_->busy.insert(path);
    else
        impl_->busy.erase(path);
}

void UsbHost::locked(const std::function<void(std::int64_t now_ns)>& work) {
    const std::scoped_lock lock(impl_->devices);
    work(impl_->clock());
}

std::int64_t UsbHost::now_ns() const { return impl_->clock(); }
const std::string& UsbHost::directory() const { return impl_->directory; }
std::uint64_t UsbHost::transfers() const {
    const std::scoped_lock lock(impl_->devices);
    return impl_->transfers;
}

}  // namespace ilf::devices::emulators
